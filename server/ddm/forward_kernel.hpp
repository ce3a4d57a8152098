// SPDX-License-Identifier: GPL-3.0-or-later
//
// Forward substitution, for kernel_loops.hpp.
namespace anticrack::ddm {
namespace {

using Lanes = double __attribute__((vector_size(lanes * sizeof(double))));
using FewLanes = double __attribute__((vector_size(few_lanes * sizeof(double))));

/// Columns of a supernode whose part of y stays in the first-level cache while rows are updated.
constexpr int panel_columns = 16;

// Every entry is computed as y_i <- y_i - L_ik y_k for k = 0, 1, ..., in this order, as a fused
// operation where the processor has one. So the bits do not depend on how the loops are grouped.

/// Updates the rows [from, to) of y at `row` from solved columns; l is the first column, x their y.
template <int columns, class Row>
inline void update_one(const double* l, int height, const double* x, int from, int to, double* y,
                       Row row) {
  const double* column[columns];
  double value[columns];
  for (int k = 0; k < columns; ++k) {
    column[k] = l + static_cast<long>(k) * height;
    value[k] = x[k];
  }
#pragma GCC ivdep
  for (int i = from; i < to; ++i) {
    double sum = y[row(i)];
#pragma GCC unroll 8
    for (int k = 0; k < columns; ++k) sum -= column[k][i] * value[k];
    y[row(i)] = sum;
  }
}

/// Solves for columns of a supernode from `begin` on: first their triangle, then all rows below.
template <int columns>
inline void solve_panel(const double* l, int height, int own, const int* rows, int begin, double* x,
                        double* y) {
  const double* panel_l = l + static_cast<long>(begin) * height;
  fetch(panel_l + ahead, columns * height);
  for (int k = 0; k < columns; ++k) {
    const double* column = panel_l + static_cast<long>(k) * height;
    const double value = x[begin + k] * (1 / column[begin + k]);  // the quotient needs no x
    x[begin + k] = value;
    for (int i = begin + k + 1; i < begin + columns; ++i) x[i] -= column[i] * value;
  }
  update_one<columns>(panel_l, height, x + begin, begin + columns, own, x, [](int i) { return i; });
  update_one<columns>(panel_l, height, x + begin, own, height, y,
                      [rows](int i) { return rows[i]; });
}

/// Whether all of y is 0, as beside a force on a few nodes: then its columns of L change nothing.
inline bool is_zero(const double* y, long count) {
  long i = 0;
  while (i < count && y[i] == 0) ++i;
  return i == count;
}

void solve_one(const Supernodes& factor, double* y) {
  Turns turns(factor, 1);
  for (int s = 0; s < factor.count && factor.super[s] < factor.columns; ++s) {
    const int first = factor.super[s];
    const int end = factor.super[s + 1] < factor.columns ? factor.super[s + 1] : factor.columns;
    if (is_zero(y + first, end - first)) continue;
    const int* rows = factor.rows + factor.row_begin[s];
    const int height = factor.row_begin[s + 1] - factor.row_begin[s];
    const int own = factor.super[s + 1] - first;  // these rows are consecutive
    const double* l = factor.values + factor.value_begin[s];
    double* x = y + first;
    turns.take(end - first, height);
    // Eight columns at once: fetching and storing the entries of y takes longer than a few columns.
    int begin = 0;
    for (; begin + 8 <= end - first; begin += 8) solve_panel<8>(l, height, own, rows, begin, x, y);
    if (begin + 4 <= end - first) {
      solve_panel<4>(l, height, own, rows, begin, x, y);
      begin += 4;
    }
    if (begin + 2 <= end - first) {
      solve_panel<2>(l, height, own, rows, begin, x, y);
      begin += 2;
    }
    if (begin < end - first) solve_panel<1>(l, height, own, rows, begin, x, y);
  }
}

/// Updates rows of y at `row` from the solved columns [begin, end) of a supernode, whose y is x.
template <int groups, int count, class Lanes, class Row>
inline void update(const double* l, int height, int begin, int end, const Lanes* x, int i, Lanes* y,
                   Row row) {
  Lanes sum[count][groups];
  for (int r = 0; r < count; ++r)
    for (int g = 0; g < groups; ++g) sum[r][g] = y[static_cast<long>(row(i + r)) * groups + g];
  for (int k = begin; k < end; ++k) {
    const double* column = l + static_cast<long>(k) * height + i;
    for (int r = 0; r < count; ++r)
      for (int g = 0; g < groups; ++g)
        sum[r][g] -= column[r] * x[static_cast<long>(k) * groups + g];
  }
  for (int r = 0; r < count; ++r)
    for (int g = 0; g < groups; ++g) y[static_cast<long>(row(i + r)) * groups + g] = sum[r][g];
}

template <int groups, class Lanes, class Row>
inline void update_rows(const double* l, int height, int begin, int end, const Lanes* x, int from,
                        int to, Lanes* y, Row row) {
  constexpr int count = ANTICRACK_ROWS / groups > 0 ? ANTICRACK_ROWS / groups : 1;
  int i = from;
  for (; i + count <= to; i += count) update<groups, count>(l, height, begin, end, x, i, y, row);
  for (; i < to; ++i) update<groups, 1>(l, height, begin, end, x, i, y, row);
}

template <int groups, class Lanes>
void solve_block(const Supernodes& factor, Lanes* y) {
  Turns turns(factor, groups * lanes);
  for (int s = 0; s < factor.count && factor.super[s] < factor.columns; ++s) {
    const int first = factor.super[s];
    const int end = factor.super[s + 1] < factor.columns ? factor.super[s + 1] : factor.columns;
    Lanes* x = y + static_cast<long>(first) * groups;
    constexpr long width = groups * sizeof(Lanes) / sizeof(double);
    if (is_zero(reinterpret_cast<const double*>(x), width * (end - first))) continue;
    const int* rows = factor.rows + factor.row_begin[s];
    const int height = factor.row_begin[s + 1] - factor.row_begin[s];
    const int own = factor.super[s + 1] - first;
    const double* l = factor.values + factor.value_begin[s];
    for (int begin = 0; begin < end - first; begin += panel_columns) {
      turns.take(panel_columns, height);
      const int stop = begin + panel_columns < end - first ? begin + panel_columns : end - first;
      for (int k = begin; k < stop; ++k) {
        const double* column = l + static_cast<long>(k) * height;
        const double inverse = 1 / column[k];
        for (int g = 0; g < groups; ++g) {
          const Lanes value = x[static_cast<long>(k) * groups + g] * inverse;
          x[static_cast<long>(k) * groups + g] = value;
          for (int i = k + 1; i < stop; ++i)
            x[static_cast<long>(i) * groups + g] -= column[i] * value;
        }
      }
      update_rows<groups>(l, height, begin, stop, x, stop, own, x, [](int i) { return i; });
      update_rows<groups>(l, height, begin, stop, x, own, height, y,
                          [rows](int i) { return rows[i]; });
    }
  }
}

void forward_solve(const Supernodes& factor, int width, double* y) {
  Lanes* block = reinterpret_cast<Lanes*>(y);
  if (width == few_lanes) return solve_block<1>(factor, reinterpret_cast<FewLanes*>(y));
  switch (width / lanes) {
    case 0:
      return solve_one(factor, y);
    case 1:
      return solve_block<1>(factor, block);
    case 2:
      return solve_block<2>(factor, block);
    case 3:
      return solve_block<3>(factor, block);
    default:
      return solve_block<4>(factor, block);
  }
}

}  // namespace
}  // namespace anticrack::ddm
