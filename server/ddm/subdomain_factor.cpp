// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/subdomain_factor.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "base/at.hpp"
#include "ddm/blas.hpp"
#include "ddm/cholmod.hpp"
#include "ddm/kernels.hpp"
#include "ddm/multifrontal.hpp"
#include "errors/errors.hpp"
#include "stop/stop.hpp"

namespace anticrack::ddm {
namespace {

struct FreeValues {
  void operator()(double* values) const noexcept { std::free(values); }
};
using Values = std::unique_ptr<double, FreeValues>;

/// Allocates values, uninitialised and aligned to a cache line; large blocks are on huge pages if
/// available, as page faults took a tenth of the factorisation. Throws errors::Error
/// (limit_exceeded) if there is not enough memory.
Values make_values(std::size_t count) {
  constexpr std::size_t cache_line = 64, huge_page = std::size_t{2} << 20;
  const std::size_t bytes = sizeof(double) * count;
  const std::size_t alignment = bytes >= 4 * huge_page ? huge_page : cache_line;
  Values values(static_cast<double*>(
      std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment)));
  if (!values) {
    throw errors::Error(
        errors::Reason::limit_exceeded,
        "no memory for the factor of a subdomain; take a coarser mesh (larger size or tip_size)");
  }
  if (alignment == huge_page) {
    // This is only a hint: small pages work as well.
    static_cast<void>(madvise(values.get(), bytes / huge_page * huge_page, MADV_HUGEPAGE));
  }
  return values;
}

}  // namespace

struct SubdomainFactor::Factor {
  FactorPtr analysis;      // CHOLMOD's permutation and pattern, without values
  std::vector<int> place;  // position of each unknown in L
  Values values;           // of L_II and L_GI
  Supernodes l;
};

namespace {

using Sparse = Eigen::SparseMatrix<double>;

Supernodes pattern(const cholmod_factor& factor, Eigen::Index interior) {
  return {static_cast<int>(factor.nsuper),
          static_cast<int>(interior),
          static_cast<const int*>(factor.super),
          static_cast<const int*>(factor.pi),
          static_cast<const int*>(factor.px),
          static_cast<const int*>(factor.s),
          nullptr,
          [] { stop::look("solving on a mesh"); }};
}

/// How many values the supernodes with columns of the interior have.
std::size_t value_count(const Supernodes& l) {
  int end = 0;
  while (end < l.count && l.super[end] < l.columns) ++end;
  return at(l.value_begin[end]);
}

/// Calls take(begin, end, column) for tiles of few rows, so that the rows of a block stay in the
/// first-level cache while they are accessed by columns.
template <class Take>
void for_tiles(int rows, int columns, const Take& take) {
  constexpr int tile = 256;
  for (int begin = 0; begin < rows; begin += tile) {
    stop::look_at_turn<std::size_t{1} << 14>(at(begin), "solving on a mesh");
    for (int j = 0; j < columns; ++j) take(begin, std::min(begin + tile, rows), j);
  }
}

/// Solves columns in blocks of up to columns_at_once(rows): `solve(width, block)` works on a
/// row-major block. `put` and `take` (column, begin, end, at, stride) write and read rows [begin,
/// end) of a column; row i of the block is at[i * stride]. If rows are permuted, begin and end
/// count rows of the column, not of the block. `more_rows`: after these, for `solve` alone.
template <class Put, class Solve, class Take>
void in_blocks(int rows, int columns, const Put& put, const Solve& solve, const Take& take,
               int more_rows = 0) {
  const auto whole = [](int count) {
    if (count <= few_lanes) return count == 1 ? 1 : few_lanes;
    return (count + lanes - 1) / lanes * lanes;
  };
  const int most = static_cast<int>(columns_at_once(rows + more_rows));
  const int widest = whole(std::min(columns, most));
  const Values y = make_values(at(rows + more_rows) * at(widest));
  for (int first = 0; first < columns; first += most) {
    const int count = std::min(most, columns - first);
    const std::ptrdiff_t width = whole(count);
    for_tiles(rows, count,
              [&](int begin, int end, int j) { put(first + j, begin, end, y.get() + j, width); });
    for (int i = 0; i < rows && count < width; ++i) {
      double* row = y.get() + i * width;
      std::fill(row + count, row + width, 0.0);
    }
    solve(static_cast<int>(width), y.get());
    for_tiles(rows, count,
              [&](int begin, int end, int j) { take(first + j, begin, end, y.get() + j, width); });
  }
}

}  // namespace

Eigen::Index columns_at_once(Eigen::Index rows) noexcept {
  constexpr Eigen::Index most = most_lanes, bytes = Eigen::Index{64} << 20;
  const Eigen::Index column = static_cast<Eigen::Index>(sizeof(double)) * rows;
  return std::clamp<Eigen::Index>(bytes / std::max<Eigen::Index>(column, 1), 1, most);
}

SubdomainFactor::SubdomainFactor(const Sparse& stiffness, Eigen::Index interior,
                                 std::span<const std::int32_t> order, int threads)
    : _interior(interior), _trace(stiffness.rows() - interior) {
  if (stiffness.rows() == 0)
    return;  // u is prescribed in every node; CHOLMOD refuses empty matrices
  std::vector<int> permutation(at(stiffness.rows()));
  std::iota(std::copy(order.begin(), order.end(), permutation.begin()), permutation.end(),
            static_cast<int>(interior));
  auto factor = std::make_unique<Factor>();
  stop::look("analysing a factor");
  factor->analysis = analyse(stiffness, permutation, interior);
  factor->l = pattern(*factor->analysis, interior);
  const int* unknown = static_cast<const int*>(factor->analysis->Perm);
  factor->place.resize(factor->analysis->n);
  for (int k = 0; k < static_cast<int>(stiffness.rows()); ++k) factor->place[at(unknown[k])] = k;
  factor->values = make_values(value_count(factor->l));
  factor->l.values = factor->values.get();
  if (!eliminate_interior(factor->l, factor->place, stiffness, factor->values.get(), _schur,
                          threads)) {
    throw errors::Error(
        errors::Reason::numerical,
        "the stiffness matrix is not positive definite in the factorisation of a "
        "subdomain; the mesh has triangles that are degenerate, or is badly scaled");
  }
  _factor = std::move(factor);
}

