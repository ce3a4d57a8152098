// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/solve.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "contact/answer_parts.hpp"
#include "contact/stagnation.hpp"
#include "contact/trace_state.hpp"
#include "contact/uzawa.hpp"

namespace anticrack::contact {
namespace {

constexpr double safety = 0.97;  // of theta*, for `auto`
constexpr int equilibrium_period = 64;

std::string oscillation_reason(double theta, double theta_star, double criterion) {
  std::ostringstream text;
  text << "the iteration oscillates and cannot converge: theta = " << theta
       << " is above theta* = " << theta_star << " of this mesh (Theorem 4), criterion stuck near "
       << criterion << "; set theta to auto, or below " << theta_star;
  return text.str();
}

std::string overflow_reason(double theta, double theta_star) {
  std::ostringstream text;
  text << "the iterates are no longer finite with theta = " << theta << ", theta* = " << theta_star
       << "; scale the load down" << (theta > theta_star ? ", and set theta to auto" : "");
  return text.str();
}

std::string limit_reason(double theta, double theta_star, const Sample& last,
                         const KktResiduals& relative, const UzawaOptions& options) {
  std::ostringstream text;
  text << "after " << options.max_iterations << " iterations ";
  if (options.kkt_tolerance) {
    text << "the relative residuals are " << relative.equilibrium << " (equilibrium), "
         << relative.gap << " (gap), " << relative.sign << " (sign), " << relative.complementarity
         << " (complementarity), not all below kkt_tolerance = " << *options.kkt_tolerance;
  } else {
    text << "the criterion is " << last.criterion << ", not below epsilon = " << options.epsilon;
  }
  text << " (theta = " << theta << ", theta* = " << theta_star << "); raise max_iterations or "
       << (options.kkt_tolerance ? "kkt_tolerance" : "epsilon");
  if (theta < theta_star / 2 || theta > theta_star) {
    text << ", or set theta to auto";
  }
  return text.str();
}

/// Whether all relative residuals are below the tolerance; equilibrium, the dear one, comes last.
bool within(const TraceProblem& problem, const CaseLoads& loads, const Uzawa& uzawa,
            const KktResiduals& contact, double tolerance) {
  const Iterate& iterate = uzawa.iterate();
  double u = 0;
  for (const Eigen::VectorXd& trace : iterate.trace) {
    u = std::max(u, trace.size() == 0 ? 0 : trace.lpNorm<Eigen::Infinity>());
  }
  const double mu = iterate.mu.size() == 0 ? 0 : iterate.mu.lpNorm<Eigen::Infinity>();
  if (contact.gap > tolerance * u || contact.sign > tolerance * mu ||
      contact.complementarity > tolerance * mu * u) {
    return false;
  }
  const TraceState state = uzawa.state();
  KktResiduals absolute = contact;
  absolute.equilibrium = equilibrium_residual(problem.decomposition(), state);
  const KktResiduals relative =
      relative_residuals(problem.decomposition(), loads.subdomains, state, absolute);
  return std::max({relative.equilibrium, relative.gap, relative.sign, relative.complementarity}) <=
         tolerance;
}

}  // namespace

Answer solve_uzawa(const TraceProblem& problem, const mesh::Mesh& mesh, const CaseLoads& loads,
                   const UzawaOptions& options, bool fields, Observer& observer) {
  const ddm::Decomposition& decomposition = problem.decomposition();
  Answer answer;
  answer.theta_star = problem.theta_star(options.mass);
  // Without an interface there is nothing to relax: any theta will do.
  answer.theta =
      options.theta.value_or(std::isfinite(answer.theta_star) ? safety * answer.theta_star : 1.0);

  Uzawa uzawa(problem, loads.subdomains, answer.theta, options.p, options.mass);
  StagnationMonitor monitor;
  Sample sample;
  TraceState state;
  for (bool running = true; running;) {
    const Iterate& iterate = uzawa.step();
    const double equilibrium = sample.kkt.equilibrium;
    sample.iteration = iterate.number;
    sample.criterion = iterate.criterion;
    sample.energy = iterate.energy;
    sample.contact_count = contact_count(decomposition, iterate.mu);
    sample.kkt = contact_residuals(decomposition, iterate.mu, iterate.jump);

    const bool finite = std::isfinite(iterate.criterion) && std::isfinite(iterate.energy);
    const bool converged =
        finite &&
        (options.kkt_tolerance ? within(problem, loads, uzawa, sample.kkt, *options.kkt_tolerance)
                               : iterate.criterion < options.epsilon);
    const bool hopeless =
        answer.theta > answer.theta_star && monitor.add(iterate.criterion, iterate.turned);
    const bool at_limit = iterate.number >= options.max_iterations;
    running = finite && !converged && !hopeless && !at_limit;
    if (!running || iterate.number == 1 || iterate.number % equilibrium_period == 0) {
      state = uzawa.state();
      sample.kkt.equilibrium = equilibrium_residual(decomposition, state);
    } else {
      sample.kkt.equilibrium = equilibrium;
    }
    if (!observer.on_iteration(sample)) {
      answer.status = Status::cancelled;
      break;
    }
    if (converged) {
      answer.status = Status::converged;
    } else if (!finite) {
      answer.reason = overflow_reason(answer.theta, answer.theta_star);
    } else if (hopeless) {
      answer.reason = oscillation_reason(answer.theta, answer.theta_star, iterate.criterion);
    } else if (at_limit) {
      answer.reason = limit_reason(
          answer.theta, answer.theta_star, sample,
          relative_residuals(decomposition, loads.subdomains, state, sample.kkt), options);
    }
  }
  if (answer.status == Status::cancelled) {
    state = uzawa.state();
  }
  answer.iterations = sample.iteration;
  answer.criterion = sample.criterion;
  answer.energy = sample.energy;
  answer.kkt = sample.kkt;
  answer.kkt_relative = relative_residuals(decomposition, loads.subdomains, state, sample.kkt);
  describe(problem, mesh, loads.subdomains, loads.inclusion_forces, state, fields, answer);
  return answer;
}

}  // namespace anticrack::contact
