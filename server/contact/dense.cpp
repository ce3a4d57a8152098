// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/dense.hpp"

#include <cblas.h>

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "contact/dense_lcp.hpp"
#include "stop/stop.hpp"

extern "C" void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXd;

template <class Matrix>
int stride(const Matrix& matrix) {
  return static_cast<int>(matrix.outerStride());
}

/// Columns or rows of a part, where each one takes `each` operations: a quarter of all for threads
/// to share, but at least 5e6 operations, and between two looks about 1e8 at most.
int part_of(int all, double each) {
  constexpr double least = 5e6, most = 1e8, fewest = 32, quarter = 0.25;
  const double shared = std::max(least / std::max(each, 1.0), std::ceil(quarter * all));
  return static_cast<int>(std::max(std::min(shared, most / std::max(each, 1.0)), fewest));
}

void look() { stop::look("working on dense matrices"); }

/// Calls part(first, count) for parts of the columns or rows on base::Threads, and looks before
/// each call. The parts do not depend on the number of threads.
template <class Part>
void for_each_part(int all, double each, const Part& part) {
  if (all == 0) return;
  const int most = part_of(all, each);
  const auto one = [&](int first) {
    look();
    part(first, std::min(most, all - first));
  };
  if (all <= most) return one(0);
  base::at_once(at((all + most - 1) / most), base::Threads::allowed(),
                [&] { return [&](std::size_t i) { one(static_cast<int>(i) * most); }; });
}

/// The same in blocks of columns: each block is finished, and the columns right of it are reduced.
bool cholesky_in_blocks(Ref<MatrixXd> matrix) {
  constexpr int block = 256;
  const int size = static_cast<int>(matrix.rows()), leading = stride(matrix);
  for (int first = 0; first < size; first += block) {
    const int width = std::min(block, size - first), next = first + width, rest = size - next;
    double* const corner = &matrix(first, first);
    int info = 0;
    dpotrf_("L", &width, corner, &leading, &info);
    if (info != 0) return false;
    if (rest == 0) return true;
    double* const below = corner + width;
    for_each_part(rest, double(width) * width, [&](int row, int count) {
      cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, count, width, 1,
                  corner, leading, below + row, leading);
    });
    for (int j = 0; j < rest; j += block) {
      const int own = std::min(block, rest - j), under = rest - j - own;
      cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, own, width, -1, below + j, leading, 1,
                  &matrix(next + j, next + j), leading);
      for_each_part(under, 2.0 * own * width, [&](int row, int count) {
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, count, own, width, -1,
                    below + j + own + row, leading, below + j, leading, 1,
                    &matrix(next + j + own + row, next + j), leading);
      });
    }
  }
  return true;
}

/// In blocks of rows: products of BLAS are up to four times as fast as its triangular solves.
void solve_in_blocks(const Ref<const MatrixXd>& factor, CBLAS_TRANSPOSE transposed, int columns,
                     double* b, int leading) {
  constexpr int block = 64;
  const bool forward = transposed == CblasNoTrans;
  const int rows = static_cast<int>(factor.rows()), blocks = (rows + block - 1) / block;
  const auto entry = [&](int i, int j) { return factor.data() + j * factor.outerStride() + i; };
  for (int k = 0; k < blocks; ++k) {
    const int first = block * (forward ? k : blocks - 1 - k), own = std::min(block, rows - first);
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, transposed, CblasNonUnit, own, columns, 1,
                entry(first, first), stride(factor), b + first, leading);
    const int next = forward ? first + own : 0, left = forward ? rows - next : first;
    if (left == 0) continue;
    cblas_dgemm(CblasColMajor, transposed, CblasNoTrans, left, columns, own, -1,
                forward ? entry(next, first) : entry(first, 0), stride(factor), b + first, leading,
                1, b + next, leading);
  }
}

void solve(const Ref<const MatrixXd>& factor, CBLAS_TRANSPOSE transposed, Ref<MatrixXd> b) {
  const int rows = static_cast<int>(b.rows()), columns = static_cast<int>(b.cols());
  if (rows == 0 || columns == 0) return;
  if (columns == 1) {
    cblas_dtrsv(CblasColMajor, CblasLower, transposed, CblasNonUnit, rows, factor.data(),
                stride(factor), b.data(), 1);
    return;
  }
  for_each_part(columns, double(rows) * rows, [&](int first, int count) {
    solve_in_blocks(factor, transposed, count, &b(0, first), stride(b));
  });
}

}  // namespace

void multiply(const Ref<const MatrixXd>& a, const Ref<const VectorXd>& x, Ref<VectorXd> y) {
  if (a.size() > 0)
    y.noalias() = a * x;
  else
    y.setZero();
}

void multiply_transposed(const Ref<const MatrixXd>& a, const Ref<const VectorXd>& x,
                         Ref<VectorXd> y) {
  if (a.size() > 0)
    y.noalias() = a.transpose() * x;
  else
    y.setZero();
}

