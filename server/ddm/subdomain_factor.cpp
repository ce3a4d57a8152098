// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/subdomain_factor.hpp"

#include <cblas.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>
#include <numeric>
#include <vector>

#include "ddm/cholmod.hpp"
#include "ddm/forward_solve.hpp"
#include "errors/errors.hpp"

namespace anticrack::ddm {

struct SubdomainFactor::Factor {
  FactorPtr cholesky;
};

namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// CHOLMOD's view of the lower triangle of a compressed symmetric matrix. It takes the matrix
/// without const but only reads it.
cholmod_sparse view(const Sparse& matrix) {
  cholmod_sparse result{};
  result.nrow = static_cast<std::size_t>(matrix.rows());
  result.ncol = static_cast<std::size_t>(matrix.cols());
  result.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  result.p = const_cast<int*>(matrix.outerIndexPtr());
  result.i = const_cast<int*>(matrix.innerIndexPtr());
  result.x = const_cast<double*>(matrix.valuePtr());
  result.stype = -1;
  result.itype = CHOLMOD_INT;
  result.xtype = CHOLMOD_REAL;
  result.dtype = CHOLMOD_DOUBLE;
  result.sorted = 1;
  result.packed = 1;
  return result;
}

bool keeps_trace_last(const cholmod_factor& factor, Eigen::Index interior) {
  const int* permutation = static_cast<const int*>(factor.Perm);
  for (auto i = static_cast<std::size_t>(interior); i < factor.n; ++i) {
    if (permutation[i] != static_cast<int>(i)) {
      return false;
    }
  }
  return true;
}

FactorPtr analyze(cholmod_sparse& matrix, std::vector<int>& permutation, bool postorder) {
  cholmod_common& context = cholmod_context();
  context.postorder = postorder ? 1 : 0;
  FactorPtr factor(cholmod_analyze_p(&matrix, permutation.data(), nullptr, 0, &context));
  require_success(context, "the analysis of a subdomain");
  return factor;
}

FactorPtr factorise(const Sparse& lower, std::vector<int>& permutation, Eigen::Index interior) {
  cholmod_sparse matrix = view(lower);
  FactorPtr factor = analyze(matrix, permutation, true);
  // The interface is a clique at the root of the elimination tree, so postordering leaves it where
  // it is, unless the interior falls apart and the tree has several roots.
  if (!keeps_trace_last(*factor, interior)) {
    factor = analyze(matrix, permutation, false);
    if (!keeps_trace_last(*factor, interior)) {
      throw errors::Error(errors::Reason::internal,
                          "the analysis of a subdomain moved its interface nodes");
    }
  }
  cholmod_common& context = cholmod_context();
  cholmod_factorize(&matrix, factor.get(), &context);
  require_success(context, "the factorisation of a subdomain");
  if (factor->is_super == 0 || factor->is_ll == 0) {
    throw errors::Error(errors::Reason::internal, "CHOLMOD left no supernodal LL' factor");
  }
  return factor;
}

/// The lower triangle of the last `size` rows and columns of L.
Eigen::MatrixXd trailing_block(const cholmod_factor& factor, Eigen::Index size) {
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(size, size);
  const Eigen::Index first = static_cast<Eigen::Index>(factor.n) - size;
  const int* super = static_cast<const int*>(factor.super);
  const int* pattern_begin = static_cast<const int*>(factor.pi);
  const int* value_begin = static_cast<const int*>(factor.px);
  const int* pattern = static_cast<const int*>(factor.s);
  const double* value = static_cast<const double*>(factor.x);
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const std::ptrdiff_t rows = pattern_begin[s + 1] - pattern_begin[s];
    for (std::ptrdiff_t column = super[s]; column < super[s + 1]; ++column) {
      if (column < first) {
        continue;
      }
      const std::ptrdiff_t local = column - super[s];
      for (std::ptrdiff_t r = local; r < rows; ++r) {
        block(pattern[pattern_begin[s] + r] - first, column - first) =
            value[value_begin[s] + local * rows + r];
      }
    }
  }
  return block;
}

Supernodes supernodes(const cholmod_factor& factor, Eigen::Index interior) {
  return {static_cast<int>(factor.nsuper),       static_cast<int>(interior),
          static_cast<const int*>(factor.super), static_cast<const int*>(factor.pi),
          static_cast<const int*>(factor.px),    static_cast<const int*>(factor.s),
          static_cast<const double*>(factor.x)};
}

