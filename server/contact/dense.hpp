// SPDX-License-Identifier: GPL-3.0-or-later
//
// Dense factors by BLAS and LAPACK: Eigen's are compiled for the oldest x86-64 and take twice as
// long from some 60 rows, several times as long from some hundred. Same input, same bits.
#pragma once

#include <Eigen/Core>

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

}  // namespace anticrack::contact
