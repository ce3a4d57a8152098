// SPDX-License-Identifier: GPL-3.0-or-later
//
// The inner loops of backward_solve.hpp, compiled once for each instruction set: include it once in
// a file compiled for that, after forward_kernel.hpp, with ANTICRACK_BACKWARD the name of the
// function. It includes no library either.
#include "ddm/backward_solve.hpp"
#include "ddm/fetch_ahead.hpp"

namespace anticrack::ddm {
namespace {

/// Rows whose products are summed apart; a column of a factor starts anywhere.
constexpr int rows_at_once = 8;
using Rows = double __attribute__((vector_size(rows_at_once * sizeof(double))));
using UnalignedRows =
    double __attribute__((vector_size(rows_at_once * sizeof(double)), aligned(sizeof(double))));

/// a b + c as the processor does it best, and as the compiler does it of vectors: a sum that it
/// makes into one of vectors would be rounded twice.
inline double multiply_add(double a, double b, double c) {
#ifdef __FP_FAST_FMA
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}

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
    for (int k = 0; k < columns; ++k) sum[k] = multiply_add(column[k][i], value, sum[k]);
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
    for (int i = k + 1; i < columns; ++i) sum[k] = multiply_add(column[i], x[begin + i], sum[k]);
    x[begin + k] = (x[begin + k] - sum[k]) / column[k];
  }
}

/// As add_products() of one column, for a block: the same products, summed in the same order.
template <int groups, class Row>
inline void add_products_of_block(const double* column, int from, int to, const Lanes* y, Row row,
                                  Lanes* sum) {
  int i = from;
  Lanes sums[rows_at_once][groups] = {};
  for (; i + rows_at_once <= to; i += rows_at_once) {
    for (int r = 0; r < rows_at_once; ++r) {
      const Lanes* values = y + static_cast<long>(row(i + r)) * groups;
#pragma GCC unroll 4
      for (int g = 0; g < groups; ++g) sums[r][g] += column[i + r] * values[g];
    }
  }
  for (; i < to; ++i) {
    const Lanes* values = y + static_cast<long>(row(i)) * groups;
    for (int g = 0; g < groups; ++g) sum[g] += column[i] * values[g];
  }
  for (int r = 0; r < rows_at_once; ++r) {
    for (int g = 0; g < groups; ++g) sum[g] += sums[r][g];
  }
}

/// Calls solve(begin, count) for the panels of a supernode with `columns` columns, the last first.
template <class Solve>
inline void for_panels(int columns, const Solve& solve) {
  int left = columns;
  for (; left >= 8; left -= 8) solve(left - 8, 8);
  for (int size = 4; size > 0; size /= 2) {
    if (left >= size) {
      left -= size;
      solve(left, size);
    }
  }
}

template <class Solve>
inline void for_supernodes(const Supernodes& factor, const Solve& solve) {
  for (int s = factor.count; s-- > 0;) {
    const int first = factor.super[s];
    const int end = factor.super[s + 1] < factor.columns ? factor.super[s + 1] : factor.columns;
    if (end <= first) continue;
    const int* rows = factor.rows + factor.row_begin[s];
    const int height = factor.row_begin[s + 1] - factor.row_begin[s];
    const int own = factor.super[s + 1] - first;  // rows that follow each other
    solve(factor.values + factor.value_begin[s], height, own, rows, first, end - first);
  }
}

void solve_one_backward(const Supernodes& factor, double* y) {
  for_supernodes(
      factor, [y](const double* l, int height, int own, const int* rows, int first, int columns) {
        double* x = y + first;
        for_panels(columns, [&](int begin, int count) {
          switch (count) {
            case 8:
              return solve_backward<8>(l, height, own, rows, begin, x, y);
            case 4:
              return solve_backward<4>(l, height, own, rows, begin, x, y);
            case 2:
              return solve_backward<2>(l, height, own, rows, begin, x, y);
            default:
              return solve_backward<1>(l, height, own, rows, begin, x, y);
          }
        });
      });
}

template <int groups>
void solve_block_backward(const Supernodes& factor, Lanes* y) {
  for_supernodes(
      factor, [y](const double* l, int height, int own, const int* rows, int first, int columns) {
        Lanes* x = y + static_cast<long>(first) * groups;
        for_panels(columns, [&](int begin, int count) {
          for (int k = begin + count; k-- > begin;) {
            const double* column = l + static_cast<long>(k) * height;
            Lanes sum[groups] = {};
            add_products_of_block<groups>(
                column, begin + count, own, x, [](int i) { return i; }, sum);
            add_products_of_block<groups>(
                column, own, height, y, [rows](int i) { return rows[i]; }, sum);
            for (int i = k + 1; i < begin + count; ++i) {
              for (int g = 0; g < groups; ++g) {
                sum[g] += column[i] * x[static_cast<long>(i) * groups + g];
              }
            }
            for (int g = 0; g < groups; ++g) {
              Lanes& value = x[static_cast<long>(k) * groups + g];
              value = (value - sum[g]) / column[k];
            }
          }
        });
      });
}

}  // namespace

void ANTICRACK_BACKWARD(const Supernodes& factor, int width, double* y) {
  Lanes* block = reinterpret_cast<Lanes*>(y);
  switch (width / lanes) {
    case 0:
      return solve_one_backward(factor, y);
    case 1:
      return solve_block_backward<1>(factor, block);
    case 2:
      return solve_block_backward<2>(factor, block);
    case 3:
      return solve_block_backward<3>(factor, block);
    default:
      return solve_block_backward<4>(factor, block);
  }
}

}  // namespace anticrack::ddm
