// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/backward_solve.hpp"

#include <cblas.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace anticrack::ddm {

void backward_solve(const Supernodes& factor, double* y) {
  std::vector<double> below;
  for (int s = factor.count; s-- > 0;) {
    const int first = factor.super[s];
    const int own = std::min(factor.super[s + 1], factor.columns) - first;
    if (own <= 0) {
      continue;
    }
    const int* rows = factor.rows + factor.row_begin[s];
    const int height = factor.row_begin[s + 1] - factor.row_begin[s], rest = height - own;
    const double* l = factor.values + factor.value_begin[s];
    below.resize(static_cast<std::size_t>(rest));
    std::transform(rows + own, rows + height, below.begin(), [y](int row) { return y[row]; });
    if (rest > 0) {
      cblas_dgemv(CblasColMajor, CblasTrans, rest, own, -1, l + own, height, below.data(), 1, 1,
                  y + first, 1);
    }
    cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, own, l, height, y + first, 1);
  }
}

}  // namespace anticrack::ddm
