// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/case_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/at.hpp"
#include "contact/answer.hpp"
#include "errors/errors.hpp"

namespace anticrack::contact {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

std::string overflow(std::span<const ddm::CondensedLoad> loads) {
  double force = 0;
  for (const ddm::CondensedLoad& load : loads) force = std::max(force, largest(load.g));
  return fmt::format(
      "the energy overflows: the largest force on a node of the interfaces is {:g}; scale the load "
      "down",
      force);
}

}  // namespace

void CaseState::set_motion(const VectorXd& w) {
  const std::vector<ddm::RigidMotion>& motions = _traces.decomposition().skeleton.motions;
  _state.motion.resize(3, static_cast<Index>(motions.size()));
  for (std::size_t j = 0; j < motions.size(); ++j) {
    const ddm::RigidMotion& motion = motions[j];
    _state.motion.col(static_cast<Index>(j)) << sum_of(motion.displacement, w),
        sum_of(motion.slope_x, w), sum_of(motion.slope_y, w);
  }
}

VectorXd CaseState::of_loose_contacts(const VectorXd& lambda) const {
  VectorXd result = lambda;
  for (std::size_t c = 0; c < _tied.size(); ++c)
    if (_tied[c] != 0) result[static_cast<Index>(c)] = 0;
  return result;
}

VectorXd CaseState::of_loose_pairs(const VectorXd& mu) const {
  VectorXd result = mu;
  if (_tied.empty()) return result;
  const std::vector<ddm::NodePair>& pairs = _traces.decomposition().pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (pairs[i].contact >= 0 && at(pairs[i].contact) < _tied.size() &&
        _tied[at(pairs[i].contact)] != 0)
      result[static_cast<Index>(i)] = 0;
  return result;
}

void CaseState::settle_contact(std::vector<char> pressed, const VectorXd& lambda) {
  _traces.pair_forces().complete_contact(of_loose_contacts(lambda), pressed);
  const std::vector<ddm::NodePair>& pairs = _traces.decomposition().pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (pairs[i].contact >= 0) _state.contact[i] = pressed[at(pairs[i].contact)];
  for (const PairForces::Implied& implied : _traces.pair_forces().implied())
    _state.contact[at(implied.pair)] = pressed_through(implied.path, pressed) ? 1 : 0;
}

void CaseState::fill(const VectorXd& jumps, const VectorXd& lambda) {
  const std::vector<ddm::NodePair>& pairs = _traces.decomposition().pairs;
  _state.mu = _traces.pair_forces().multipliers(_state.flux, lambda);
  _state.force = _traces.lumped_mass().cwiseProduct(_state.mu);
  _state.jump = VectorXd::Zero(_traces.pair_count());
  for (Index i = 0; i < _state.jump.size(); ++i) {
    const ddm::NodePair& pair = pairs[at(i)];
    // The jump where it is known; the difference of the traces has rounding errors.
    _state.jump[i] = pair.contact >= 0 ? jumps[pair.contact]
                                       : _state.trace[at(pair.plus)][pair.plus_trace] -
                                             _state.trace[at(pair.minus)][pair.minus_trace];
  }
  for (const PairForces::Implied& implied : _traces.pair_forces().implied())
    if (_state.mu[implied.pair] > 0)  // closed as its contacts are; traces have rounding errors
      _state.jump[implied.pair] = 0;
  const VectorXd loose = of_loose_pairs(_state.mu);
  _state.contact.assign(pairs.size(), 0);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    _state.contact[i] = pairs[i].unilateral() && loose[static_cast<Index>(i)] > 0 ? 1 : 0;
  _sample.energy = energy(_loads.subdomains, _state);
  for (std::size_t j = 0; j < _loads.inclusion_forces.size(); ++j)
    _sample.energy -=
        work(_loads.inclusion_forces[j].on_holders, _state.motion.col(static_cast<Index>(j)));
  _sample.contact_count = contact_count(_traces.decomposition(), loose);
  _sample.kkt = contact_residuals(_traces.decomposition(), loose, _state.jump);
  _sample.kkt.equilibrium = equilibrium_residual(_traces.decomposition(), _state);
}

Answer conclude(const TraceProblem& traces, const mesh::Mesh& mesh, const CaseLoads& loads,
                const CaseState& solved, const LcpAnswer& solution) {
  Answer answer;
  answer.iterations = solution.steps;
  answer.criterion = solved.sample().criterion;
  switch (solution.status) {
    case LcpStatus::solved:
      answer.status = Status::converged;
      break;
    case LcpStatus::unbounded:
      answer.reason =
          "a part of the membrane that only contact holds is pulled off by this load; hold it by "
          "glue or a prescribed boundary value, or press it on";
      break;
    case LcpStatus::step_limit:
      answer.reason = fmt::format(
          "after {} steps the set of closed nodes still changes; raise max_steps", solution.steps);
      break;
    case LcpStatus::stopped:
      answer.status = Status::cancelled;
      break;
  }
  answer.weakly_active = solution.weakly_active;
  answer.closed = solution.closed;
  describe(traces, mesh, loads, solved.state(), solved.sample(), answer);
  if (!std::isfinite(answer.energy) && answer.status != Status::cancelled)
    throw errors::Error(errors::Reason::numerical, overflow(loads.subdomains));
  if (answer.status == Status::converged && !within(answer.kkt_relative, solution_residual)) {
    answer.status = Status::not_converged;
    answer.reason = fmt::format(
        "rounding spoils the answer: {}, not all below {:g}; use a mesh with a larger tip_size, or "
        "bring the tensions nearer to each other",
        residuals_of(answer), solution_residual);
  }
  return answer;
}

}  // namespace anticrack::contact
