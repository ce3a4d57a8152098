// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/multifrontal.hpp"

#include <cblas.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "errors/errors.hpp"
#include "stop/stop.hpp"

extern "C" void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);

namespace anticrack::ddm {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr const char* factorising = "factorising a mesh";

/// Entries of the permuted K by column, without the G-G part, which is in S.
struct SparseColumns {
  std::vector<int> begin;
  std::vector<int> row;
  std::vector<double> value;
};

/// Calls take(row, column, value) for each entry of the lower triangle of the permuted K.
template <class Take>
void for_each_entry(const Sparse& stiffness, std::span<const int> place, const Take& take) {
  const int *begin = stiffness.outerIndexPtr(), *row = stiffness.innerIndexPtr();
  const double* value = stiffness.valuePtr();
  for (int j = 0; j < static_cast<int>(stiffness.cols()); ++j) {
    stop::look_at_turn<stop::quick>(at(j), factorising);
    for (int e = begin[j]; e < begin[j + 1]; ++e) {
      if (row[e] >= j) {
        const auto [column, below] = std::minmax(place[at(row[e])], place[at(j)]);
        take(below, column, value[e]);
      }
    }
  }
}

SparseColumns permuted(const Sparse& stiffness, std::span<const int> place, int interior,
                       Eigen::MatrixXd& schur) {
  const auto n = static_cast<int>(stiffness.rows());
  SparseColumns columns;
  columns.begin.assign(at(interior) + 1, 0);
  schur.setZero(n - interior, n - interior);
  for_each_entry(stiffness, place, [&](int row, int column, double value) {
    if (column < interior)
      ++columns.begin[at(column)];
    else
      schur(row - interior, column - interior) += value;
  });
  int end = 0;
  for (int& begin : columns.begin) {
    end += begin;
    begin = end;
  }
  columns.row.resize(at(end));
  columns.value.resize(at(end));
  for_each_entry(stiffness, place, [&](int row, int column, double value) {
    if (column < interior) {
      const std::size_t e = at(--columns.begin[at(column)]);
      columns.row[e] = row;
      columns.value[e] = value;
    }
  });
  return columns;
}

/// The remainder of a front, (size,size) column-major, lower triangle; row[0..size-1] are its rows.
struct Update {
  std::unique_ptr<double[]> values;
  const int* row = nullptr;
  int size = 0;
  int next = -1;  ///< the next child of the same parent, or -1
};

/// The front that a thread works on, and the places of rows in it.
struct Front {
  explicit Front(std::size_t unknowns) : place(unknowns) {}

  /// Finds the places of the rows of a child's update.
  void find_places(const Update& child) {
    relative.resize(at(child.size));
    for (int i = 0; i < child.size; ++i) {
      const int found = place[at(child.row[i])];
      if (found >= height || rows[found] != child.row[i]) {
        throw errors::Error(errors::Reason::internal,
                            "the pattern of a factor lacks a row of one of its children");
      }
      relative[at(i)] = found;
    }
  }

  /// How many rows of the child passed to find_places() last are among the first `own` of the
  /// front.
  int columns_before(int own) const {
    return static_cast<int>(std::lower_bound(relative.begin(), relative.end(), own) -
                            relative.begin());
  }

  /// Adds the columns [from, to) of a child to columns of the front, which `target` gives.
  template <class Target>
  void add(const Update& child, int from, int to, int shift, const Target& target) const {
    for (int j = from; j < to; ++j) {
      const double* source = child.values.get() + std::ptrdiff_t{j} * child.size;
      double* column = target(relative[at(j)]) - shift;
      for (int i = j; i < child.size; ++i) column[relative[at(i)]] += source[i];
    }
  }

  const int* rows = nullptr;
  int height = 0;
  std::vector<int> place;     // of each unknown: its row in the front, if it has one
  std::vector<int> relative;  // of each row of a child: its row in the front
};

class Elimination {
 public:
  Elimination(const Supernodes& pattern, SparseColumns columns, double* values,
              Eigen::MatrixXd& schur)
      : _pattern(pattern),
        _columns(std::move(columns)),
        _values(values),
        _schur(schur),
        _supernode(at(pattern.columns)) {
    while (_count < pattern.count && pattern.super[_count] < pattern.columns) {
      const int end = std::min(pattern.super[_count + 1], pattern.columns);
      for (int j = pattern.super[_count]; j < end; ++j) _supernode[at(j)] = _count;
      ++_count;
    }
    _update.resize(at(_count));
    _child.assign(at(_count), -1);
  }

