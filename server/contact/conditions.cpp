// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/conditions.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/at.hpp"

namespace anticrack::contact {

using Eigen::Index;
using Eigen::VectorXd;

Conditions::Conditions(Index contacts, std::vector<ddm::Terms> rows, VectorXd weights)
    : _contacts(contacts), _rows(std::move(rows)), _weights(std::move(weights)) {
  if (_weights.size() == 0) _weights.setOnes(row(_rows.size()));
}

bool Conditions::any_open(std::size_t k, const std::vector<char>& closed) const {
  return std::ranges::any_of(
      _rows[k], [&closed](const ddm::Term& term) { return closed[at(term.index)] == 0; });
}

void Conditions::close_rows_without_open_contacts(std::vector<char>& closed) const {
  for (std::size_t k = 0; k < _rows.size(); ++k)
    if (!any_open(k, closed)) closed[at(row(k))] = 1;
}

void Conditions::add_rows(VectorXd& jumps) const {
  for (std::size_t k = 0; k < _rows.size(); ++k) {
    jumps[row(k)] = 0;
    for (const ddm::Term& term : _rows[k]) jumps[row(k)] += term.factor * jumps[term.index];
  }
}

void Conditions::split(const std::vector<char>& closed, VectorXd& lambda) const {
  for (std::size_t k = 0; k < _rows.size(); ++k) {
    const bool open = any_open(k, closed);
    double nu = 0;
    if (open && closed[at(row(k))] != 0)
      nu = balancing(k, closed, lambda);
    else if (!open)
      nu = least(k, lambda);
    lambda[row(k)] = nu;
    for (const ddm::Term& term : _rows[k]) lambda[term.index] -= nu * term.factor;
  }
}

double Conditions::balancing(std::size_t k, const std::vector<char>& closed,
                             const VectorXd& lambda) const {
  double sum = 0, size = 0;
  for (const ddm::Term& term : _rows[k]) {
    if (closed[at(term.index)] != 0) continue;
    sum += term.factor * lambda[term.index];
    size += term.factor * term.factor;
  }
  return sum / size;
}

/// The multiplier of row k with the least weighted sum of squares among those that leave no lambda
/// below 0, if there is one.
double Conditions::least(std::size_t k, const VectorXd& lambda) const {
  double sum = 0, size = _weights[row(k)], low = 0, high = std::numeric_limits<double>::infinity();
  for (const auto& [i, factor] : _rows[k]) {
    sum += _weights[i] * factor * lambda[i];
    size += _weights[i] * factor * factor;
    (factor > 0 ? high : low) =
        factor > 0 ? std::min(high, lambda[i] / factor) : std::max(low, lambda[i] / factor);
  }
  return std::clamp(sum / size, low, std::max(low, high));
}

VectorXd Conditions::jumps(const VectorXd& d, const std::vector<char>& closed) const {
  VectorXd result(size());
  result.head(_contacts) = d;
  add_rows(result);
  for (Index k = _contacts; k < size(); ++k)
    result[k] = closed[at(k)] != 0 ? 0 : std::max(result[k], 0.0);
  return result;
}

VectorXd Conditions::multipliers(const VectorXd& force, const std::vector<char>& closed) const {
  VectorXd lambda(size());
  lambda.head(_contacts) = force;
  split(closed, lambda);
  for (Index i = 0; i < size(); ++i) lambda[i] = closed[at(i)] != 0 ? lambda[i] : 0;
  return lambda;
}

}  // namespace anticrack::contact
