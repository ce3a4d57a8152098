// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/cholesky.hpp"

extern "C" void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);

namespace anticrack::contact {

bool cholesky(Eigen::Ref<Eigen::MatrixXd> matrix) {
  const int size = static_cast<int>(matrix.rows()), stride = static_cast<int>(matrix.outerStride());
  if (size == 0) {
    return true;
  }
  int info = 0;
  dpotrf_("L", &size, matrix.data(), &stride, &info);
  return info == 0;
}

}  // namespace anticrack::contact
