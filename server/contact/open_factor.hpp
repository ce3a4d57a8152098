// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace anticrack::contact {

/// Cholesky factor of S on the open nodes, in increasing order: a function of the set alone.
class OpenFactor {
 public:
  /// Of no nodes: solve() is 0.
  OpenFactor() = default;
  /// `matrix`: (c,c) symmetric, of unit diagonal. O(n^3) with n open nodes.
  OpenFactor(const Eigen::MatrixXd& matrix, const std::vector<char>& closed);

  /// Whether S is positive definite on the open nodes, to rounding.
  bool regular() const noexcept { return _regular; }
  /// x with (S x)_i = b_i on the open nodes, 0 on the closed ones. O(n^2).
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  std::vector<Eigen::Index> _nodes;
  Eigen::MatrixXd _factor;  // lower triangle
  bool _regular = true;
};

}  // namespace anticrack::contact
