// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/adjoint.hpp"

#include <map>

#include "base/at.hpp"
#include "contact/answer.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Per contact: whether another contact lies in its node, as where cracks cross. The answer does
/// not say how such contacts share the flux, so their lambda is not known.
std::vector<bool> cross(const ddm::Decomposition& decomposition) {
  std::vector<bool> found(decomposition.skeleton.independent, false);
  std::map<std::int32_t, std::int32_t> at_node;
  for (const ddm::NodePair& pair : decomposition.pairs) {
    if (pair.contact < 0) continue;
    const std::int32_t first = at_node.try_emplace(pair.node, pair.contact).first->second;
    if (first != pair.contact) found[at(first)] = found[at(pair.contact)] = true;
  }
  return found;
}

/// Force on each pair: the pressure of the answer times the lumped mass.
VectorXd forces_of(const TraceProblem& traces, const Answer& answer) {
  VectorXd force = VectorXd::Zero(traces.pair_count());
  const auto& sides = traces.decomposition().interface_sides;
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (std::size_t k = 0; k < sides[i].size(); ++k)
      if (const std::int32_t pair = sides[i][k].pair; pair >= 0)
        force[pair] = traces.lumped_mass()[pair] * answer.traces[i].pressure[k];
  return force;
}

/// The values of the sign of `sign` clipped to `most`.
VectorXd clip(const VectorXd& values, double sign, const VectorXd& most) {
  if (sign > 0) return values.cwiseMin(most);
  return values.cwiseMax(-most);
}

}  // namespace

Adjoint::Adjoint(const TraceProblem& traces, const Answer& answer)
    : _possible(traces.decomposition().skeleton.dependent.empty()) {
  if (!_possible) return;
  const ddm::Decomposition& decomposition = traces.decomposition();
  const ddm::Skeleton& skeleton = decomposition.skeleton;
  const auto contacts = static_cast<Index>(skeleton.independent);
  const VectorXd w = unknowns_of(decomposition, answer), force = forces_of(traces, answer);
  _room.jumps.resize(contacts);
  _room.forces.setZero(contacts);
  for (std::size_t i = 0; i < decomposition.pairs.size(); ++i)
    if (const std::int32_t contact = decomposition.pairs[i].contact; contact >= 0)
      _room.forces[contact] += force[static_cast<Index>(i)];
  const std::vector<bool> crossing = cross(decomposition);
  for (Index i = 0; i < contacts; ++i) {
    const ddm::Contact& contact = skeleton.contacts[at(i)];
    _room.jumps[i] = std::max(0.0, w[contact.plus] - w[contact.minus]);
    _open.push_back(answer.closed[at(i)] == 0);
    if (_open.back() != 0 || crossing[at(i)]) _room.forces[i] = 0;
  }
}

Adjoint::Goal Adjoint::aim(const UnitForce& force, const Opened& opened) const {
  Goal goal{&force, opened.d, -opened.residual, force.compliance + force.r.dot(opened.d)};
  for (Index i = 0; i < goal.reactions.size(); ++i)
    if (_open[at(i)] != 0) goal.reactions[i] = 0;
  return goal;
}

VectorXd Adjoint::jumps(const Goal& goal, double sign, const Room& room) {
  return clip(goal.jumps, sign, room.jumps);
}

VectorXd Adjoint::load(const Goal& goal, double sign, const Room& room) {
  return goal.force->r + clip(goal.reactions, -sign, room.forces);
}

}  // namespace anticrack::contact
