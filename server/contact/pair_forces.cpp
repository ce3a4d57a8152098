// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/pair_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/at.hpp"
#include "contact/least_norm.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Whether both sides of pair i share an unknown. They do not if the pair may open, or if its
/// condition follows from others of its cross point.
bool tied(const ddm::Decomposition& decomposition, std::int32_t i) {
  const ddm::NodePair& pair = decomposition.pairs[at(i)];
  return decomposition.subdomains[at(pair.minus)].unknown[at(pair.minus_trace)] ==
         decomposition.subdomains[at(pair.plus)].unknown[at(pair.plus_trace)];
}

}  // namespace

PairForces::PairForces(const ddm::Decomposition& decomposition, const VectorXd& lumped_mass)
    : _decomposition(decomposition),
      _mass(lumped_mass),
      _contact_mass(VectorXd::Zero(static_cast<Index>(decomposition.skeleton.contacts.size()))) {
  std::map<std::int32_t, std::vector<std::int32_t>> at_node;
  for (std::size_t i = 0; i < decomposition.pairs.size(); ++i) {
    const ddm::NodePair& pair = decomposition.pairs[i];
    at_node[pair.node].push_back(static_cast<std::int32_t>(i));
    if (pair.contact >= 0) _contact_mass[pair.contact] += _mass[static_cast<Index>(i)];
  }
  for (const auto& [node, pairs] : at_node) {
    for (const std::int32_t i : pairs) {
      if (_decomposition.pairs[at(i)].contact < 0 && !tied(_decomposition, i)) {
        if (std::vector<std::int32_t> path = path_of(pairs, i); !path.empty())
          _implied.push_back({i, std::move(path)});
      }
    }
    Knot knot = knot_of(pairs);
    if (!knot.pairs.empty() && !knot.sides.empty()) _knots.push_back(std::move(knot));
  }
}

/// The first path found from the unknown of the plus side down to that of the minus side, over the
/// contacts of the node; empty if there is none.
std::vector<std::int32_t> PairForces::path_of(const std::vector<std::int32_t>& pairs_of_node,
                                              std::int32_t pair) const {
  const auto unknown = [this](std::int32_t subdomain, std::int32_t trace) {
    return _decomposition.subdomains[at(subdomain)].unknown[at(trace)];
  };
  const ddm::NodePair& of = _decomposition.pairs[at(pair)];
  const std::int32_t end = unknown(of.minus, of.minus_trace);
  std::vector<std::vector<std::int32_t>> ways{{}};
  std::vector<std::int32_t> reached{unknown(of.plus, of.plus_trace)};
  for (std::size_t k = 0; k < reached.size(); ++k) {
    if (reached[k] == end) return ways[k];
    for (const std::int32_t i : pairs_of_node) {
      const std::int32_t contact = _decomposition.pairs[at(i)].contact;
      if (contact < 0 || _decomposition.skeleton.contacts[at(contact)].plus != reached[k]) continue;
      const std::int32_t below = _decomposition.skeleton.contacts[at(contact)].minus;
      if (std::find(reached.begin(), reached.end(), below) == reached.end()) {
        reached.push_back(below);
        ways.push_back(ways[k]);
        ways.back().push_back(contact);
      }
    }
  }
  return {};
}

/// Sets mu of the implied pairs and returns the part of lambda that is left for the contacts. If
/// several implied pairs share contacts, they take their parts in turn until these settle.
VectorXd PairForces::share(const VectorXd& lambda, VectorXd& mu) const {
  constexpr int rounds = 64;
  VectorXd left = lambda;
  for (int round = 0; round < (_implied.size() == 1 ? 1 : rounds); ++round) {
    bool changed = false;
    for (const Implied& one : _implied) {
      const double mass = _mass[one.pair], before = mass * mu[one.pair];
      double wanted = 0, weight = 1 / mass, most = std::numeric_limits<double>::infinity();
      for (const std::int32_t c : one.path) {
        const double whole = left[c] + before;
        wanted += whole / _contact_mass[c];
        weight += 1 / _contact_mass[c];
        most = std::min(most, whole);
      }
      const double taken = std::clamp(wanted / weight, 0.0, std::max(most, 0.0));
      for (const std::int32_t c : one.path) left[c] += before - taken;
      mu[one.pair] = taken / mass;
      changed = changed || taken != before;
    }
    if (!changed) break;
  }
  return left;
}

