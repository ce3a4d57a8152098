// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>

#include "fem/tension.hpp"
#include "fem/triangulation.hpp"

namespace anticrack::fem {

/// The symmetric matrix K_ij = int grad(phi_i).T grad(phi_j) dx of the P1 hat functions of all
/// nodes, in blocks: the first nodes are free (F), the others lie on the Dirichlet boundary (D).
/// Constants are in the kernel of the whole matrix.
struct Stiffness {
  Eigen::SparseMatrix<double> free;            ///< K_FF, lower triangle
  Eigen::SparseMatrix<double> free_dirichlet;  ///< K_FD
  Eigen::SparseMatrix<double> dirichlet;       ///< K_DD, both triangles
};

/// Assembles K. `tension`: T, force per length; `free`: the number of free nodes. The contributions
/// to an entry are added in the order of the triangles. O(m), and 50 bytes a triangle.
Stiffness stiffness(const Triangulation& part, const Tension& tension, Eigen::Index free);

}  // namespace anticrack::fem
