// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/at.hpp"
#include "contact/answer.hpp"
#include "contact/case_state.hpp"
#include "contact/contact_problem.hpp"
#include "contact/solve.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The solution of one load case.
class Case {
 public:
  Case(const ContactProblem& problem, const CaseLoads& loads, std::span<const char> tied)
      : _problem(problem),
        _loads(loads.subdomains),
        _tied(tied),
        _solved(problem.traces(), loads, tied) {
    _position.load = problem.reduce(_loads, held_values(problem.traces().decomposition(), _loads));
    _position.d.setZero(_position.load.r.size());
    _solved.state().load_size = _position.load.size;
    if (problem.condensed()) return;
    const Work closed = problem.work(_loads, _position.load);
    _closed_size = closed.u.dot(closed.internal);
    _closed_energy = _closed_size / 2 - closed.u.dot(closed.load);
    for (const ddm::CondensedLoad& load : _loads) _closed_energy += load.energy_constant;
  }

  const Reduced& reduced() const noexcept { return _position.load; }
  const CaseState& solved() const noexcept { return _solved; }

  void sample_step(const LcpStep& step) {
    const VectorXd d = step.d.head(_position.d.size());
    if (_problem.condensed()) {
      const std::vector<VectorXd> trace = state().trace, flux = state().flux;
      move_to(d);
      _solved.sample().criterion = trace.empty() ? 1 : criterion(trace, flux);
      _solved.fill(step.d, step.lambda);
    } else {
      sample_jumps(d, step);
    }
    _solved.sample().iteration = step.number;
  }

  /// Improves the solution by iterative refinement, with multipliers from the forces themselves. A
  /// condensed problem needs one step and a joined one, whose x is refined already, none; both need
  /// more where terms far larger than the load cancel, as between inclusions that nearly touch.
  void finish(const LcpAnswer& solution) {
    const bool condensed = _problem.condensed();
    if (condensed && solution.status != LcpStatus::solved) return;
    const double enough = condensed ? 1e-11 : 1e-12;
    constexpr int most_steps = 5;
    // Nodes that were open by rounding only have been closed since the last sample.
    const VectorXd d = solution.d.head(_position.d.size());
    if (!condensed || d != _position.d) move_to(d);
    if (!condensed) settle(solution);
    double left = condensed ? std::numeric_limits<double>::max() : unbalanced();
    double before = std::numeric_limits<double>::infinity();
    for (int step = 0; left > enough && left < before / 2 && step < most_steps; ++step) {
      _problem.refine(_loads, state(), solution, _position);
      show();
      settle(solution);
      before = left;
      left = unbalanced();
    }
  }

 private:
  const TraceState& state() const noexcept { return _solved.state(); }
  double unbalanced() const {
    return ratio(_solved.sample().kkt.equilibrium, scales_of(_loads, state()).force);
  }

  void move_to(const VectorXd& d) {
    _position.d = d;
    _position.x = _problem.solve(_position.load, d);
    show();
  }

  /// Computes traces, fluxes and motions of the position.
  void show() {
    const VectorXd w = _problem.values(_position.x, _position.d, _position.load.p);
    _problem.fill(_loads, _position.x, w, _solved.state());
    _solved.set_motion(w);
  }

  /// Computes pressures and contact of the position.
  void settle(const LcpAnswer& solution) {
    VectorXd lambda = _problem.multipliers(state(), solution.closed);
    for (Index i = 0; i < lambda.size(); ++i)
      if (at(i) >= _tied.size() || _tied[at(i)] == 0) lambda[i] = std::max(lambda[i], 0.0);
    _solved.fill(_problem.conditions().jumps(_position.d, solution.closed), lambda);
    _solved.settle_contact(solution.pressed, lambda);
  }

  /// Fills a sample from jumps and multipliers alone, as traces would cost a solve.
  void sample_jumps(const VectorXd& d, const LcpStep& step) {
    Sample& sample = _solved.sample();
    const VectorXd& r = reduced().r;
    const double worked = (d - _position.d).dot(r), all = std::abs(r.dot(d)) + _closed_size;
    sample.criterion = step.number == 1 ? 1 : ratio(std::abs(worked), all);
    sample.energy = _closed_energy - r.dot(d) / 2;
    sample.kkt = {};
    sample.contact_count = 0;
    const VectorXd& mass = _problem.traces().pair_forces().contact_mass();
    for (Index i = 0; i < step.lambda.size(); ++i) {
      const double mu = step.lambda[i] / mass[i];
      sample.kkt.gap = std::max(sample.kkt.gap, -step.d[i]);
      sample.kkt.complementarity = std::max(sample.kkt.complementarity, std::abs(mu * step.d[i]));
      sample.contact_count += mu > 0 ? 1 : 0;
    }
    _position.d = d;
  }

  /// max_i |u_k - u_{k-1}|_V^2 / |u_k|_V^2, from scaled traces and fluxes whose squares do not
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

  const ContactProblem& _problem;
  std::span<const ddm::CondensedLoad> _loads;
  std::span<const char> _tied;
  CaseState _solved;
  Position _position;
  double _closed_energy = 0, _closed_size = 0;  // Pi and |u|_V^2 with every contact closed
};

}  // namespace

Answer solve_active_set(const ContactProblem& problem, const mesh::Mesh& mesh,
                        const CaseLoads& loads, const ActiveSetOptions& options, bool fields,
                        Observer& observer, std::span<const char> start,
                        std::span<const char> tied) {
  Case load_case(problem, loads, tied);
  const LcpAnswer solution = problem.solve_contact(
      load_case.reduced(), {options.tolerance, options.max_steps, false, tied}, start,
      [&](const LcpStep& step) {
        load_case.sample_step(step);
        return observer.on_iteration(load_case.solved().sample());
      });
  load_case.finish(solution);
  Answer answer = conclude(problem.traces(), mesh, loads, load_case.solved(), solution);
  if (fields) {
    const SolvedCase solved{loads.subdomains, answer};
    problem.recover_fields({&solved, 1});
  }
  return answer;
}

}  // namespace anticrack::contact