PairForces::Knot PairForces::knot_of(const std::vector<std::int32_t>& pairs_of_node) const {
  Knot knot;
  const auto ends = [this](std::int32_t i) {
    const ddm::NodePair& pair = _decomposition.pairs[at(i)];
    return std::array{std::pair{Side{pair.minus, pair.minus_trace}, -1.0},
                      std::pair{Side{pair.plus, pair.plus_trace}, 1.0}};
  };
  for (const std::int32_t i : pairs_of_node) {
    if (!tied(_decomposition, i)) continue;
    knot.pairs.push_back(i);
    for (const auto& [side, sign] : ends(i))
      if (_decomposition.subdomains[at(side.subdomain)].rigid[at(side.trace)] < 0)
        knot.sides.push_back(side);
  }
  std::sort(knot.sides.begin(), knot.sides.end());
  knot.sides.erase(std::unique(knot.sides.begin(), knot.sides.end()), knot.sides.end());
  const auto number = [&knot](const Side& side) {
    const auto found = std::lower_bound(knot.sides.begin(), knot.sides.end(), side);
    return found != knot.sides.end() && *found == side ? found - knot.sides.begin() : Index{-1};
  };

  // mu = B (B'M B)^+ b with b the forces on the sides: the mu with the least norm of M^1/2 mu.
  MatrixXd b_root =
      MatrixXd::Zero(static_cast<Index>(knot.sides.size()), static_cast<Index>(knot.pairs.size()));
  VectorXd root(b_root.cols());
  for (Index p = 0; p < b_root.cols(); ++p) {
    root[p] = std::sqrt(_mass[knot.pairs[at(p)]]);
    for (const auto& [side, sign] : ends(knot.pairs[at(p)]))
      if (const Index k = number(side); k >= 0) b_root(k, p) += sign * root[p];
  }
  knot.multipliers = root.cwiseInverse().asDiagonal() *
                     least_norm_solution(b_root, MatrixXd::Identity(b_root.rows(), b_root.rows()));
  for (const std::int32_t i : pairs_of_node) {
    if (!tied(_decomposition, i)) {
      for (const auto& [side, sign] : ends(i))
        if (const Index k = number(side); k >= 0) knot.contacts.push_back({k, i, sign});
    }
  }
  return knot;
}

void PairForces::complete_contact(const VectorXd& lambda, std::vector<char>& pressed) const {
  constexpr double least_pressure = 1e-12;
  double largest = 0;
  for (Index c = 0; c < lambda.size(); ++c)
    largest = pressed[at(c)] != 0 ? std::max(largest, lambda[c] / _contact_mass[c]) : largest;
  for (Index c = 0; c < lambda.size() && largest > 0; ++c)
    if (lambda[c] / _contact_mass[c] > least_pressure * largest) pressed[at(c)] = 1;
}

VectorXd PairForces::multipliers(const std::vector<VectorXd>& fluxes,
                                 const VectorXd& lambda) const {
  VectorXd mu = VectorXd::Zero(_mass.size());
  const VectorXd shared = share(lambda, mu);
  for (Index i = 0; i < mu.size(); ++i) {
    const std::int32_t contact = _decomposition.pairs[at(i)].contact;
    if (contact >= 0) mu[i] = shared[contact] / _contact_mass[contact];
  }
  for (const Knot& knot : _knots) {
    VectorXd force(knot.multipliers.cols());
    for (Index k = 0; k < force.size(); ++k) {
      const Side& side = knot.sides[at(k)];
      force[k] = fluxes[at(side.subdomain)][side.trace];
    }
    for (const Touch& contact : knot.contacts)
      force[contact.side] -= contact.sign * _mass[contact.pair] * mu[contact.pair];
    const VectorXd found = knot.multipliers * force;
    for (Index p = 0; p < found.size(); ++p) mu[knot.pairs[at(p)]] = found[p];
  }
  return mu;
}

bool pressed_through(const std::vector<std::int32_t>& path, const std::vector<char>& pressed) {
  return std::all_of(path.begin(), path.end(),
                     [&](std::int32_t contact) { return pressed[at(contact)] != 0; });
}

}  // namespace anticrack::contact
