// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mass matrices of the multipliers on an interface: int lambda v ds for P1 functions on its edges.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::fem {

/// An edge between two multiplier nodes; -1 is an end without one (a Dirichlet node).
struct MassEdge {
  std::array<std::int32_t, 2> node;
  double length;
};

/// Diagonal: half the length of the edges at each node, shape (n).
Eigen::VectorXd lumped_mass(std::span<const MassEdge> edges, std::size_t n);

/// The paper's int1d: length/3 on the diagonal, length/6 beside it, shape (n,n).
Eigen::SparseMatrix<double> consistent_mass(std::span<const MassEdge> edges, std::size_t n);

}  // namespace anticrack::fem
