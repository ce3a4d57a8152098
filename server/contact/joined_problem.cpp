// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/joined_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/case_state.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// One load.
class JoinedCase {
 public:
  JoinedCase(const JoinedProblem& problem, const CaseLoads& loads)
      : _problem(problem),
        _membrane(problem.membrane()),
        _loads(loads.subdomains),
        _solved(problem.traces(), loads),
        _reduced(_membrane.reduce(_loads, held_values(_membrane.decomposition(), _loads))),
        _d(VectorXd::Zero(_membrane.contacts())) {
    _closed_energy = _membrane.work(_reduced, _reduced) / 2 - _membrane.work(_loads, _reduced);
    for (const ddm::CondensedLoad& load : _loads) _closed_energy += load.energy_constant;
  }

  const JoinedMembrane::Reduced& reduced() const noexcept { return _reduced; }
  const CaseState& solved() const noexcept { return _solved; }

  /// From jumps and multipliers alone: traces would take a solve.
  void sample_step(const LcpStep& step) {
    Sample& sample = _solved.sample();
    const VectorXd d = step.d.head(_d.size()), change = d - _d;
    const double worked = change.dot(_reduced.r), all = std::abs(_reduced.r.dot(d)) + size();
    sample.criterion = sample.iteration == 0 ? 1 : ratio(std::abs(worked), all);
    sample.iteration = step.number;
    sample.energy = _closed_energy - _reduced.r.dot(d) / 2;
    sample.kkt = {};
    sample.contact_count = 0;
    const VectorXd& mass = _problem.traces().pair_forces().contact_mass();
    for (Index i = 0; i < step.lambda.size(); ++i) {
      const double mu = step.lambda[i] / mass[i];
      sample.kkt.gap = std::max(sample.kkt.gap, -step.d[i]);
      sample.kkt.complementarity = std::max(sample.kkt.complementarity, std::abs(mu * step.d[i]));
      sample.contact_count += mu > 0 ? 1 : 0;
    }
    _d = d;
  }

  /// Traces, fluxes and multipliers. Where rounding of S^ d shows, iterative refinement.
  void finish(const BlockLcp::Answer& solution) {
    constexpr double most_left = 1e-12;
    constexpr int most_steps = 3;
    VectorXd d = solution.d, x = _membrane.solve(_reduced, d);
    move_to(x, d, solution);
    double left = unbalanced(), before = std::numeric_limits<double>::infinity();
    for (int step = 0; left > most_left && left < before / 2 && step < most_steps; ++step) {
      const VectorXd w = _membrane.values(_reduced, x, d), no_p = VectorXd::Zero(_reduced.p.size());
      const JoinedMembrane::Reduced of_left =
          _membrane.reduce(_membrane.residual(_loads, x, w), no_p);
      const VectorXd change = _problem.lcp().solve_open(of_left.r, solution.closed).d;
      x += _membrane.solve(of_left, change);
      d = (d + change).cwiseMax(0.0);
      move_to(x, d, solution);
      before = left;
      left = unbalanced();
    }
  }

 private:
  /// |u|_V^2 with every contact closed.
  double size() const { return _membrane.work(_reduced, _reduced); }
  double unbalanced() const {
    return ratio(_solved.sample().kkt.equilibrium, scales_of(_loads, _solved.state()).force);
  }

  /// Multipliers from the forces themselves.
  void move_to(const VectorXd& x, const VectorXd& d, const BlockLcp::Answer& solution) {
    const VectorXd w = _membrane.values(_reduced, x, d);
    _membrane.fill(_loads, x, w, _solved.state());
    _solved.state().load_size = std::max(largest(_reduced.force), largest(_reduced.r));
    _solved.set_motion(w);
    const VectorXd force = _membrane.multipliers(_solved.state());
    const VectorXd lambda = _problem.lcp().split(force, solution.closed).cwiseMax(0.0);
    _solved.fill(_problem.lcp().jumps(d, solution.closed), lambda);
    _solved.settle_contact(solution.pressed, lambda);
  }

  const JoinedProblem& _problem;
  const JoinedMembrane& _membrane;
  std::span<const ddm::CondensedLoad> _loads;
  CaseState _solved;
  JoinedMembrane::Reduced _reduced;
  double _closed_energy = 0;
  VectorXd _d;  // of the last step
};

}  // namespace

bool is_long(const ddm::Decomposition& decomposition, std::size_t most) {
  return decomposition.skeleton.unknowns > most ||
         std::ranges::any_of(decomposition.subdomains, [most](const ddm::Subdomain& subdomain) {
           return subdomain.trace > most;
         });
}

JoinedProblem::JoinedProblem(const TraceProblem& traces, int threads)
    : _traces(traces),
      _membrane(traces.decomposition(), threads),
      _blocks(_membrane, traces.pair_forces(), threads),
      _lcp(_membrane, _blocks) {}

Answer solve_active_set(const JoinedProblem& problem, const mesh::Mesh& mesh,
                        const CaseLoads& loads, const ActiveSetOptions& options, bool fields,
                        Observer& observer, std::span<const char> start) {
  JoinedCase load_case(problem, loads);
  const BlockLcp::Answer solution =
      problem.lcp().solve(load_case.reduced().r, load_case.reduced().magnitude,
                          {options.tolerance, options.max_steps}, start, [&](const LcpStep& step) {
                            load_case.sample_step(step);
                            return observer.on_iteration(load_case.solved().sample());
                          });
  load_case.finish(solution);
  Answer answer =
      conclude(problem.traces(), mesh, loads, load_case.solved(),
               {solution.status, solution.steps, solution.weakly_active, solution.closed});
  if (fields) {
    const SolvedCase solved{loads.subdomains, answer};
    problem.recover_fields({&solved, 1});
  }
  return answer;
}

void JoinedProblem::recover_fields(std::span<const SolvedCase> cases) const {
  const ddm::Decomposition& decomposition = _traces.decomposition();
  const ddm::Skeleton& skeleton = decomposition.skeleton;
  for (const SolvedCase& one : cases) {
    // The jumps from the traces, and from those everything else.
    const VectorXd w = unknowns_of(decomposition, one.answer);
    VectorXd d(_membrane.contacts());
    for (Index c = 0; c < d.size(); ++c)
      d[c] = w[skeleton.contacts[at(c)].plus] - w[skeleton.contacts[at(c)].minus];
    const JoinedMembrane::Reduced reduced =
        _membrane.reduce(one.loads, held_values(decomposition, one.loads));
    const VectorXd x = _membrane.solve(reduced, d);
    for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
      const VectorXd u = _membrane.field(s, x, w);
      Field field{decomposition.subdomains[s].node, std::vector<double>(u.begin(), u.end())};
      field.u.insert(field.u.end(), one.loads[s].dirichlet.begin(), one.loads[s].dirichlet.end());
      one.answer.fields.push_back(std::move(field));
    }
  }
}

}  // namespace anticrack::contact
