// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/solve.hpp"
#include "errors/errors.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Traces, multipliers and samples of one load from the skeleton's unknowns.
class Case {
 public:
  Case(const SkeletonProblem& problem, const CaseLoads& loads)
      : _problem(problem), _traces(problem.traces()), _loads(loads.subdomains) {
    std::vector<VectorXd> g;
    g.reserve(_loads.size());
    for (const ddm::CondensedLoad& load : _loads) g.push_back(load.g);
    _reduced = problem.reduce(problem.gather(g), held_values(_traces.decomposition(), _loads));
  }

  const SkeletonProblem::Reduced& reduced() const noexcept { return _reduced; }
  const TraceState& state() const noexcept { return _state; }
  const Sample& sample() const noexcept { return _sample; }

  /// `jumps` and `lambda`: of all contacts.
  void sample_step(int number, const VectorXd& jumps, const VectorXd& lambda) {
    _sample.iteration = number;
    _d = jumps.head(_problem.lcp().size());
    move_to(_problem.unknowns(_reduced, _d));
    fill(jumps, lambda);
  }

  /// One step of iterative refinement, and multipliers from the forces themselves.
  void refine(const LcpAnswer& solution) {
    VectorXd d = solution.d.head(_d.size());
    if (d != _d)  // after the last sample, nodes open by rounding were closed
      move_to(_problem.unknowns(_reduced, d));
    _problem.refine(-_problem.gather(_state.flux), solution.factor, _reduced, d);
    d = d.cwiseMax(0.0);
    move_to(_problem.unknowns(_reduced, d));
    const VectorXd lambda =
        _problem.lcp().split(_problem.multipliers(-_problem.gather(_state.flux)), solution.closed);
    fill(_problem.lcp().jumps(d), lambda);
    settle_contact(solution.pressed, lambda);
  }

 private:
  void move_to(const VectorXd& w) {
    std::vector<VectorXd> previous_trace = std::move(_state.trace);
    std::vector<VectorXd> previous_flux = std::move(_state.flux);
    _state.trace = _problem.scatter(w);
    _state.flux = fluxes(_traces.operators(), _loads, _state.trace);
    const std::vector<ddm::RigidMotion>& motions = _traces.decomposition().skeleton.motions;
    _state.motion.resize(3, static_cast<Index>(motions.size()));
    for (std::size_t j = 0; j < motions.size(); ++j) {
      const ddm::RigidMotion& motion = motions[j];
      _state.motion.col(static_cast<Index>(j)) << sum_of(motion.displacement, w),
          sum_of(motion.slope_x, w), sum_of(motion.slope_y, w);
    }
    _sample.criterion = previous_trace.empty() ? 1 : criterion(previous_trace, previous_flux);
  }

  /// max_i |u_k - u_{k-1}|_V^2 / |u_k|_V^2, of scaled traces and fluxes, whose squares do not
  /// overflow.
  double criterion(const std::vector<VectorXd>& previous_trace,
                   const std::vector<VectorXd>& previous_flux) const {
    double worst = 0;
    for (std::size_t s = 0; s < _loads.size(); ++s) {
      const VectorXd& t = _state.trace[s];
      if (t.size() == 0) continue;
      const VectorXd force = _state.flux[s] + _loads[s].g;
      const double size = std::max(t.lpNorm<Eigen::Infinity>(), force.lpNorm<Eigen::Infinity>());
      if (size == 0) continue;
      const VectorXd scaled = t / size;
      const double change =
          ((t - previous_trace[s]) / size).dot((_state.flux[s] - previous_flux[s]) / size);
      const double constant = _loads[s].norm_constant / size / size;
      const double norm = scaled.dot(force / size) - 2 * scaled.dot(_loads[s].g_boundary / size) +
                          (std::isfinite(constant) ? constant : 0);
      worst = std::max(worst, change > 0 ? change / norm : 0);
    }
    return worst;
  }

