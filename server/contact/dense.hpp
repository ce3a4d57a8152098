// SPDX-License-Identifier: GPL-3.0-or-later
//
// Dense factors by BLAS and LAPACK: Eigen's are compiled for the oldest x86-64 and take twice as
// long from some 60 rows, several times as long from some hundred. Same input, same bits.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ddm/linear_conditions.hpp"

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

/// Cholesky factor of S on the open nodes, in increasing order: a function of the set alone. Closed
/// rows G x = 0 with open nodes among their terms hold as well. Keeps its memory from one set to
/// the next.
class OpenFactor {
 public:
  /// Room for the factor of `contacts` open nodes, so that factorise() does not allocate.
  void reserve(Eigen::Index contacts);

  /// `matrix`: S, (c,c) symmetric with unit diagonal; `rows`: G, of norm 1; `closed`: c nodes, then
  /// the rows. O(n^3) for n open nodes, O(c) if `closed` is that of the last call. Returns
  /// regular().
  bool factorise(const Eigen::MatrixXd& matrix, const std::vector<ddm::Terms>& rows,
                 const std::vector<char>& closed);
  /// Whether S is positive definite on the open nodes, to rounding, and so is G S^-1 G'.
  bool regular() const noexcept { return _regular; }
  bool empty() const noexcept { return _nodes.empty(); }

  /// x with (S x - G'nu)_i = b_i on the open nodes, 0 on the closed ones, and G x = 0 on the rows
  /// that hold. O(n^2).
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// The same into x, of the size of b. No allocation without rows.
  void solve(const Eigen::VectorXd& b, Eigen::Ref<Eigen::VectorXd> x) const;

 private:
  void hold(const std::vector<ddm::Terms>& rows, Eigen::Index contacts);

  std::vector<char> _closed;
  std::vector<Eigen::Index> _nodes;
  Eigen::VectorXd _values;   // lower triangle, (n,n) column-major, at the front
  Eigen::MatrixXd _to_rows;  // L^-1 G' on the open nodes, of the rows that hold
  Eigen::MatrixXd _of_rows;  // Cholesky factor of G S^-1 G'
  bool _regular = true;
};

}  // namespace anticrack::contact
