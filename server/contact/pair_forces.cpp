// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/pair_forces.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "mesh/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Not so where it may open, nor where other conditions of a cross point imply its own.
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
    if (pair.contact >= 0) {
      _contact_mass[pair.contact] += _mass[static_cast<Index>(i)];
    }
  }
  for (const auto& [node, pairs] : at_node) {
    Knot knot = knot_of(pairs);
    if (!knot.pairs.empty() && !knot.sides.empty()) {
      _knots.push_back(std::move(knot));
    }
  }
}

PairForces::Knot PairForces::knot_of(const std::vector<std::int32_t>& pairs_of_node) const {
  Knot knot;
  const auto ends = [this](std::int32_t i) {
    const ddm::NodePair& pair = _decomposition.pairs[at(i)];
    return std::array{std::pair{Side{pair.minus, pair.minus_trace}, -1.0},
                      std::pair{Side{pair.plus, pair.plus_trace}, 1.0}};
  };
  for (const std::int32_t i : pairs_of_node) {
    if (!tied(_decomposition, i)) {
      continue;
    }
    knot.pairs.push_back(i);
    for (const auto& [side, sign] : ends(i)) {
      if (_decomposition.subdomains[at(side.subdomain)].rigid[at(side.trace)] < 0) {
        knot.sides.push_back(side);
      }
    }
  }
  std::sort(knot.sides.begin(), knot.sides.end());
  knot.sides.erase(std::unique(knot.sides.begin(), knot.sides.end()), knot.sides.end());
  const auto number = [&knot](const Side& side) {
    const auto found = std::lower_bound(knot.sides.begin(), knot.sides.end(), side);
    return found != knot.sides.end() && *found == side ? found - knot.sides.begin() : Index{-1};
  };

  // mu = B (B'M B)^+ b, b the forces on the sides: with M^1/2 mu of least norm.
  MatrixXd b_root =
      MatrixXd::Zero(static_cast<Index>(knot.sides.size()), static_cast<Index>(knot.pairs.size()));
  VectorXd root(b_root.cols());
  for (Index p = 0; p < b_root.cols(); ++p) {
    root[p] = std::sqrt(_mass[knot.pairs[at(p)]]);
    for (const auto& [side, sign] : ends(knot.pairs[at(p)])) {
      if (const Index k = number(side); k >= 0) {
        b_root(k, p) += sign * root[p];
      }
    }
  }
  if (b_root.size() > 0) {
    knot.multipliers =
        root.cwiseInverse().asDiagonal() * b_root.completeOrthogonalDecomposition().pseudoInverse();
  }
  for (const std::int32_t i : pairs_of_node) {
    if (_decomposition.pairs[at(i)].contact >= 0) {
      for (const auto& [side, sign] : ends(i)) {
        if (const Index k = number(side); k >= 0) {
          knot.contacts.push_back({k, i, sign});
        }
      }
    }
  }
  return knot;
}

VectorXd PairForces::multipliers(const std::vector<VectorXd>& fluxes,
                                 const VectorXd& lambda) const {
  VectorXd mu = VectorXd::Zero(_mass.size());
  for (Index i = 0; i < mu.size(); ++i) {
    const std::int32_t contact = _decomposition.pairs[at(i)].contact;
    if (contact >= 0) {
      mu[i] = lambda[contact] / _contact_mass[contact];
    }
  }
  for (const Knot& knot : _knots) {
    VectorXd force(knot.multipliers.cols());
    for (Index k = 0; k < force.size(); ++k) {
      const Side& side = knot.sides[at(k)];
      force[k] = fluxes[at(side.subdomain)][side.trace];
    }
    for (const Touch& contact : knot.contacts) {
      force[contact.side] -= contact.sign * _mass[contact.pair] * mu[contact.pair];
    }
    const VectorXd found = knot.multipliers * force;
    for (Index p = 0; p < found.size(); ++p) {
      mu[knot.pairs[at(p)]] = found[p];
    }
  }
  return mu;
}

}  // namespace anticrack::contact
