// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>

#include "fem/tension.hpp"
#include "fem/triangulation.hpp"

namespace anticrack::fem {

/// The symmetric matrix K_ij = int grad(phi_i).T grad(phi_j) dx of the P1 hat functions of all
/// nodes, in blocks: those of the first nodes, which are free (F), and the others, on the Dirichlet
/// boundary (D). Constants are in the kernel of the whole.
struct Stiffness {
  Eigen::SparseMatrix<double> free;            ///< K_FF, lower triangle
  Eigen::SparseMatrix<double> free_dirichlet;  ///< K_FD
  Eigen::SparseMatrix<double> dirichlet;       ///< K_DD, both triangles
};

/// `tension`: T, force per length; `free`: how many nodes are. The contributions to an entry
/// are added in the order of the triangles. O(m), 50 bytes a triangle beside the result.
Stiffness stiffness(const Triangulation& part, const Tension& tension, Eigen::Index free);

}  // namespace anticrack::fem