  bool run(int threads) {
    const Subtrees subtrees =
        threads > 1 ? part(tree(), threads) : Subtrees{{}, std::vector<int>(at(_count), -1)};
    if (!run(subtrees, threads)) return false;
    // Updates are passed on in serial order, so the bits do not depend on the number of threads.
    Front front = new_front();
    for (int s = 0; s < _count; ++s) {
      const int root = subtrees.root[at(s)];
      if (root < 0 && !eliminate(s, front)) return false;
      if ((root < 0 || root == s) && _update[at(s)].size > 0) pass_on(s);
    }
    return true;
  }

 private:
  Front new_front() const { return Front(at(_pattern.columns) + at(_schur.rows())); }
  int own(int s) const {
    return std::min(_pattern.super[s + 1], _pattern.columns) - _pattern.super[s];
  }
  int height(int s) const { return _pattern.row_begin[s + 1] - _pattern.row_begin[s]; }
  double work_of(int s) const { return double(own(s)) * height(s) * height(s); }

  EliminationTree tree() const {
    EliminationTree result{std::vector<int>(at(_count), -1), std::vector<double>(at(_count))};
    for (int s = 0; s < _count; ++s) {
      result.work[at(s)] = work_of(s);
      if (own(s) == height(s)) continue;
      const int next = _pattern.rows[_pattern.row_begin[s] + own(s)];
      if (next < _pattern.columns) result.parent[at(s)] = _supernode[at(next)];
    }
    return result;
  }

  /// Eliminates the subtrees on `threads` threads; false if a front is not positive definite.
  bool run(const Subtrees& subtrees, int threads) {
    std::atomic<bool> definite{true};
    base::at_once(subtrees.nodes.size(), threads, [&] {
      return [&, front = new_front()](std::size_t t) mutable {
        for (const int s : subtrees.nodes[t]) {
          if (!definite) return;
          if (!eliminate(s, front))
            definite = false;
          else if (subtrees.root[at(s)] != s && _update[at(s)].size > 0)
            pass_on(s);
        }
      };
    });
    return definite;
  }

  /// Eliminates the front of supernode s and leaves the remainder in _update. The children must
  /// have been eliminated before.
  bool eliminate(int s, Front& front) {
    if (s % 16 == 0 || work_of(s) > large) stop::look(factorising);
    const int first = _pattern.super[s], columns = own(s);
    front.rows = _pattern.rows + _pattern.row_begin[s];
    front.height = height(s);
    const int rest = front.height - columns;
    double* panel = _values + _pattern.value_begin[s];
    std::fill_n(panel, std::ptrdiff_t{columns} * front.height, 0.0);
    for (int i = 0; i < front.height; ++i) front.place[at(front.rows[i])] = i;
    for (int j = 0; j < columns; ++j) {
      double* column = panel + std::ptrdiff_t{j} * front.height;
      for (int e = _columns.begin[at(first + j)]; e < _columns.begin[at(first + j) + 1]; ++e)
        column[front.place[at(_columns.row[at(e)])]] += _columns.value[at(e)];
    }
    // Add the children's columns that are eliminated here; the others go to the update below.
    for (int c = _child[at(s)]; c >= 0; c = _update[at(c)].next) {
      const Update& child = _update[at(c)];
      front.find_places(child);
      front.add(child, 0, front.columns_before(columns), 0,
                [&](int column) { return panel + std::ptrdiff_t{column} * front.height; });
    }
    // The last front often has all of G below it; its remainder is then formed in S directly.
    const bool onto_schur = rest == static_cast<int>(_schur.rows()) && rest > 0 &&
                            front.rows[columns] >= _pattern.columns;
    Update left{{}, front.rows + columns, rest, -1};
    if (!onto_schur) left.values.reset(new double[at(rest) * at(rest)]);
    double* update = onto_schur ? _schur.data() : left.values.get();
    if (!eliminate_front(columns, front.height, panel, update, onto_schur)) return false;
    for (int c = _child[at(s)]; c >= 0; c = _update[at(c)].next) {
      Update& child = _update[at(c)];
      front.find_places(child);
      front.add(child, front.columns_before(columns), child.size, columns,
                [&](int column) { return update + std::ptrdiff_t{column - columns} * rest; });
      child.values.reset();
    }
    if (!onto_schur) _update[at(s)] = std::move(left);
    return true;
  }

  /// Passes the remainder on to the parent, or adds it to S if no interior unknown is left in it.
  void pass_on(int s) {
    const int interior = _pattern.columns;
    Update& update = _update[at(s)];
    if (*update.row < interior) {
      int& siblings = _child[at(_supernode[at(*update.row)])];
      update.next = siblings;
      siblings = s;
      return;
    }
    for (int j = 0; j < update.size; ++j) {
      double* column = &_schur(0, update.row[j] - interior) - interior;
      const double* source = update.values.get() + std::ptrdiff_t{j} * update.size;
      for (int i = j; i < update.size; ++i) column[update.row[i]] += source[i];
    }
    update.values.reset();
  }

