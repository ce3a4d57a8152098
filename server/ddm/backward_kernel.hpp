// SPDX-License-Identifier: GPL-3.0-or-later
//
// The inner loops of backward_solve.hpp, compiled once for each instruction set: include it once in
// a file compiled for that, with ANTICRACK_BACKWARD the name of the function. It includes no
// library, as forward_kernel.hpp.
#include "ddm/backward_solve.hpp"
#include "ddm/fetch_ahead.hpp"

namespace anticrack::ddm {
namespace {

/// Rows that are multiplied together; a column of a factor starts anywhere.
constexpr int rows_at_once = 8;
using Rows = double __attribute__((vector_size(rows_at_once * sizeof(double))));
using UnalignedRows =
    double __attribute__((vector_size(rows_at_once * sizeof(double)), aligned(sizeof(double))));

/// sum_k += L_ik y_i over the rows [from, to) of y at `row`, for columns that follow each other
/// from l on: the entries of y are fetched once for all of them.
template <int columns, class Row>
inline void add_products(const double* l, int height, int from, int to, const double* y, Row row,
                         double* sum) {
  const double* column[columns];
  Rows sums[columns];
  for (int k = 0; k < columns; ++k) {
    column[k] = l + static_cast<long>(k) * height;
    sums[k] = Rows{};
  }
  int i = from;
  for (; i + rows_at_once <= to; i += rows_at_once) {
    Rows values;
    for (int r = 0; r < rows_at_once; ++r) values[r] = y[row(i + r)];
#pragma GCC unroll 8
    for (int k = 0; k < columns; ++k) {
      sums[k] += *reinterpret_cast<const UnalignedRows*>(column[k] + i) * values;
    }
  }
  for (; i < to; ++i) {
    const double value = y[row(i)];
#pragma GCC unroll 8
    for (int k = 0; k < columns; ++k) sum[k] += column[k][i] * value;
  }
  for (int k = 0; k < columns; ++k) {
    for (int r = 0; r < rows_at_once; ++r) sum[k] += sums[k][r];
  }
}

/// Columns of a supernode that go together, from `begin` on: all rows below, then their triangle.
template <int columns>
inline void solve_backward(const double* l, int height, int own, const int* rows, int begin,
                           double* x, const double* y) {
  const double* panel = l + static_cast<long>(begin) * height;
  fetch(panel - ahead, columns * height);
  double sum[columns] = {};
  add_products<columns>(
      panel, height, begin + columns, own, x, [](int i) { return i; }, sum);
  add_products<columns>(
      panel, height, own, height, y, [rows](int i) { return rows[i]; }, sum);
  for (int k = columns; k-- > 0;) {
    const double* column = panel + static_cast<long>(k) * height + begin;
    for (int i = k + 1; i < columns; ++i) sum[k] += column[i] * x[begin + i];
    x[begin + k] = (x[begin + k] - sum[k]) / column[k];
  }
}

}  // namespace

void ANTICRACK_BACKWARD(const Supernodes& factor, double* y) {
  for (int s = factor.count; s-- > 0;) {
    const int first = factor.super[s];
    const int end = factor.super[s + 1] < factor.columns ? factor.super[s + 1] : factor.columns;
    if (end <= first) continue;
    const int* rows = factor.rows + factor.row_begin[s];
    const int height = factor.row_begin[s + 1] - factor.row_begin[s];
    const int own = factor.super[s + 1] - first;  // rows that follow each other
    const double* l = factor.values + factor.value_begin[s];
    double* x = y + first;
    int left = end - first;
    for (; left >= 8; left -= 8) solve_backward<8>(l, height, own, rows, left - 8, x, y);
    if (left >= 4) {
      left -= 4;
      solve_backward<4>(l, height, own, rows, left, x, y);
    }
    if (left >= 2) {
      left -= 2;
      solve_backward<2>(l, height, own, rows, left, x, y);
    }
    if (left > 0) solve_backward<1>(l, height, own, rows, 0, x, y);
  }
}

}  // namespace anticrack::ddm
