// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/bound_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/at.hpp"
#include "operators/face_pressures.hpp"

namespace anticrack::operators {
namespace {

constexpr int most_weights = 3;
/// Another weight is tried if the last one took off this part of the distance from the middle.
constexpr double worth = 0.03;
/// F over E and the square of the first cone where nothing is clipped, 0.25 to 1.2 on most meshes.
constexpr double likely_dual = 0.75;
/// The exponent of weights: larger ones clip less and multiply energies more (THEORY.md).
constexpr double beta = 0.6;

}  // namespace

contact::Adjoint::Room room_of(const MeshOperator::Parts& parts, const estimate::Primal& primal,
                               const std::vector<char>& closed, const estimate::Weight* weight,
                               double stiff) {
  const estimate::CutMesh& cut = primal.cut;
  const std::vector<std::int32_t> contact = contact_at_ends(parts, cut);
  // In a node the least weight of the faces beside it counts, and what both may carry.
  const auto all = static_cast<Eigen::Index>(parts.decomposition.skeleton.contacts.size());
  contact::Adjoint::Room room{Eigen::VectorXd::Constant(all, estimate::Ways::none),
                              Eigen::VectorXd::Zero(all)};
  estimate::WeightOf weights(primal.flux, weight);
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    if (!estimate::presses(cut.faces[f].condition)) continue;
    const estimate::Weight::OnFace on = weights.on(f);
    const bool in_stiff = primal.stiff != nullptr && primal.stiff->has_face(cut, cut.faces[f]);
    const double factor = in_stiff ? stiff : 1;
    for (const std::size_t end : {0, 1}) {
      const Eigen::Index i = contact[2 * f + end];
      if (i < 0) continue;
      room.jumps[i] =
          std::min(room.jumps[i], factor * on.least * std::max(0.0, primal.flux.jump(f, end)));
      if (closed[at(i)] != 0) room.forces[i] += factor * on.bound[end];
    }
  }
  return room;
}

Search::Search(const MeshOperator::Parts& parts, Target& target, estimate::Side side)
    : _parts(parts), _target(target), _side(side), _room(target.adjoints.room) {
  _best.value = sign() * std::numeric_limits<double>::infinity();
  choose_cone();
}

/// Chooses the first cone by what some cones clip, where S^ is formed.
void Search::choose_cone() {
  const Bounded& of = _target.adjoints.of;
  const contact::Adjoint::Goal& goal = _target.goal;
  const double first = estimate::first_cone(goal.compliance, of.primal.flux.norm_squared());
  const std::vector<double> cones = estimate::cones_about(first);
  const auto [jumps, load] = _target.adjoints.adjoint.clippings(goal, sign(), _room, cones);
  _cone.c = first;
  if (jumps.isZero(0) && load.isZero(0)) return;
  const Eigen::VectorXd apart = _parts.contact->apart(jumps, load);
  for (std::size_t k = 0; k < at(apart.size()); ++k)
    _known.push_back({cones[k], apart[static_cast<Eigen::Index>(k)]});
  if (_known.empty()) return;
  const double primal = std::pow(of.bracket.distance / 2, 2) + of.bracket.work;
  const estimate::Promise best =
      estimate::choose_cone(_known, primal, likely_dual * primal * first * first);
  if (std::isfinite(best.half_width)) _cone = best.cone;
}

contact::Adjoint::Room Search::room() const {
  return {_cone.c * _room.jumps, _cone.c * _room.forces};
}

Eigen::VectorXd Search::load() const {
  return _target.adjoints.adjoint.load(_target.goal, sign(), room());
}
Eigen::VectorXd Search::reactions() const { return load() - _target.goal.force->r; }
Eigen::VectorXd Search::jumps() const {
  return _target.adjoints.adjoint.jumps(_target.goal, sign(), room());
}

bool Search::clips() const {
  const contact::Adjoint::Goal& goal = _target.goal;
  return jumps() != goal.jumps ||
         _target.adjoints.adjoint.reactions(goal, sign(), room()) != goal.reactions;
}

estimate::Aimed Search::aimed(std::span<const double> z, std::span<const double> reacting) const {
  const Bounded& of = _target.adjoints.of;
  return {&of.primal,
          {z, reacting, _target.aim().value_in(of.answer), _side, _cone.c, _target.unit,
           _weight ? &*_weight : nullptr, _stiff},
          _unloaded,
          of.of_largest.has_value()};
}

void Search::take(const estimate::Bound& one) {
  ++_tries;
  const bool better = std::isfinite(one.value) && sign() * one.value < sign() * _best.value;
  const double gained = better ? sign() * (_best.value - one.value) : 0;
  if (better) _best = one;
  if (_weight) {
    _done = _tries >= estimate::most_cones + most_weights || !(gained > worth * off(one));
    _inner /= 4;
    _cone.c *= std::clamp(one.short_of, 1.0, 2.0);
  } else {
    const bool found = std::isfinite(one.value);
    const bool may_go_on = _tries < estimate::most_cones && (better || !found);
    if (may_go_on && (one.wanted ? take_wanted(one) : take_next(one))) return;
    const bool limited = !found || one.used > 0.9;
    _done = !limited || !_target.adjoints.of.closely || !std::isfinite(_best.value);
    _tries = estimate::most_cones;
    _inner = 0.1;
    _cone.c = std::sqrt(_best.half.dual / _best.half.primal);
    _stiff = 1;
  }
  if (!_done) weigh();
}

bool Search::take_next(const estimate::Bound& one) {
  // If nothing is clipped, a wider cone has the same z and z'.
  if (std::isfinite(one.value) && !clips()) return false;
  const std::optional<estimate::Clipped> next = estimate::next_cone(_known, _cone, one);
  if (next) _cone = *next;
  return next.has_value();
}

bool Search::take_wanted(const estimate::Bound& one) {
  constexpr double far = 1.5;
  const auto [c, stiff] = *one.wanted;
  const auto differ = [](double a, double b) { return a > far * b || b > far * a; };
  const bool another = one.used > 0.5 && std::isfinite(c) &&
                       (differ(c, _cone.c) || differ(c * stiff, _cone.c * _stiff));
  if (!another) return false;
  _cone = {c};
  _stiff = stiff;
  const Adjoints& of = _target.adjoints;
  _room = room_of(_parts, of.of.primal, of.of.answer.closed, nullptr, _stiff);
  return true;
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
