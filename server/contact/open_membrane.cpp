// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/open_membrane.hpp"

#include "ddm/elimination_order.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

/// Added to the diagonal, of it: the factor exists where parts float that only contact holds. The
/// second solve takes it away, but for forces that would carry such a part off.
constexpr double shift = 1e-12;
/// What the second solve may change, of the first: 1e-6 on a million nodes that are held.
constexpr double most_change = 1e-3;

Sparse open_matrix(const JoinedMembrane& membrane) {
  const Index all = membrane.size() + membrane.contacts();
  Sparse matrix = membrane.matrix().topLeftCorner(all, all);
  for (Index i = 0; i < all; ++i) matrix.coeffRef(i, i) *= 1 + shift;
  return matrix;
}

ddm::SubdomainFactor factor(const Sparse& matrix, const std::vector<double>& places) {
  const Index all = matrix.rows();
  return {matrix, all, ddm::elimination_order(matrix, all, places)};
}

}  // namespace

OpenMembrane::OpenMembrane(const JoinedMembrane& membrane)
    : _membrane(membrane), _factor(factor(open_matrix(membrane), membrane.places())) {}

std::vector<std::vector<double>> OpenMembrane::fields(
    std::span<const ddm::Terms* const> sums) const {
  MatrixXd left(_factor.interior(), static_cast<Index>(sums.size()));
  for (Index k = 0; k < left.cols(); ++k)
    left.col(k) = _membrane.gather(*sums[static_cast<std::size_t>(k)]).head(left.rows());
  MatrixXd y(left.rows(), left.cols()), change = y;
  _factor.solve(left, y);
  const auto x_of = [&](Index k) { return y.col(k).head(_membrane.size()); };
  const auto d_of = [&](Index k) { return y.col(k).tail(_membrane.contacts()); };
  for (Index k = 0; k < left.cols(); ++k)
    left.col(k) -= _membrane.forces_of(x_of(k), d_of(k)).head(left.rows());
  _factor.solve(left, change);
  const auto largest = [](const auto& of) { return of.cwiseAbs().maxCoeff(); };
  std::vector<std::vector<double>> fields(sums.size());
  for (Index k = 0; k < left.cols(); ++k) {
    if (!(largest(change.col(k)) <= most_change * largest(y.col(k)))) continue;
    y.col(k) += change.col(k);
    const VectorXd x = x_of(k);
    fields[static_cast<std::size_t>(k)] = _membrane.field(x, _membrane.values(x, d_of(k)));
  }
  return fields;
}

}  // namespace anticrack::contact
