// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/flexibility.hpp"

#include <Eigen/Cholesky>

#include "errors/errors.hpp"

namespace anticrack::ddm {

Flexibility::Flexibility(const Eigen::MatrixXd& schur, std::span<const std::int32_t> rigid)
    : _column(rigid.size()) {
  Eigen::Index size = 0;
  for (std::size_t i = 0; i < rigid.size(); ++i) {
    if (rigid[i] < 0) {
      _column[i] = size++;
    } else if (_inclusion_column.size() <= static_cast<std::size_t>(rigid[i])) {
      _inclusion_column.resize(static_cast<std::size_t>(rigid[i]) + 1, -1);
    }
  }
  for (std::size_t i = 0; i < rigid.size(); ++i) {
    if (rigid[i] >= 0) {
      Eigen::Index& column = _inclusion_column[static_cast<std::size_t>(rigid[i])];
      if (column < 0) {
        column = size++;
      }
      _column[i] = column;
    }
  }
  if (size == 0) {
    return;
  }
  Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index j = 0; j < schur.cols(); ++j) {
    for (Eigen::Index i = 0; i < schur.rows(); ++i) {
      reduced(_column[static_cast<std::size_t>(i)], _column[static_cast<std::size_t>(j)]) +=
          schur(i, j);
    }
  }
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(reduced);
  if (cholesky.info() != Eigen::Success) {
    throw errors::Error(errors::Reason::numerical,
                        "the Schur complement of a subdomain is not positive definite to rounding; "
                        "the mesh has triangles that are degenerate, or is badly scaled");
  }
  _inverse = cholesky.solve(Eigen::MatrixXd::Identity(size, size));
}

void Flexibility::apply(const Eigen::VectorXd& rhs, Eigen::VectorXd& reduced,
                        Eigen::VectorXd& skeleton, Eigen::VectorXd& trace) const {
  reduced.setZero();
  for (Eigen::Index i = 0; i < rhs.size(); ++i) {
    reduced[_column[static_cast<std::size_t>(i)]] += rhs[i];
  }
  skeleton.noalias() = _inverse * reduced;
  for (Eigen::Index i = 0; i < trace.size(); ++i) {
    trace[i] = skeleton[_column[static_cast<std::size_t>(i)]];
  }
}

Eigen::Index Flexibility::inclusion_column(std::int32_t inclusion) const noexcept {
  const auto i = static_cast<std::size_t>(inclusion);
  return i < _inclusion_column.size() ? _inclusion_column[i] : -1;
}

std::size_t Flexibility::bytes() const noexcept {
  return sizeof(double) * static_cast<std::size_t>(_inverse.size()) +
         sizeof(Eigen::Index) * (_column.capacity() + _inclusion_column.capacity());
}

}  // namespace anticrack::ddm
