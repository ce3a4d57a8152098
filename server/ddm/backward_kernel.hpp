// SPDX-License-Identifier: GPL-3.0-or-later
//
// Backward substitution, for kernel_loops.hpp.
namespace anticrack::ddm {
namespace {

/// Rows whose products are summed separately; a column of a factor need not be aligned.
constexpr int rows_at_once = 8;
using Rows = double __attribute__((vector_size(rows_at_once * sizeof(double))));
using UnalignedRows =
    double __attribute__((vector_size(rows_at_once * sizeof(double)), aligned(sizeof(double))));

/// a b + c, fused if the processor does that fast, as in the compiler's code for vectors. Written
/// as a plain sum, it would be rounded twice where the compiler vectorises it.
inline double multiply_add(double a, double b, double c) {
#ifdef __FP_FAST_FMA
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}

/// The sum of the lanes of `sums`, in the order that all kernels and block widths use.
inline double total(const Rows& sums) {
  using Half = double __attribute__((vector_size(rows_at_once * sizeof(double) / 2)));
  const Half half = __builtin_shufflevector(sums, sums, 0, 1, 2, 3) +
                    __builtin_shufflevector(sums, sums, 4, 5, 6, 7);
  return (half[0] + half[2]) + (half[1] + half[3]);
}

// If the rows are not a whole number of lanes, the last group ends with the last row of the column,
// and its lanes of rows already summed add nothing: whatever a factor has above its diagonal is
// multiplied by zero there.

/// sum_k = sum of L_ik y_i over the rows from `from` on, for consecutive columns from l on; the
/// entries of y are fetched once for all columns. The first `own` entries of y are in x.
template <int columns>
inline void add_products(const double* l, int height, int own, const int* rows, int from,
                         const double* x, const double* y, double* sum) {
  const double* column[columns];
  Rows sums[columns];
  for (int k = 0; k < columns; ++k) {
    column[k] = l + static_cast<long>(k) * height;
    sums[k] = Rows{};
  }
  Rows values{};
  const auto add = [&](int i) {
#pragma GCC unroll 8
    for (int k = 0; k < columns; ++k)
      sums[k] += *reinterpret_cast<const UnalignedRows*>(column[k] + i) * values;
  };
  const auto gather = [&](int i) {
    for (int r = 0; r < rows_at_once; ++r) values[r] = y[rows[i + r]];
  };
  int i = from;
  for (; i + rows_at_once <= own; i += rows_at_once) {
    values = *reinterpret_cast<const UnalignedRows*>(x + i);
    add(i);
  }
  for (; i + rows_at_once <= height; i += rows_at_once) {
    gather(i);
    add(i);
  }
  for (int k = 0; k < columns; ++k) sum[k] = 0;
  if (i < height && height >= rows_at_once) {
    using Indices = long __attribute__((vector_size(rows_at_once * sizeof(long))));
    constexpr Indices lane = {0, 1, 2, 3, 4, 5, 6, 7};
    const int last = height - rows_at_once;
    gather(last);
    values = lane >= static_cast<long>(i - last) ? values : Rows{};
    add(last);
  } else {
    for (; i < height; ++i)
      for (int k = 0; k < columns; ++k) sum[k] = multiply_add(column[k][i], y[rows[i]], sum[k]);
  }
  for (int k = 0; k < columns; ++k) sum[k] += total(sums[k]);
}

/// Solves for columns of a supernode from `begin` on: first all rows below, then their triangle.
template <int columns>
inline void solve_backward(const double* l, int height, int own, const int* rows, int begin,
                           double* x, const double* y) {
  const double* panel = l + static_cast<long>(begin) * height;
  fetch(panel - ahead, columns * height);
  double value[columns];
  add_products<columns>(panel, height, own, rows, begin + columns, x, y, value);
#pragma GCC unroll 8
  for (int k = columns - 1; k >= 0; --k) {
    const double* column = panel + static_cast<long>(k) * height + begin;
    value[k] = x[begin + k] - value[k];
#pragma GCC unroll 8
    for (int i = columns - 1; i > k; --i) value[k] = multiply_add(-column[i], value[i], value[k]);
    value[k] *= 1 / column[k];  // needs no x, so it is ready early
    x[begin + k] = value[k];
  }
}

/// As add_products() for one column, on a block: the same products, summed in the same order.
template <int groups, class Lanes>
inline void add_products_of_block(const double* column, int height, int own, const int* rows,
                                  int from, const Lanes* x, const Lanes* y, Lanes* sum) {
  Lanes sums[rows_at_once][groups] = {};
  const auto add = [&](int i, int r, const Lanes* values) {
#pragma GCC unroll 4
    for (int g = 0; g < groups; ++g) sums[r][g] += column[i + r] * values[g];
  };
  const auto of_y = [&](int i) { return y + static_cast<long>(rows[i]) * groups; };
  int i = from;
  for (; i + rows_at_once <= own; i += rows_at_once) {
#pragma GCC unroll 8
    for (int r = 0; r < rows_at_once; ++r) add(i, r, x + static_cast<long>(i + r) * groups);
  }
  for (; i + rows_at_once <= height; i += rows_at_once) {
#pragma GCC unroll 8
    for (int r = 0; r < rows_at_once; ++r) add(i, r, of_y(i + r));
  }
  for (int g = 0; g < groups; ++g) sum[g] = Lanes{};
  if (i < height && height >= rows_at_once) {
    const int last = height - rows_at_once;
#pragma GCC unroll 8
    for (int r = 0; r < rows_at_once; ++r)
      if (last + r >= i) add(last, r, of_y(last + r));
  } else {
    for (; i < height; ++i)
      for (int g = 0; g < groups; ++g) sum[g] += column[i] * of_y(i)[g];
  }
  for (int g = 0; g < groups; ++g) {
    sum[g] += ((sums[0][g] + sums[4][g]) + (sums[2][g] + sums[6][g])) +
              ((sums[1][g] + sums[5][g]) + (sums[3][g] + sums[7][g]));
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
    const int own = factor.super[s + 1] - first;  // these rows are consecutive
    solve(factor.values + factor.value_begin[s], height, own, rows, first, end - first);
  }
}

void solve_one_backward(const Supernodes& factor, double* y) {
  Turns turns(factor, 1);
  for_supernodes(
      factor, [&](const double* l, int height, int own, const int* rows, int first, int columns) {
        double* x = y + first;
        turns.take(columns, height);
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

template <int groups, class Lanes>
void solve_block_backward(const Supernodes& factor, Lanes* y) {
  Turns turns(factor, groups * lanes);
  for_supernodes(
      factor, [&](const double* l, int height, int own, const int* rows, int first, int columns) {
        Lanes* x = y + static_cast<long>(first) * groups;
        for_panels(columns, [&](int begin, int count) {
          turns.take(count, height);
          for (int k = begin + count; k-- > begin;) {
            const double* column = l + static_cast<long>(k) * height;
            Lanes sum[groups];
            add_products_of_block<groups>(column, height, own, rows, begin + count, x, y, sum);
            const double inverse = 1 / column[k];
            for (int g = 0; g < groups; ++g) {
              Lanes value = x[static_cast<long>(k) * groups + g] - sum[g];
              for (int i = begin + count - 1; i > k; --i)
                value -= column[i] * x[static_cast<long>(i) * groups + g];
              x[static_cast<long>(k) * groups + g] = value * inverse;
            }
          }
        });
      });
}

void backward_solve(const Supernodes& factor, int width, double* y) {
  Lanes* block = reinterpret_cast<Lanes*>(y);
  if (width == few_lanes) return solve_block_backward<1>(factor, reinterpret_cast<FewLanes*>(y));
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

}  // namespace
}  // namespace anticrack::ddm
