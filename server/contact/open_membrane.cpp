// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/open_membrane.hpp"

#include "base/at.hpp"
#include "base/at_once.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Largest relative change of u by the second solve; beyond it, rounding errors dominate.
constexpr double most_change = 1e-6;

}  // namespace

OpenMembrane::OpenMembrane(const JoinedMembrane& membrane)
    : _membrane(membrane),
      _factor(membrane.open(), membrane.size() + membrane.contacts(), membrane.order(),
              base::Threads::allowed()) {}

std::vector<std::vector<double>> OpenMembrane::fields(std::span<const ddm::Terms* const> sums,
                                                      bool refined,
                                                      std::span<const VectorXd> on_contacts) const {
  MatrixXd left(_factor.interior(), static_cast<Index>(sums.size()));
  for (Index k = 0; k < left.cols(); ++k)
    left.col(k) =
        _membrane.spread(_membrane.traces().maps().vector_of(*sums[at(k)])).head(left.rows());
  for (std::size_t k = 0; k < on_contacts.size(); ++k)
    left.col(static_cast<Index>(k)).tail(_membrane.contacts()) += on_contacts[k];
  MatrixXd y(left.rows(), left.cols());
  _factor.solve(left, y);
  const auto x_of = [&](Index k) { return y.col(k).head(_membrane.size()); };
  const auto d_of = [&](Index k) { return y.col(k).tail(_membrane.contacts()); };
  std::vector<std::vector<double>> fields(sums.size());
  if (!refined) {
    for (Index k = 0; k < y.cols(); ++k) fields[at(k)] = _membrane.field(x_of(k), d_of(k));
    return fields;
  }
  for (Index k = 0; k < left.cols(); ++k)
    left.col(k) -= _membrane.forces_of(x_of(k), d_of(k)).head(left.rows());
  MatrixXd change(left.rows(), left.cols());
  _factor.solve(left, change);
  for (Index k = 0; k < left.cols(); ++k) {
    const double size = y.col(k).lpNorm<Eigen::Infinity>();
    if (!(change.col(k).lpNorm<Eigen::Infinity>() <= most_change * size)) continue;
    y.col(k) += change.col(k);
    fields[at(k)] = _membrane.field(x_of(k), d_of(k));
  }
  return fields;
}

}  // namespace anticrack::contact
