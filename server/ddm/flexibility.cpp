// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/flexibility.hpp"

#include <cblas.h>

#include <algorithm>

#include "base/at.hpp"
#include "ddm/blas.hpp"
#include "ddm/multifrontal.hpp"
#include "errors/errors.hpp"
#include "stop/stop.hpp"

namespace anticrack::ddm {
namespace {

/// y = a x by BLAS, which uses all instructions of the processor. With one column memory is the
/// bottleneck, so only half of the symmetric matrix is read.
void multiply(const Eigen::MatrixXd& a, const Eigen::Ref<const Eigen::MatrixXd>& x,
              Eigen::Ref<Eigen::MatrixXd> y) {
  const int size = static_cast<int>(a.rows()), columns = static_cast<int>(x.cols());
  if (size == 0 || columns == 0) return;
  if (columns == 1) {
    multiply_symmetric(a, x.data(), y.data());
    return;
  }
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, size, columns, size, 1, a.data(), size,
              x.data(), static_cast<int>(x.outerStride()), 0, y.data(),
              static_cast<int>(y.outerStride()));
}

}  // namespace

Flexibility::Flexibility(const Eigen::MatrixXd& schur, std::span<const std::int32_t> rigid)
    : _column(rigid.size()),
      _nothing_rigid(std::all_of(rigid.begin(), rigid.end(), [](auto j) { return j < 0; })) {
  Eigen::Index size = 0;
  std::int32_t inclusions = 0;
  for (std::size_t i = 0; i < rigid.size(); ++i) {
    inclusions = std::max(inclusions, rigid[i] + 1);
    if (rigid[i] < 0) _column[i] = size++;
  }
  std::vector<Eigen::Index> inclusion_column(at(inclusions), -1);
  for (std::size_t i = 0; i < rigid.size(); ++i) {
    if (rigid[i] >= 0) {
      Eigen::Index& column = inclusion_column[at(rigid[i])];
      if (column < 0) column = size++;
      _column[i] = column;
    }
  }
  if (size == 0) return;
  Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index j = 0; j < schur.cols(); ++j)
    for (Eigen::Index i = 0; i < schur.rows(); ++i)
      reduced(_column[at(i)], _column[at(j)]) += schur(i, j);
  const int n = static_cast<int>(size);
  if (!eliminate_front(n, n, reduced.data(), nullptr, false)) {
    throw errors::Error(errors::Reason::numerical,
                        "the Schur complement of a subdomain is not positive definite to rounding; "
                        "the mesh has triangles that are degenerate, or is badly scaled");
  }
  _inverse.setIdentity(size, size);
  constexpr double most = 5e7;  // operations between two looks
  const int at_once = static_cast<int>(std::clamp(most / (double(n) * n), 8.0, 64.0));
  for (int first = 0; first < n; first += at_once) {
    stop::look("inverting a dense matrix");
    for (const CBLAS_TRANSPOSE transposed : {CblasNoTrans, CblasTrans})
      cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, transposed, CblasNonUnit, n,
                  std::min(at_once, n - first), 1, reduced.data(), n, _inverse.col(first).data(),
                  n);
  }
  // dsymv reads one triangle and dgemm the whole matrix, so it must be symmetric to the bit.
  _inverse.triangularView<Eigen::StrictlyUpper>() = _inverse.transpose();
}

void Flexibility::apply(const Eigen::Ref<const Eigen::MatrixXd>& rhs,
                        Eigen::Ref<Eigen::MatrixXd> reduced, Eigen::Ref<Eigen::MatrixXd> skeleton,
                        Eigen::Ref<Eigen::MatrixXd> trace) const {
  if (_nothing_rigid) {  // T is the identity
    multiply(_inverse, rhs, trace);
    return;
  }
  reduced.setZero();
  for (Eigen::Index j = 0; j < rhs.cols(); ++j) {
    const auto given = rhs.col(j);
    auto sums = reduced.col(j);
    for (Eigen::Index i = 0; i < given.size(); ++i) sums[_column[at(i)]] += given[i];
  }
  multiply(_inverse, reduced, skeleton);
  for (Eigen::Index j = 0; j < trace.cols(); ++j) {
    const auto values = skeleton.col(j);
    auto wanted = trace.col(j);
    for (Eigen::Index i = 0; i < wanted.size(); ++i) wanted[i] = values[_column[at(i)]];
  }
}

std::size_t Flexibility::bytes() const noexcept {
  return sizeof(double) * at(_inverse.size()) + sizeof(Eigen::Index) * _column.capacity();
}

}  // namespace anticrack::ddm
