// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace anticrack::contact {

/// Cholesky factor of S on the open nodes, in increasing order: a function of the set alone. Keeps
/// its memory from one set to the next.
class OpenFactor {
 public:
  /// Room for the factor of `contacts` open nodes, so that factorise() does not allocate.
  void reserve(Eigen::Index contacts);

  /// `matrix`: S, (c,c) symmetric with unit diagonal. O(n^3) for n open nodes, O(c) if `closed` is
  /// that of the last call. Returns regular().
  bool factorise(const Eigen::MatrixXd& matrix, const std::vector<char>& closed);
  /// Whether S is positive definite on the open nodes, to rounding.
  bool regular() const noexcept { return _regular; }
  bool empty() const noexcept { return _nodes.empty(); }

  /// x with (S x)_i = b_i on the open nodes, 0 on the closed ones. O(n^2).
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// The same into x, of the size of b. No allocation.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;

 private:
  std::vector<char> _closed;
  std::vector<Eigen::Index> _nodes;
  Eigen::VectorXd _values;  // lower triangle, (n,n) column-major, at the front
  bool _regular = true;
};

}  // namespace anticrack::contact
