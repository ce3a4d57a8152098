// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "ddm/subdomain_operator.hpp"

namespace anticrack::ddm {

/// The constants of a combination sum_j c_j f_j of loads of one subdomain, quadratic forms in c:
/// energy_constant = c' energy c, norm_constant = c' norm c. Shape (loads, loads), symmetric.
struct LoadProducts {
  Eigen::MatrixXd energy;
  Eigen::MatrixXd norm;
};

/// O(n m^2), n the nodes of the subdomain.
LoadProducts products(std::span<const CondensedLoad* const> loads);

/// sum_j c_j f_j without z_interior, so without fields. O((trace + Dirichlet) m).
CondensedLoad combine(std::span<const CondensedLoad* const> loads, const LoadProducts& products,
                      const Eigen::Ref<const Eigen::VectorXd>& coefficients);

}  // namespace anticrack::ddm
