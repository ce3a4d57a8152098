// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "ddm/decomposition.hpp"
#include "ddm/subdomain_operator.hpp"

namespace anticrack::contact {

/// 2 / lambda_max(R' (sum_i B_i F_i B_i') R) with R R' = M the interface mass, B_i the signed
/// incidence of pairs and traces: the bound of Theorem 4 on theta. Lanczos to 1e-12 relative, by a
/// dense solver up to 64 pairs. Infinite without pairs. Every subdomain must have a flexibility.
/// Throws errors::Error (numerical) when Lanczos does not converge. O(n_G^2) a Lanczos step.
double theta_star(const ddm::Decomposition& decomposition,
                  const std::vector<ddm::SubdomainOperator>& operators,
                  const Eigen::SparseMatrix<double>& mass_root);

}  // namespace anticrack::contact