  /// Nodes that just touch are not in contact: their pressure is rounding.
  void settle_contact(std::vector<char> pressed, const VectorXd& lambda) {
    _traces.pair_forces().complete_contact(lambda, pressed);
    const std::vector<ddm::NodePair>& pairs = _traces.decomposition().pairs;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (pairs[i].contact >= 0) _state.contact[i] = pressed[at(pairs[i].contact)];
    for (const PairForces::Implied& implied : _traces.pair_forces().implied())
      _state.contact[at(implied.pair)] = pressed_through(implied.path, pressed) ? 1 : 0;
  }

  void fill(const VectorXd& jumps, const VectorXd& lambda) {
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
      if (_state.mu[implied.pair] > 0)  // closed as its contacts are, which the traces round
        _state.jump[implied.pair] = 0;
    _state.contact.assign(pairs.size(), 0);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      _state.contact[i] = pairs[i].unilateral() && _state.mu[static_cast<Index>(i)] > 0 ? 1 : 0;
    _sample.energy = energy(_loads, _state);
    _sample.contact_count = contact_count(_traces.decomposition(), _state.mu);
    _sample.kkt = contact_residuals(_traces.decomposition(), _state.mu, _state.jump);
    _sample.kkt.equilibrium = equilibrium_residual(_traces.decomposition(), _state);
  }

  const SkeletonProblem& _problem;
  const TraceProblem& _traces;
  std::span<const ddm::CondensedLoad> _loads;
  SkeletonProblem::Reduced _reduced;
  VectorXd _d;  // of the last step
  TraceState _state;
  Sample _sample;
};

std::string overflow(std::span<const ddm::CondensedLoad> loads) {
  double force = 0;
  for (const ddm::CondensedLoad& load : loads) force = std::max(force, largest(load.g));
  return fmt::format(
      "the energy overflows: the largest force on a node of the interfaces is {:g}; scale the load "
      "down",
      force);
}

}  // namespace

Answer solve_active_set(const SkeletonProblem& problem, const mesh::Mesh& mesh,
                        const CaseLoads& loads, const ActiveSetOptions& options, bool fields,
                        Observer& observer, std::span<const char> start) {
  Case load_case(problem, loads);
  const auto on_step = [&](const LcpStep& step) {
    load_case.sample_step(step.number, step.d, step.lambda);
    return observer.on_iteration(load_case.sample());
  };
  const SkeletonProblem::Reduced& reduced = load_case.reduced();
  const std::vector<char> nested = start.empty()
                                       ? problem.nested_start().closed(reduced.r, reduced.magnitude)
                                       : std::vector<char>(start.begin(), start.end());
  const LcpAnswer solution = problem.lcp().solve(
      reduced.r, reduced.magnitude, {options.tolerance, options.max_steps}, nested, on_step);
  Answer answer;
  answer.iterations = solution.steps;
  answer.criterion = load_case.sample().criterion;
  switch (solution.status) {
    case LcpStatus::solved:
      answer.status = Status::converged;
      load_case.refine(solution);
      break;
    case LcpStatus::unbounded:
      answer.reason =
          "a part of the membrane that only contact holds is pulled off by this load; hold it by "
          "glue or a prescribed boundary value, or press it on";
      break;
    case LcpStatus::step_limit:
      answer.reason =
          fmt::format("after {} steps the set of closed nodes still changes; raise max_steps",
                      options.max_steps);
      break;
    case LcpStatus::stopped:
      answer.status = Status::cancelled;
      break;
  }
  answer.weakly_active = solution.weakly_active;
  answer.closed = solution.closed;
  describe(problem.traces(), mesh, loads, load_case.state(), load_case.sample(), answer);
  if (!std::isfinite(answer.energy) && answer.status != Status::cancelled)
    throw errors::Error(errors::Reason::numerical, overflow(loads.subdomains));
  if (answer.status == Status::converged && !within(answer.kkt_relative, solution_residual)) {
    answer.status = Status::not_converged;
    answer.reason = fmt::format(
        "rounding spoils the answer: {}, not all below {:g}; use a mesh with a larger tip_size, or "
        "bring the tensions nearer to each other",
        residuals_of(answer), solution_residual);
  }
  if (fields) {
    const SolvedCase solved{loads.subdomains, answer};
    recover_fields(problem.traces(), {&solved, 1});
  }
  return answer;
}

}  // namespace anticrack::contact
