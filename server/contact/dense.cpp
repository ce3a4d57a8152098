// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/dense.hpp"

#include <cblas.h>

extern "C" void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);

namespace anticrack::contact {
namespace {

using Eigen::MatrixXd;
using Eigen::Ref;

template <class Matrix>
int stride(const Matrix& matrix) {
  return static_cast<int>(matrix.outerStride());
}

void solve(const Ref<const MatrixXd>& factor, CBLAS_TRANSPOSE transposed, Ref<MatrixXd> b) {
  const int rows = static_cast<int>(b.rows()), columns = static_cast<int>(b.cols());
  if (rows == 0 || columns == 0) return;
  if (columns == 1) {
    cblas_dtrsv(CblasColMajor, CblasLower, transposed, CblasNonUnit, rows, factor.data(),
                stride(factor), b.data(), 1);
    return;
  }
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, transposed, CblasNonUnit, rows, columns, 1,
              factor.data(), stride(factor), b.data(), stride(b));
}

}  // namespace

void multiply(const Ref<const MatrixXd>& a, const Ref<const Eigen::VectorXd>& x,
              Ref<Eigen::VectorXd> y) {
  if (a.size() > 0)
    y.noalias() = a * x;
  else
    y.setZero();
}

void multiply_transposed(const Ref<const MatrixXd>& a, const Ref<const Eigen::VectorXd>& x,
                         Ref<Eigen::VectorXd> y) {
  if (a.size() > 0)
    y.noalias() = a.transpose() * x;
  else
    y.setZero();
}

bool cholesky(Ref<MatrixXd> matrix) {
  const int size = static_cast<int>(matrix.rows()), leading = stride(matrix);
  if (size == 0) return true;
  int info = 0;
  dpotrf_("L", &size, matrix.data(), &leading, &info);
  return info == 0;
}

void solve_lower(const Ref<const MatrixXd>& factor, Ref<MatrixXd> b) {
  solve(factor, CblasNoTrans, b);
}

void solve_lower_transposed(const Ref<const MatrixXd>& factor, Ref<MatrixXd> b) {
  solve(factor, CblasTrans, b);
}

void subtract_square(const MatrixXd& x, Ref<MatrixXd> s) {
  const int rows = static_cast<int>(x.rows()), columns = static_cast<int>(x.cols());
  if (rows > 0 && columns > 0) {
    cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, columns, rows, -1, x.data(), stride(x), 1,
                s.data(), stride(s));
  }
}

}  // namespace anticrack::contact
