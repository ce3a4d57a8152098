// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/adjoint.hpp"

#include <cmath>

#include "base/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The values of the sign of `sign` clipped to `most`.
VectorXd clip(const VectorXd& values, double sign, const VectorXd& most) {
  if (sign > 0) return values.cwiseMin(most);
  return values.cwiseMax(-most);
}

}  // namespace

Adjoint::Goal Adjoint::aim(const UnitForce& force, const Opened& opened) const {
  return {&force, opened.d, _conditions.multipliers(-opened.residual, _closed),
          force.compliance + force.r.dot(opened.d)};
}

VectorXd Adjoint::jumps(const Goal& goal, double sign, const Room& room) const {
  constexpr double rounding = 1e-14;
  VectorXd d = clip(goal.jumps, sign, room.jumps.head(goal.jumps.size()));
  for (std::size_t k = 0; k < _conditions.rows().size(); ++k) {
    double sum = 0, size = 0;
    for (const auto& [i, factor] : _conditions.rows()[k]) {
      sum += sign * factor * d[i];
      size += std::abs(factor * d[i]);
    }
    const double most = room.jumps[_conditions.row(k)];
    if (!(sum > most + rounding * size)) continue;
    for (const ddm::Term& term : _conditions.rows()[k]) d[term.index] *= most / sum;
  }
  return d;
}

VectorXd Adjoint::reactions(const Goal& goal, double sign, const Room& room) const {
  return clip(goal.reactions, -sign, room.forces);
}

VectorXd Adjoint::load(const Goal& goal, double sign, const Room& room) const {
  return goal.force->r + on_contacts(reactions(goal, sign, room));
}

/// Forces on the contacts, of reactions of all conditions.
VectorXd Adjoint::on_contacts(const VectorXd& reactions) const {
  VectorXd forces = reactions.head(_conditions.contacts());
  for (std::size_t k = 0; k < _conditions.rows().size(); ++k)
    for (const auto& [i, factor] : _conditions.rows()[k])
      forces[i] += reactions[_conditions.row(k)] * factor;
  return forces;
}

Adjoint::Clippings Adjoint::clippings(const Goal& goal, double sign, const Room& room,
                                      std::span<const double> c) const {
  const Index contacts = _conditions.contacts(), count = static_cast<Index>(c.size());
  Clippings of{{contacts, count}, {contacts, count}};
  for (Index k = 0; k < count; ++k) {
    const Room own{c[at(k)] * room.jumps, c[at(k)] * room.forces};
    of.jumps.col(k) = goal.jumps - jumps(goal, sign, own);
    of.load.col(k) = on_contacts(goal.reactions - reactions(goal, sign, own));
  }
  return of;
}

}  // namespace anticrack::contact
