// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <utility>

#include "contact/case_state.hpp"
#include "contact/solve.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// One load on the skeleton.
class Case {
 public:
  Case(const SkeletonProblem& problem, const CaseLoads& loads)
      : _problem(problem),
        _traces(problem.traces()),
        _loads(loads.subdomains),
        _solved(_traces, loads) {
    std::vector<VectorXd> g;
    g.reserve(_loads.size());
    for (const ddm::CondensedLoad& load : _loads) g.push_back(load.g);
    _reduced = problem.reduce(problem.gather(g), held_values(_traces.decomposition(), _loads));
    _solved.state().load_size = _reduced.held_size;
  }

  const SkeletonProblem::Reduced& reduced() const noexcept { return _reduced; }
  const CaseState& solved() const noexcept { return _solved; }

  /// `jumps` and `lambda`: of all contacts.
  void sample_step(int number, const VectorXd& jumps, const VectorXd& lambda) {
    _solved.sample().iteration = number;
    _d = jumps.head(_problem.lcp().size());
    move_to(_problem.unknowns(_reduced, _d));
    _solved.fill(jumps, lambda);
  }

  /// Iterative refinement, and multipliers from the forces themselves. One step is enough but where
  /// terms far larger than the load cancel, as between inclusions that nearly touch.
  void refine(const LcpAnswer& solution) {
    constexpr double enough = 1e-11;
    constexpr int most_steps = 5;
    const double criterion = _solved.sample().criterion;  // of the steps
    VectorXd d = solution.d.head(_d.size());
    if (d != _d)  // after the last sample, nodes open by rounding were closed
      move_to(_problem.unknowns(_reduced, d));
    double left = std::numeric_limits<double>::infinity(), before = 0;
    int step = 0;
    do {
      _problem.refine(-_problem.gather(state().flux), solution.factor, _reduced, d);
      d = d.cwiseMax(0.0);
      move_to(_problem.unknowns(_reduced, d));
      const VectorXd lambda =
          _problem.lcp()
              .split(_problem.multipliers(-_problem.gather(state().flux)), solution.closed)
              .cwiseMax(0.0);
      _solved.fill(_problem.lcp().jumps(d, solution.closed), lambda);
      _solved.settle_contact(solution.pressed, lambda);
      before = left;
      left = ratio(_solved.sample().kkt.equilibrium, scales_of(_loads, state()).force);
    } while (left > enough && left < before / 2 && ++step < most_steps);
    _solved.sample().criterion = criterion;
  }

 private:
  const TraceState& state() const noexcept { return _solved.state(); }

  void move_to(const VectorXd& w) {
    std::vector<VectorXd> previous_trace = std::move(_solved.state().trace);
    std::vector<VectorXd> previous_flux = std::move(_solved.state().flux);
    _solved.state().trace = _problem.scatter(w);
    _solved.state().flux = fluxes(_traces.operators(), _loads, state().trace);
    _solved.set_motion(w);
    _solved.sample().criterion =
        previous_trace.empty() ? 1 : criterion(previous_trace, previous_flux);
  }

  /// max_i |u_k - u_{k-1}|_V^2 / |u_k|_V^2, of scaled traces and fluxes, whose squares do not
  /// overflow.
  double criterion(const std::vector<VectorXd>& previous_trace,
                   const std::vector<VectorXd>& previous_flux) const {
    double worst = 0;
    for (std::size_t s = 0; s < _loads.size(); ++s) {
      const VectorXd& t = state().trace[s];
      if (t.size() == 0) continue;
      const VectorXd force = state().flux[s] + _loads[s].g;
      const double size = std::max(t.lpNorm<Eigen::Infinity>(), force.lpNorm<Eigen::Infinity>());
      if (size == 0) continue;
      const VectorXd scaled = t / size;
      const double change =
          ((t - previous_trace[s]) / size).dot((state().flux[s] - previous_flux[s]) / size);
      const double constant = _loads[s].norm_constant / size / size;
      const double norm = scaled.dot(force / size) - 2 * scaled.dot(_loads[s].g_boundary / size) +
                          (std::isfinite(constant) ? constant : 0);
      worst = std::max(worst, change > 0 ? change / norm : 0);
    }
    return worst;
  }

  const SkeletonProblem& _problem;
  const TraceProblem& _traces;
  std::span<const ddm::CondensedLoad> _loads;
  SkeletonProblem::Reduced _reduced;
  VectorXd _d;  // of the last step
  CaseState _solved;
};

}  // namespace

Answer solve_active_set(const SkeletonProblem& problem, const mesh::Mesh& mesh,
                        const CaseLoads& loads, const ActiveSetOptions& options, bool fields,
                        Observer& observer, std::span<const char> start) {
  Case load_case(problem, loads);
  const auto on_step = [&](const LcpStep& step) {
    load_case.sample_step(step.number, step.d, step.lambda);
    return observer.on_iteration(load_case.solved().sample());
  };
  const SkeletonProblem::Reduced& reduced = load_case.reduced();
  const std::vector<char> nested = start.empty()
                                       ? problem.nested_start().closed(reduced.r, reduced.magnitude)
                                       : std::vector<char>(start.begin(), start.end());
  const LcpAnswer solution = problem.lcp().solve(
      reduced.r, reduced.magnitude, {options.tolerance, options.max_steps}, nested, on_step);
  if (solution.status == LcpStatus::solved) load_case.refine(solution);
  Answer answer =
      conclude(problem.traces(), mesh, loads, load_case.solved(),
               {solution.status, solution.steps, solution.weakly_active, solution.closed});
  if (fields) {
    const SolvedCase solved{loads.subdomains, answer};
    recover_fields(problem.traces(), {&solved, 1});
  }
  return answer;
}

}  // namespace anticrack::contact
