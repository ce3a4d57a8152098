// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/adjoint.hpp"

#include <map>

#include "mesh/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// w of an answer, from its traces.
VectorXd unknowns_of(const ddm::Decomposition& decomposition, const Answer& answer) {
  VectorXd w = VectorXd::Zero(static_cast<Index>(decomposition.skeleton.unknowns));
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const std::vector<std::int32_t>& unknown = decomposition.subdomains[s].unknown;
    for (std::size_t i = 0; i < answer.side_traces[s].size(); ++i)
      w[unknown[i]] = answer.side_traces[s][i];
  }
  return w;
}

bool factorise(const Eigen::MatrixXd& matrix, Eigen::LLT<Eigen::MatrixXd>& factor) {
  factor.compute(matrix);
  if (matrix.size() == 0) return true;
  if (factor.info() != Eigen::Success) return false;
  const double smallest = factor.matrixLLT().diagonal().minCoeff();
  return regular_pivot(smallest * smallest, matrix.rows());
}

/// Where cracks cross, how the flux shares lambda among them is no part of the answer: a contact
/// beside another one in its node.
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

VectorXd clip(const VectorXd& values, const VectorXd& most) {
  return values.cwiseMin(most).cwiseMax(-most);
}

}  // namespace

Adjoint::Adjoint(const SkeletonProblem& problem, const CaseLoads& loads, const Answer& answer)
    : _problem(problem) {
  const ddm::Decomposition& decomposition = problem.traces().decomposition();
  const ddm::Skeleton& skeleton = decomposition.skeleton;
  const auto contacts = static_cast<Index>(skeleton.independent);
  if (!skeleton.dependent.empty() || contacts > most_contacts) return;
  const VectorXd w = unknowns_of(decomposition, answer);
  std::vector<VectorXd> g;
  g.reserve(loads.subdomains.size());
  for (const ddm::CondensedLoad& load : loads.subdomains) g.push_back(load.g);
  _lambda = problem.multipliers(problem.gather(g) - problem.apply(w)).cwiseMax(0.0);
  _jumps.resize(contacts);
  const std::vector<bool> crossing = cross(decomposition);
  for (Index i = 0; i < contacts; ++i) {
    const ddm::Contact& contact = skeleton.contacts[at(i)];
    _jumps[i] = std::max(0.0, w[contact.plus] - w[contact.minus]);
    const bool open = answer.closed[at(i)] == 0;
    if (open) _open.push_back(i);
    if (open || crossing[at(i)]) _lambda[i] = 0;
  }
  const Eigen::MatrixXd& matrix = problem.lcp().scaled_matrix();
  _possible = factorise(matrix, _of_all) && factorise(matrix(_open, _open), _of_open);
}

Adjoint::Goal Adjoint::aim(const ddm::Terms& terms) const {
  Goal goal;
  const Maps& maps = _problem.traces().maps();
  VectorXd unit = VectorXd::Zero(maps.unknowns());
  for (const auto& [index, factor] : terms) unit[index] += factor;
  goal.load = _problem.reduce(unit, VectorXd::Zero(maps.held_count()));
  const VectorXd scale = _problem.lcp().scale().head(_jumps.size());
  goal.jumps = VectorXd::Zero(_jumps.size());
  if (!_open.empty()) {
    const VectorXd scaled = scale.cwiseProduct(goal.load.r);
    const VectorXd of_open = scaled(_open);
    const VectorXd jumps = _of_open.solve(of_open);
    goal.jumps(_open) = jumps;
  }
  goal.reactions = -goal.load.r;
  if (!_open.empty())
    goal.reactions += (_problem.lcp().scaled_matrix() * goal.jumps).cwiseQuotient(scale);
  goal.reactions(_open).setZero();
  goal.jumps = goal.jumps.cwiseProduct(scale);
  goal.compliance = unit.dot(_problem.unknowns(goal.load, goal.jumps));
  return goal;
}

Adjoint::Pair Adjoint::clipped(const Goal& goal, double c) const {
  Pair pair;
  const VectorXd jumps = clip(goal.jumps, c * _jumps);
  pair.z = _problem.unknowns(goal.load, jumps);
  const VectorXd scale = _problem.lcp().scale().head(_jumps.size());
  VectorXd free = scale.cwiseProduct(goal.load.r + clip(goal.reactions, c * _lambda));
  if (free.size() > 0) _of_all.solveInPlace(free);
  pair.reacting = _problem.unknowns(goal.load, free.cwiseProduct(scale));
  return pair;
}

}  // namespace anticrack::contact