struct Free {
  void operator()(double* values) const noexcept { std::free(values); }
};

/// Rows of a block as forward_solve() wants them.
std::unique_ptr<double, Free> aligned_rows(Eigen::Index rows, int width) {
  constexpr std::size_t alignment = lanes * sizeof(double);
  const std::size_t bytes = sizeof(double) * static_cast<std::size_t>(rows * width);
  std::unique_ptr<double, Free> values(static_cast<double*>(
      std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment)));
  if (!values) {
    throw std::bad_alloc();
  }
  return values;
}

/// L L' of a lower triangle, in place, its lower triangle only: [A 0; B C] has
/// [AA' .; BA' BB'+CC']. n^3/3 operations.
void square(double* l, int size, int stride) {
  constexpr int small = 64;
  if (size <= small) {
    for (int j = size - 1; j >= 0; --j) {
      for (int i = size - 1; i >= j; --i) {
        double sum = 0;
        for (int k = 0; k <= j; ++k) {
          sum += l[i + std::ptrdiff_t{k} * stride] * l[j + std::ptrdiff_t{k} * stride];
        }
        l[i + std::ptrdiff_t{j} * stride] = sum;
      }
    }
    return;
  }
  const int first = size / 2, rest = size - first;
  double* below = l + first;
  double* corner = l + first + std::ptrdiff_t{first} * stride;
  square(corner, rest, stride);
  cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, rest, first, 1, below, stride, 1, corner,
              stride);
  cblas_dtrmm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, rest, first, 1, l,
              stride, below, stride);
  square(l, first, stride);
}

/// Columns of the answer follow each other.
DensePtr triangular_solve(int system, const cholmod_factor& factor,
                          Eigen::MatrixXd& right_hand_sides) {
  cholmod_dense b{};
  b.nrow = b.d = static_cast<std::size_t>(right_hand_sides.rows());
  b.ncol = static_cast<std::size_t>(right_hand_sides.cols());
  b.nzmax = static_cast<std::size_t>(right_hand_sides.size());
  b.x = right_hand_sides.data();
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_common& context = cholmod_context();
  // CHOLMOD takes the factor without const but only reads a supernodal one.
  DensePtr x(cholmod_solve(system, const_cast<cholmod_factor*>(&factor), &b, &context));
  require_success(context, "a triangular solve");
  return x;
}

Eigen::Map<const Eigen::MatrixXd> view(const cholmod_dense& matrix) {
  return {static_cast<const double*>(matrix.x), static_cast<Eigen::Index>(matrix.nrow),
          static_cast<Eigen::Index>(matrix.ncol)};
}

}  // namespace

Eigen::Index columns_at_once(Eigen::Index rows) noexcept {
  constexpr Eigen::Index most = 32, bytes = Eigen::Index{64} << 20;
  const Eigen::Index column = static_cast<Eigen::Index>(sizeof(double)) * rows;
  return std::clamp<Eigen::Index>(bytes / std::max<Eigen::Index>(column, 1), 1, most);
}

SubdomainFactor::SubdomainFactor(const Sparse& stiffness, Eigen::Index interior,
                                 std::span<const std::int32_t> order,
                                 std::span<const std::int32_t> floating)
    : _interior(interior), _held(floating.begin(), floating.end()) {
  if (stiffness.rows() == 0) {
    return;  // u is prescribed in every node; CHOLMOD refuses empty matrices
  }
  std::vector<int> permutation(static_cast<std::size_t>(stiffness.rows()));
  std::iota(std::copy(order.begin(), order.end(), permutation.begin()), permutation.end(),
            static_cast<int>(interior));
  Sparse held;
  if (!_held.empty()) {
    held = stiffness;
    _rho = stiffness.diagonal().mean();
    for (const std::int32_t trace : _held) {
      held.coeffRef(interior + trace, interior + trace) += _rho;
    }
  }
  FactorPtr cholesky = factorise(_held.empty() ? stiffness : held, permutation, interior);
  _trace_factor = trailing_block(*cholesky, stiffness.rows() - interior);
  _factor = std::make_unique<Factor>(Factor{std::move(cholesky)});
}

SubdomainFactor::~SubdomainFactor() = default;
SubdomainFactor::SubdomainFactor(SubdomainFactor&&) noexcept = default;
SubdomainFactor& SubdomainFactor::operator=(SubdomainFactor&&) noexcept = default;

