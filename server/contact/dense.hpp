// SPDX-License-Identifier: GPL-3.0-or-later
//
// Dense factors by BLAS and LAPACK: Eigen's are compiled for the oldest x86-64 and take twice as
// long from some 60 rows, several times as long from some hundred. Same input, same bits.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace anticrack::contact {

/// y <- a x and y <- a' x. BLAS complains of matrices without entries, on standard output: a
/// membrane without cracks has some.
void multiply(const Eigen::Ref<const Eigen::MatrixXd>& a,
              const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> y);
void multiply_transposed(const Eigen::Ref<const Eigen::MatrixXd>& a,
                         const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> y);

/// L with L L' = the symmetric matrix whose lower triangle `matrix` holds, into that triangle.
/// False where the matrix is not positive definite.
bool cholesky(Eigen::Ref<Eigen::MatrixXd> matrix);

/// b <- L^-1 b and b <- L^-T b, column by column, L the lower triangle of `factor`.
void solve_lower(const Eigen::Ref<const Eigen::MatrixXd>& factor, Eigen::Ref<Eigen::MatrixXd> b);
void solve_lower_transposed(const Eigen::Ref<const Eigen::MatrixXd>& factor,
                            Eigen::Ref<Eigen::MatrixXd> b);

/// The lower triangle of s <- s - x'x.
void subtract_square(const Eigen::MatrixXd& x, Eigen::Ref<Eigen::MatrixXd> s);

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
