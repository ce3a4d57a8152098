// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/bound_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/at.hpp"

namespace anticrack::operators {
namespace {

/// Most bounds of the cone to try, of which most answers need two, and most weights.
constexpr int most_tries = 4, most_weights = 3;
/// Another weight is tried if the last one took off this part of the distance from the middle.
constexpr double worth = 0.03;
/// The exponent of weights: larger ones clip less and multiply energies more (THEORY.md).
constexpr double beta = 0.6;

/// Per copy, its entry of the skeleton's w; -1 off the interfaces.
std::vector<std::int32_t> unknown_at(const MeshOperator::Parts& parts,
                                     const estimate::CutMesh& cut) {
  std::vector<std::int32_t> unknown(cut.at.size(), -1);
  for (std::size_t s = 0; s < parts.decomposition.subdomains.size(); ++s) {
    const ddm::Subdomain& of = parts.decomposition.subdomains[s];
    std::ranges::copy(
        of.unknown, unknown.begin() + cut.first_copy[s] + static_cast<std::ptrdiff_t>(of.interior));
  }
  return unknown;
}

}  // namespace

contact::Adjoint::Room room_of(const MeshOperator::Parts& parts, const estimate::Primal& primal,
                               const std::vector<char>& closed, const estimate::Weight* weight) {
  const estimate::CutMesh& cut = primal.cut;
  const std::vector<std::int32_t> unknown = unknown_at(parts, cut);
  const std::vector<ddm::Contact>& contacts = parts.decomposition.skeleton.contacts;
  std::map<std::pair<std::int32_t, std::int32_t>, Eigen::Index> condition;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    condition[{contacts[i].plus, contacts[i].minus}] = static_cast<Eigen::Index>(i);
  // In a node the least weight of the faces beside it counts, and what both may carry.
  const auto all = static_cast<Eigen::Index>(contacts.size());
  contact::Adjoint::Room room{Eigen::VectorXd::Constant(all, estimate::Ways::none),
                              Eigen::VectorXd::Zero(all)};
  estimate::WeightOf weights(primal.flux, weight);
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    const estimate::Face& face = cut.faces[f];
    if (!estimate::presses(face.condition)) continue;
    const estimate::Weight::OnFace on = weights.on(f);
    const auto ends = cut.ends(face), others = cut.ends(cut.faces[at(face.other)]);
    for (const std::size_t end : {0, 1}) {
      const auto found = condition.find({unknown[at(others[1 - end])], unknown[at(ends[end])]});
      if (found == condition.end()) continue;
      const Eigen::Index i = found->second;
      room.jumps[i] = std::min(room.jumps[i], on.least * std::max(0.0, primal.flux.jump(f, end)));
      if (closed[at(i)] != 0) room.forces[i] += on.bound[end];
    }
  }
  return room;
}

Search::Search(const MeshOperator::Parts& parts, Target& target, estimate::Side side)
    : _parts(parts), _target(target), _side(side), _room(target.adjoints.room) {
  const double norm = std::sqrt(target.adjoints.of.primal.flux.norm_squared());
  _c = 2 * (norm > 0 ? std::sqrt(target.goal.compliance) / norm : 1);
  _best.value = sign() * std::numeric_limits<double>::infinity();
}

contact::Adjoint::Room Search::room() const { return {_c * _room.jumps, _c * _room.forces}; }

Eigen::VectorXd Search::load() const {
  return _target.adjoints.adjoint.load(_target.goal, sign(), room());
}
Eigen::VectorXd Search::reactions() const { return load() - _target.goal.force->r; }
Eigen::VectorXd Search::jumps() const {
  return _target.adjoints.adjoint.jumps(_target.goal, sign(), room());
}

estimate::Aimed Search::aimed(std::span<const double> z, std::span<const double> reacting) const {
  const Bounded& of = _target.adjoints.of;
  return {&of.primal,
          {z, reacting, _target.aim().value_in(of.answer), _side, _c, _target.unit,
           _weight ? &*_weight : nullptr},
          _unloaded,
          of.of_largest.has_value()};
}

void Search::take(const estimate::Bound& one) {
  ++_tries;
  const bool better = std::isfinite(one.value) && sign() * one.value < sign() * _best.value;
  const double gained = better ? sign() * (_best.value - one.value) : 0;
  if (better) _best = one;
  if (_weight) {
    _done = _tries >= most_tries + most_weights || !(gained > worth * off(one));
    _inner /= 4;
    _c *= std::clamp(one.short_of, 1.0, 2.0);
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
  constexpr double of_width = 0.03;  // what the load that is not balanced in a disc may cost
  const estimate::Primal& primal = _target.adjoints.of.primal;
  if (!_ends) {
    if (!primal.load.oscillation.empty())
      _unloaded = mesh_duals(_parts, primal.cut, _target.goals)[_target.k].norm;
    const double most = _unloaded > 0 ? of_width * off(_best) / _unloaded : 0;
    _ends = estimate::contact_ends(primal.cut, primal.flux, primal.load.oscillation, most);
  }
  _weight = estimate::weight_about(primal.cut, primal.flux, *_ends, _inner, beta);
  _done = _weight->faces.empty() || !std::isfinite(_unloaded);
  if (!_done) _room = room_of(_parts, primal, _target.adjoints.of.answer.closed, &*_weight);
}

}  // namespace anticrack::operators