  static constexpr double large = 1e6;  // work of a front that takes a tenth of a millisecond

  const Supernodes& _pattern;
  const SparseColumns _columns;
  double* _values;
  Eigen::MatrixXd& _schur;
  int _count = 0;               // supernodes with interior columns
  std::vector<int> _supernode;  // of each interior column
  std::vector<int> _child;      // of each supernode: the child passed on last, or -1
  std::vector<Update> _update;  // of each supernode: its remainder, until the parent has added it
};

}  // namespace

namespace {

bool positive_diagonal(int columns, const double* panel, int height) {
  for (int k = 0; k < columns; ++k)  // OpenBLAS does not stop at NaN
    if (!(panel[std::ptrdiff_t{k} * (height + 1)] > 0)) return false;
  return true;
}

/// How many rows of a product take some milliseconds, at `each` multiplications a row. A multiple
/// of the rows that BLAS takes at once.
int rows_between_looks(double each) {
  constexpr double most = 5e7, together = 96, largest = 1 << 20;
  return static_cast<int>(together * std::clamp(std::floor(most / each / together), 1.0, largest));
}

/// Calls part(first, count) for groups of rows of a product, and looks before each call.
template <class Part>
void for_rows(int rows, double each, const Part& part) {
  const int most = rows_between_looks(each);
  for (int first = 0; first < rows; first += most) {
    stop::look(factorising);
    part(first, std::min(most, rows - first));
  }
}

/// C -= A A' below and on the diagonal of C, for A of `depth` columns. C begins at a row of A, and
/// has at most as many columns as rows.
void subtract_products(const double* a, int leading, int depth, int rows, int columns, double* c,
                       int leading_c) {
  constexpr int block = 256;
  for (int j = 0; j < columns; j += block) {
    const int own = std::min(block, columns - j), below = rows - j - own;
    double* const corner = c + std::ptrdiff_t{j} * leading_c + j;
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, own, depth, -1, a + j, leading, 1, corner,
                leading_c);
    for_rows(below, double(own) * depth, [&](int first, int count) {
      cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, count, own, depth, -1,
                  a + j + own + first, leading, a + j, leading, 1, corner + own + first, leading_c);
    });
  }
}

/// As eliminate_front, in blocks of columns.
bool eliminate_large_front(int columns, int height, double* panel, double* update, bool add) {
  constexpr int block = 256;
  for (int first = 0; first < columns; first += block) {
    stop::look(factorising);
    const int width = std::min(block, columns - first), next = first + width;
    double* const corner = panel + std::ptrdiff_t{first} * (height + 1);
    int info = 0;
    dpotrf_("L", &width, corner, &height, &info);
    if (info != 0 || !positive_diagonal(width, corner, height)) return false;
    if (next == height) return true;
    for_rows(height - next, double(width) * width, [&](int row, int count) {
      cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, count, width, 1,
                  corner, height, corner + width + row, height);
    });
    subtract_products(corner + width, height, width, height - next, columns - next,
                      panel + std::ptrdiff_t{next} * (height + 1), height);
  }
  const int rest = height - columns;
  if (!add) std::fill_n(update, std::ptrdiff_t{rest} * rest, 0.0);
  subtract_products(panel + columns, height, columns, rest, rest, update, rest);
  return true;
}

}  // namespace

bool eliminate_front(int columns, int height, double* panel, double* update, bool add) {
  const int rest = height - columns;
  // A call of BLAS costs as much as thousands of operations.
  constexpr double few = 40'000;
  if (static_cast<double>(columns) * height * height < few)
    return best_kernels().eliminate_small_front(columns, height, panel, update, add);
  constexpr double many = 1e8;  // some milliseconds
  if (static_cast<double>(columns) * height * height > many)
    return eliminate_large_front(columns, height, panel, update, add);
  int info = 0;
  dpotrf_("L", &columns, panel, &height, &info);
  if (info != 0 || !positive_diagonal(columns, panel, height)) return false;
  if (rest == 0) return true;
  double* below = panel + columns;
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, rest, columns, 1,
              panel, height, below, height);
  cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, rest, columns, -1, below, height,
              add ? 1 : 0, update, rest);
  return true;
}

bool eliminate_interior(const Supernodes& pattern, std::span<const int> place,
                        const Sparse& stiffness, double* values, Eigen::MatrixXd& schur,
                        int threads) {
  SparseColumns columns = permuted(stiffness, place, pattern.columns, schur);
  if (!Elimination(pattern, std::move(columns), values, schur).run(threads)) return false;
  schur.triangularView<Eigen::StrictlyUpper>() = schur.transpose();
  return true;
}

}  // namespace anticrack::ddm
