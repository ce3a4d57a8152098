// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/maps.hpp"

#include "base/at.hpp"

namespace anticrack::contact {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

Sparse matrix(const ddm::Skeleton& skeleton, ddm::Terms ddm::Row::*of, std::size_t columns,
              double sign) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(skeleton.unknowns);
  for (std::size_t i = 0; i < skeleton.rows.size(); ++i)
    for (const ddm::Term& term : skeleton.rows[i].*of)
      entries.emplace_back(static_cast<int>(i), term.index, sign * term.factor);
  Sparse result(static_cast<Eigen::Index>(skeleton.unknowns), static_cast<Eigen::Index>(columns));
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace

Maps::Maps(const ddm::Skeleton& skeleton)
    : _free(matrix(skeleton, &ddm::Row::free, skeleton.free, 1)),
      _jumps(matrix(skeleton, &ddm::Row::jumps, skeleton.independent, -1)),
      _held(matrix(skeleton, &ddm::Row::held, skeleton.held.size(), 1)) {}

Eigen::VectorXd Maps::expand(const Eigen::VectorXd& q, const Eigen::VectorXd& d,
                             const Eigen::VectorXd& p) const {
  Eigen::VectorXd w = _free * q;
  w -= _jumps * d;
  if (p.size() > 0) w += _held * p;
  return w;
}

Eigen::VectorXd Maps::vector_of(const ddm::Terms& sum) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(unknowns());
  for (const auto& [index, factor] : sum) result[index] += factor;
  return result;
}

std::size_t Maps::bytes() const noexcept {
  std::size_t bytes = 0;
  for (const Sparse* one : {&_free, &_jumps, &_held})
    bytes += at(one->nonZeros()) * (sizeof(double) + sizeof(int)) + at(one->cols()) * sizeof(int);
  return bytes;
}

double sum_of(const ddm::Terms& terms, const Eigen::Ref<const Eigen::VectorXd>& values) {
  double sum = 0;
  for (const ddm::Term& term : terms) sum += term.factor * values[term.index];
  return sum;
}

}  // namespace anticrack::contact
