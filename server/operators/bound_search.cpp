// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/bound_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/at.hpp"

namespace anticrack::operators {
namespace {

/// Most bounds of the cone to try, of which most answers need two, and most weights.
constexpr int most_tries = 4, most_weights = 2;
/// Another weight is tried if the last one took off this part of the distance from the middle.
constexpr double worth = 0.03;
/// The exponent of weights: larger ones clip less and multiply energies more (THEORY.md).
constexpr double beta = 0.6;

}  // namespace

std::vector<std::int32_t> contact_at(const MeshOperator::Parts& parts,
                                     const estimate::CutMesh& cut) {
  std::vector<std::int32_t> contact(cut.at.size(), -1);
  for (const ddm::NodePair& pair : parts.decomposition.pairs) {
    const ddm::Subdomain& minus = parts.decomposition.subdomains[at(pair.minus)];
    contact[at(cut.first_copy[at(pair.minus)]) + minus.interior + at(pair.minus_trace)] =
        pair.contact;
  }
  return contact;
}

contact::Adjoint::Room room_of(const MeshOperator::Parts& parts, const estimate::Primal& primal,
                               contact::Adjoint::Room room, const estimate::Weight& weight) {
  const estimate::CutMesh& cut = primal.cut;
  const std::vector<std::int32_t> contact = contact_at(parts, cut);
  std::vector<char> weighed(at(room.jumps.size()), 0);
  for (const estimate::Weight::OnFace& on : weight.faces)
    for (const std::int32_t copy : cut.ends(cut.faces[on.face]))
      if (contact[at(copy)] >= 0) weighed[at(contact[at(copy)])] = 1;
  // In a node the least weight of the faces beside it counts, and what both may carry.
  Eigen::VectorXd least = Eigen::VectorXd::Constant(room.jumps.size(), weight.largest);
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(room.forces.size());
  estimate::WeightOf weights(primal.flux, &weight);
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    if (!estimate::presses(cut.faces[f].condition)) continue;
    const estimate::Weight::OnFace on = weights.on(f);
    const auto ends = cut.ends(cut.faces[f]);
    for (const std::size_t end : {0, 1}) {
      const std::int32_t own = contact[at(ends[end])];
      if (own < 0) continue;
      least[own] = std::min(least[own], on.least);
      forces[own] += on.bound[end];
    }
  }
  for (Eigen::Index i = 0; i < room.jumps.size(); ++i) {
    if (weighed[at(i)] == 0) continue;
    room.jumps[i] *= least[i];
    if (room.forces[i] > 0) room.forces[i] = forces[i];
  }
  return room;
}

Search::Search(const MeshOperator::Parts& parts, Target& target, estimate::Side side)
    : _parts(parts), _target(target), _side(side), _room(target.adjoints.adjoint.room()) {
  const double norm = std::sqrt(target.adjoints.of.primal.flux.norm_squared());
  _c = 2 * (norm > 0 ? std::sqrt(target.goal.compliance) / norm : 1);
  _best.value = sign() * std::numeric_limits<double>::infinity();
}

contact::Adjoint::Room Search::room() const { return {_c * _room.jumps, _c * _room.forces}; }

Eigen::VectorXd Search::load() const {
  return contact::Adjoint::load(_target.goal, sign(), room());
}
Eigen::VectorXd Search::jumps() const {
  return contact::Adjoint::jumps(_target.goal, sign(), room());
}

estimate::Aimed Search::aimed(std::span<const double> z, std::span<const double> reacting) const {
  const Bounded& of = _target.adjoints.of;
  return {&of.primal,
          {z, reacting, _target.aim().value_in(of.answer), _side, _c, _target.unit,
           _weight ? &*_weight : nullptr},
          _unloaded};
}

void Search::take(const estimate::Bound& one) {
  ++_tries;
  const bool better = std::isfinite(one.value) && sign() * one.value < sign() * _best.value;
  const double gained = better ? sign() * (_best.value - one.value) : 0;
  if (better) _best = one;
  if (_weight) {
    _done = _tries >= most_tries + most_weights || !(gained > worth * off(one));
    _inner /= 4;
  } else {
    const bool found = std::isfinite(one.value);
    if (_tries < most_tries && (!found || (better && one.short_of > 1))) {
      _c *= found ? std::clamp(one.short_of, 1.5, 8.0) : 8;
      return;
    }
    const bool limited = !found || one.c > 0.9 * _c;
    _done = !limited || !_target.adjoints.of.closely || !std::isfinite(_best.value);
    _tries = most_tries;
    _inner = 0.1;
    _c = std::sqrt(_best.half.dual / _best.half.primal);
  }
  if (!_done) weigh();
}

double Search::off(const estimate::Bound& one) const { return sign() * (one.value - one.middle); }

void Search::weigh() {
  Adjoints& adjoints = _target.adjoints;
  const estimate::Primal& primal = adjoints.of.primal;
  if (!adjoints.ends)
    adjoints.ends = estimate::contact_ends(primal.cut, primal.flux, primal.load.oscillation);
  _weight = estimate::weight_about(primal.cut, primal.flux, *adjoints.ends, _inner, beta);
  if (!primal.load.oscillation.empty())
    _unloaded = flux_norms(_parts, primal.cut, _target.goals)[_target.k];
  _done = _weight->faces.empty() || !std::isfinite(_unloaded);
  if (!_done) _room = room_of(_parts, primal, adjoints.adjoint.room(), *_weight);
}

}  // namespace anticrack::operators
