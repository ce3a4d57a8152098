// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>

#include "fem/triangulation.hpp"

namespace anticrack::fem {

/// K_ij = T int grad(phi_i).grad(phi_j) dx for the P1 hat functions of all nodes, boundary ones
/// included, T > 0 the tension (force per length): symmetric (n,n), both triangles stored,
/// constants in its kernel. O(m).
Eigen::SparseMatrix<double> stiffness(const Triangulation& part, double tension = 1);

}  // namespace anticrack::fem