SubdomainFactor::Forward SubdomainFactor::forward(
    const Eigen::Ref<const Eigen::MatrixXd>& f) const {
  Forward result{Eigen::MatrixXd(_interior, f.cols()), Eigen::MatrixXd(trace(), f.cols())};
  if (!_factor || f.cols() == 0) {
    return result;
  }
  const cholmod_factor& factor = *_factor->cholesky;
  const int* permutation = static_cast<const int*>(factor.Perm);
  const Supernodes l = supernodes(factor, _interior);
  const Eigen::Index rows = f.rows();
  const auto whole = [](Eigen::Index columns) {
    return columns == 1 ? 1 : (static_cast<int>(columns) + lanes - 1) / lanes * lanes;
  };
  const auto y = aligned_rows(rows, whole(std::min<Eigen::Index>(f.cols(), most_lanes)));
  for (Eigen::Index first = 0; first < f.cols(); first += most_lanes) {
    const Eigen::Index columns = std::min<Eigen::Index>(most_lanes, f.cols() - first);
    const int width = whole(columns);
    for (Eigen::Index i = 0; i < rows; ++i) {
      double* row = y.get() + i * width;
      for (Eigen::Index j = 0; j < columns; ++j) {
        row[j] = f(permutation[i], first + j);
      }
      std::fill(row + columns, row + width, 0.0);
    }
    forward_solve(l, width, y.get());
    using Rows =
        Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>,
                   Eigen::Unaligned, Eigen::OuterStride<>>;
    const Rows solved(y.get(), rows, columns, Eigen::OuterStride<>(width));
    result.z_interior.middleCols(first, columns) = solved.topRows(_interior);
    result.g.middleCols(first, columns) = solved.bottomRows(trace());
  }
  return result;
}

Eigen::VectorXd SubdomainFactor::recover(const Eigen::VectorXd& z_interior,
                                         const Eigen::VectorXd& trace_values) const {
  if (!_factor) {
    return {};
  }
  const cholmod_factor& factor = *_factor->cholesky;
  Eigen::MatrixXd z(_interior + trace(), 1);
  z << z_interior, _trace_factor.transpose().triangularView<Eigen::Upper>() * trace_values;
  const DensePtr ordered = triangular_solve(CHOLMOD_Lt, factor, z);
  Eigen::VectorXd u(z.rows());
  const Eigen::Map<const Eigen::VectorXi> permutation(static_cast<const int*>(factor.Perm),
                                                      z.rows());
  u(permutation) = view(*ordered).col(0);
  return u;
}

Eigen::VectorXd SubdomainFactor::apply_schur(const Eigen::VectorXd& trace_values) const {
  Eigen::VectorXd result(trace_values.size());
  apply_schur(trace_values, result);
  return result;
}

void SubdomainFactor::apply_schur(const Eigen::Ref<const Eigen::VectorXd>& trace_values,
                                  Eigen::Ref<Eigen::VectorXd> result) const {
  result = trace_values;
  const int size = static_cast<int>(trace());
  if (size == 0) {
    return;
  }
  for (const CBLAS_TRANSPOSE transposed : {CblasTrans, CblasNoTrans}) {
    cblas_dtrmv(CblasColMajor, CblasLower, transposed, CblasNonUnit, size, _trace_factor.data(),
                size, result.data(), 1);
  }
  for (const std::int32_t held : _held) {
    result[held] -= _rho * trace_values[held];
  }
}

Eigen::MatrixXd SubdomainFactor::schur() const {
  if (trace() == 0) {
    return {};  // Eigen 3.4 forms references through the null data of an empty product
  }
  Eigen::MatrixXd result = _trace_factor;
  const int size = static_cast<int>(trace());
  square(result.data(), size, size);
  result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
  for (const std::int32_t trace : _held) {
    result(trace, trace) -= _rho;
  }
  return result;
}

std::size_t SubdomainFactor::bytes() const noexcept {
  if (!_factor) {
    return 0;
  }
  const cholmod_factor& factor = *_factor->cholesky;
  const std::size_t integers = factor.ssize + 3 * (factor.nsuper + 1) + 2 * factor.n;
  return sizeof(double) * (factor.xsize + static_cast<std::size_t>(_trace_factor.size())) +
         sizeof(int) * integers + sizeof(cholmod_factor) + sizeof(std::int32_t) * _held.capacity();
}

}  // namespace anticrack::ddm
