// SPDX-License-Identifier: GPL-3.0-or-later
//
// Dense factors by BLAS and LAPACK. Eigen's own are compiled for the oldest x86-64 and take twice
// as long from some 60 rows, several times as long from some hundred. Large ones are worked on in
// parts, on base::Threads. Same input, same bits.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ddm/linear_conditions.hpp"

namespace anticrack::contact {

/// y <- a x and y <- a' x. Matrices without entries, which a membrane without cracks has, are not
/// passed to BLAS: it would complain on standard output.
void multiply(const Eigen::Ref<const Eigen::MatrixXd>& a,
              const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> y);
void multiply_transposed(const Eigen::Ref<const Eigen::MatrixXd>& a,
                         const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> y);

/// Overwrites the lower triangle of the symmetric `matrix` with its Cholesky factor L, L L' =
/// matrix. Returns false if the matrix is not positive definite.
bool cholesky(Eigen::Ref<Eigen::MatrixXd> matrix);

/// b <- L^-1 b and b <- L^-T b, column by column, L the lower triangle of `factor`.
void solve_lower(const Eigen::Ref<const Eigen::MatrixXd>& factor, Eigen::Ref<Eigen::MatrixXd> b);
void solve_lower_transposed(const Eigen::Ref<const Eigen::MatrixXd>& factor,
                            Eigen::Ref<Eigen::MatrixXd> b);

/// s <- s - x'x, in the lower triangle only.
void subtract_square(const Eigen::MatrixXd& x, Eigen::Ref<Eigen::MatrixXd> s);

/// Cholesky factor of S on the open nodes in increasing order, so its bits depend on the set alone.
/// Solutions also satisfy G x = 0 for the closed rows that have open nodes among their terms. Keeps
/// its memory from one set to the next.
class OpenFactor {
 public:
  /// Allocates memory for the factor of `contacts` open nodes, so that factorise() does not.
  void reserve(Eigen::Index contacts);

  /// `matrix`: S, (c,c) symmetric with unit diagonal; `rows`: G, of norm 1; `closed`: c nodes, then
  /// the rows. O(n^3) for n open nodes, O(c) if `closed` is as in the last call. Returns regular().
  bool factorise(const Eigen::MatrixXd& matrix, const std::vector<ddm::Terms>& rows,
                 const std::vector<char>& closed);
  /// Whether S on the open nodes and G S^-1 G' are both positive definite to rounding.
  bool regular() const noexcept { return _regular; }
  bool empty() const noexcept { return _nodes.empty(); }

  /// x with (S x - G'nu)_i = b_i on the open nodes, 0 on the closed ones, and G x = 0 for the
  /// closed rows. O(n^2).
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// Writes the same into x, which has the size of b. Does not allocate if there are no rows.
  void solve(const Eigen::VectorXd& b, Eigen::Ref<Eigen::VectorXd> x) const;
  /// b'S^-1 b for each column of b, if every node is open and no row is closed. Overwrites b.
  /// O(n^2) each.
  Eigen::VectorXd squares(Eigen::Ref<Eigen::MatrixXd> b) const;

 private:
  void hold(const std::vector<ddm::Terms>& rows, Eigen::Index contacts);

  std::vector<char> _closed;
  std::vector<Eigen::Index> _nodes;
  Eigen::VectorXd _values;   // lower triangle, (n,n) column-major, at the front
  Eigen::MatrixXd _to_rows;  // L^-1 G' on the open nodes, for the closed rows
  Eigen::MatrixXd _of_rows;  // Cholesky factor of G S^-1 G'
  bool _regular = true;
};

}  // namespace anticrack::contact