SubdomainFactor::~SubdomainFactor() = default;
SubdomainFactor::SubdomainFactor(SubdomainFactor&&) noexcept = default;
SubdomainFactor& SubdomainFactor::operator=(SubdomainFactor&&) noexcept = default;

std::vector<SubdomainFactor::Forward> SubdomainFactor::forward(
    const Eigen::Ref<const Eigen::MatrixXd>& f) const {
  std::vector<Forward> result;
  forward(f, result);
  return result;
}

void SubdomainFactor::forward(const Eigen::Ref<const Eigen::MatrixXd>& f,
                              std::vector<Forward>& result) const {
  result.resize(at(f.cols()));
  for (Forward& column : result) {
    column.z_interior.resize(_interior);
    column.g.resize(trace());
  }
  if (!_factor || f.cols() == 0) return;
  const int* place = _factor->place.data();
  const auto interior = static_cast<int>(_interior);
  in_blocks(
      static_cast<int>(f.rows()), static_cast<int>(f.cols()),
      [&](int j, int begin, int end, double* to, std::ptrdiff_t stride) {
        const double* from = f.data() + j * f.outerStride();
        for (int i = begin; i < end; ++i) to[place[i] * stride] = from[i] + 0.0;  // -0 as 0
      },
      [&](int width, double* y) { best_kernels().forward(_factor->l, width, y); },
      [&](int j, int begin, int end, const double* from, std::ptrdiff_t stride) {
        Forward& column = result[at(j)];
        const int middle = std::clamp(interior, begin, end);
        for (int i = begin; i < middle; ++i) column.z_interior[i] = from[i * stride];
        for (int i = middle; i < end; ++i) column.g[i - interior] = from[i * stride];
      });
}

void SubdomainFactor::recover(std::span<Backward> columns) const {
  if (!_factor || columns.empty()) return;
  const int* place = _factor->place.data();
  const auto interior = static_cast<int>(_interior);
  in_blocks(
      static_cast<int>(_interior + trace()), static_cast<int>(columns.size()),
      [&](int j, int begin, int end, double* to, std::ptrdiff_t stride) {
        const auto& [z_interior, trace_values, u] = columns[at(j)];
        const int middle = std::clamp(interior, begin, end);
        for (int i = begin; i < middle; ++i) to[i * stride] = z_interior[i];
        for (int i = middle; i < end; ++i) to[i * stride] = trace_values[i - interior];
      },
      [&](int width, double* y) { best_kernels().backward(_factor->l, width, y); },
      [&](int j, int begin, int end, const double* from, std::ptrdiff_t stride) {
        Eigen::Ref<Eigen::VectorXd>& to = columns[at(j)].u;
        for (int i = begin; i < end; ++i) to[i] = from[place[i] * stride];
      });
}

void SubdomainFactor::solve(const Eigen::Ref<const Eigen::MatrixXd>& f,
                            Eigen::Ref<Eigen::MatrixXd> x) const {
  if (!_factor || f.cols() == 0) return;
  const int* place = _factor->place.data();
  const auto interior = static_cast<int>(_interior);
  in_blocks(
      interior, static_cast<int>(f.cols()),
      [&](int j, int begin, int end, double* to, std::ptrdiff_t stride) {
        const double* from = f.data() + j * f.outerStride();
        for (int i = begin; i < end; ++i) to[place[i] * stride] = from[i] + 0.0;  // -0 as 0
      },
      [&](int width, double* y) {
        const auto clear_trace = [&] {
          std::fill(y + _interior * width, y + (_interior + _trace) * width, 0.0);
        };
        clear_trace();
        best_kernels().forward(_factor->l, width, y);
        clear_trace();  // from the condensed load to u there
        best_kernels().backward(_factor->l, width, y);
      },
      [&](int j, int begin, int end, const double* from, std::ptrdiff_t stride) {
        double* to = x.data() + j * x.outerStride();
        for (int i = begin; i < end; ++i) to[i] = from[place[i] * stride];
      },
      static_cast<int>(_trace));
}

Eigen::VectorXd SubdomainFactor::apply_schur(const Eigen::VectorXd& trace_values) const {
  Eigen::VectorXd result(trace_values.size());
  apply_schur(trace_values, result);
  return result;
}

void SubdomainFactor::apply_schur(const Eigen::Ref<const Eigen::VectorXd>& trace_values,
                                  Eigen::Ref<Eigen::VectorXd> result) const {
  multiply_symmetric(_schur, trace_values.data(), result.data());
}

std::size_t SubdomainFactor::bytes() const noexcept {
  if (!_factor) return 0;
  const cholmod_factor& analysis = *_factor->analysis;
  const std::size_t integers = analysis.ssize + 3 * (analysis.nsuper + 1) + 3 * analysis.n;
  return sizeof(double) * (value_count(_factor->l) + at(_schur.size())) + sizeof(int) * integers +
         sizeof(cholmod_factor);
}

}  // namespace anticrack::ddm