bool cholesky(Ref<MatrixXd> matrix) {
  const int size = static_cast<int>(matrix.rows()), leading = stride(matrix);
  if (size == 0) return true;
  constexpr int large = 768;  // some milliseconds
  if (size >= large) return cholesky_in_blocks(matrix);
  int info = 0;
  dpotrf_("L", &size, matrix.data(), &leading, &info);
  return info == 0;
}

void solve_lower(const Ref<const MatrixXd>& factor, Ref<MatrixXd> b) {
  solve(factor, CblasNoTrans, b);
}

void solve_lower_transposed(const Ref<const MatrixXd>& factor, Ref<MatrixXd> b) {
  solve(factor, CblasTrans, b);
}

void subtract_square(const MatrixXd& x, Ref<MatrixXd> s) {
  const int rows = static_cast<int>(x.rows()), columns = static_cast<int>(x.cols());
  if (rows == 0) return;
  for_each_part(columns, 2.0 * rows * columns, [&](int first, int own) {
    const int below = columns - first - own;
    cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, own, rows, -1, &x(0, first), stride(x), 1,
                &s(first, first), stride(s));
    if (below == 0) return;
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, below, own, rows, -1, &x(0, first + own),
                stride(x), &x(0, first), stride(x), 1, &s(first + own, first), stride(s));
  });
}

void OpenFactor::reserve(Index contacts) {
  _closed.reserve(at(contacts));
  _nodes.reserve(at(contacts));
  _values.resize(contacts * contacts);
}

bool OpenFactor::factorise(const MatrixXd& matrix, const std::vector<ddm::Terms>& rows,
                           const std::vector<char>& closed) {
  if (_closed == closed) return _regular;
  _closed = closed;
  _nodes.clear();
  for (Index i = 0; i < matrix.rows(); ++i)
    if (closed[at(i)] == 0) _nodes.push_back(i);
  const auto n = static_cast<Index>(_nodes.size());
  if (_values.size() < n * n) _values.resize(n * n);
  Eigen::Map<MatrixXd> factor(_values.data(), n, n);
  for (Index j = 0; j < n; ++j) {  // the upper triangle is never read
    const double* from = matrix.col(_nodes[at(j)]).data();
    double* to = factor.col(j).data();
    for (Index i = j; i < n; ++i) to[i] = from[_nodes[at(i)]];
  }
  _regular = cholesky(factor) &&
             (n == 0 || regular_pivot(factor.diagonal().array().square().minCoeff(), n));
  _to_rows.resize(0, 0);
  if (_regular && !rows.empty()) hold(rows, matrix.rows());
  return _regular;
}

void OpenFactor::hold(const std::vector<ddm::Terms>& rows, Index contacts) {
  const auto n = static_cast<Index>(_nodes.size());
  std::vector<const ddm::Terms*> holding;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const bool any = std::ranges::any_of(
        rows[k], [this](const ddm::Term& term) { return _closed[at(term.index)] == 0; });
    if (any && _closed[at(contacts) + k] != 0) holding.push_back(&rows[k]);
  }
  _to_rows.setZero(n, static_cast<Index>(holding.size()));
  for (std::size_t k = 0; k < holding.size(); ++k) {
    for (const ddm::Term& term : *holding[k]) {
      const auto node = std::lower_bound(_nodes.begin(), _nodes.end(), Index{term.index});
      if (node != _nodes.end() && *node == term.index)
        _to_rows(node - _nodes.begin(), static_cast<Index>(k)) = term.factor;
    }
  }
  solve_lower(Eigen::Map<const MatrixXd>(_values.data(), n, n), _to_rows);
  _of_rows = _to_rows.transpose() * _to_rows;
  _regular = cholesky(_of_rows);
}

VectorXd OpenFactor::solve(const VectorXd& b) const {
  VectorXd x(b.size());
  solve(b, x);
  return x;
}

VectorXd OpenFactor::squares(Ref<MatrixXd> b) const {
  const auto n = static_cast<Index>(_nodes.size());
  solve_lower(Eigen::Map<const MatrixXd>(_values.data(), n, n), b);
  return b.colwise().squaredNorm();
}

void OpenFactor::solve(const VectorXd& b, Ref<VectorXd> x) const {
  const auto n = static_cast<Index>(_nodes.size());
  for (Index i = 0; i < n; ++i) x[i] = b[_nodes[at(i)]];
  const Eigen::Map<const MatrixXd> factor(_values.data(), n, n);
  solve_lower(factor, x.head(n));
  if (_to_rows.cols() > 0) {
    VectorXd nu = -(_to_rows.transpose() * x.head(n));
    solve_lower(_of_rows, nu);
    solve_lower_transposed(_of_rows, nu);
    x.head(n) += _to_rows * nu;
  }
  solve_lower_transposed(factor, x.head(n));
  x.tail(x.size() - n).setZero();
  for (Index i = n; i-- > 0;) {  // nodes are increasing, so nothing is overwritten before it moves
    const double value = x[i];
    x[i] = 0;
    x[_nodes[at(i)]] = value;
  }
}

}  // namespace anticrack::contact
