// SPDX-License-Identifier: GPL-3.0-or-later
//
// Elimination of small fronts, for kernel_loops.hpp.
namespace anticrack::ddm {
namespace {

bool eliminate_small_front(int columns, int height, double* __restrict panel,
                           double* __restrict update, bool add) {
  const long stride = height;
  for (int k = 0; k < columns; ++k) {
    double* __restrict column = panel + k * stride;
    // pivot > 0 is false for NaN too
    const double pivot = column[k];
    if (!(pivot > 0)) return false;
    const double root = __builtin_sqrt(pivot), inverse = 1 / root;
    column[k] = root;
    for (int i = k + 1; i < height; ++i) column[i] *= inverse;
    for (int j = k + 1; j < columns; ++j) {
      double* __restrict next = panel + j * stride;
      const double factor = column[j];
      for (int i = j; i < height; ++i) next[i] -= column[i] * factor;
    }
  }
  const int rest = height - columns;
  const double* below = panel + columns;
  for (int j = 0; j < rest; ++j) {
    double* __restrict target = update + static_cast<long>(j) * rest;
    for (int i = j; i < rest && !add; ++i) target[i] = 0;
    int k = 0;
    for (; k + 4 <= columns; k += 4) {
      const double *a = below + k * stride, *b = a + stride, *c = b + stride, *d = c + stride;
      const double x = a[j], y = b[j], z = c[j], w = d[j];
      for (int i = j; i < rest; ++i) target[i] -= a[i] * x + b[i] * y + (c[i] * z + d[i] * w);
    }
    for (; k < columns; ++k) {
      const double* a = below + k * stride;
      const double x = a[j];
      for (int i = j; i < rest; ++i) target[i] -= a[i] * x;
    }
  }
  return true;
}

}  // namespace
}  // namespace anticrack::ddm
