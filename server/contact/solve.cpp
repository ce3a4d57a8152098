// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/solve.hpp"

#include <cmath>
#include <sstream>

#include "contact/answer_parts.hpp"
#include "contact/stagnation.hpp"
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

std::string limit_reason(double theta, double theta_star, double criterion,
                         const UzawaOptions& options) {
  std::ostringstream text;
  text << "after " << options.max_iterations << " iterations the criterion is " << criterion
       << ", not below epsilon = " << options.epsilon << " (theta = " << theta
       << ", theta* = " << theta_star << "); raise max_iterations or epsilon";
  if (theta < theta_star / 2 || theta > theta_star) {
    text << ", or set theta to auto";
  }
  return text.str();
}

}  // namespace

Answer solve_uzawa(const TraceProblem& problem, const mesh::Mesh& mesh,
                   std::span<const ddm::CondensedLoad> loads, const UzawaOptions& options,
                   bool fields, Observer& observer) {
  Answer answer;
  answer.theta_star = problem.theta_star(options.mass);
  // Without an interface there is nothing to relax: any theta will do.
  answer.theta =
      options.theta.value_or(std::isfinite(answer.theta_star) ? safety * answer.theta_star : 1.0);

  Uzawa uzawa(problem, loads, answer.theta, options.p, options.mass);
  StagnationMonitor monitor;
  Sample sample;
  for (bool running = true; running;) {
    const Iterate& iterate = uzawa.step();
    const bool finite = std::isfinite(iterate.criterion) && std::isfinite(iterate.energy);
    const bool converged = iterate.criterion < options.epsilon;
    const bool hopeless =
        answer.theta > answer.theta_star && monitor.add(iterate.criterion, iterate.turned);
    if (!finite) {
      answer.reason = overflow_reason(answer.theta, answer.theta_star);
    } else if (converged) {
      answer.status = Status::converged;
    } else if (hopeless) {
      answer.reason = oscillation_reason(answer.theta, answer.theta_star, iterate.criterion);
    } else if (iterate.number >= options.max_iterations) {
      answer.reason = limit_reason(answer.theta, answer.theta_star, iterate.criterion, options);
    }
    running = !converged && answer.reason.empty();

    const double equilibrium = sample.kkt.equilibrium;
    const bool measure =
        !running || iterate.number == 1 || iterate.number % equilibrium_period == 0;
    sample.iteration = iterate.number;
    sample.criterion = iterate.criterion;
    sample.energy = iterate.energy;
    sample.contact_count = uzawa.contact_count();
    sample.kkt = uzawa.kkt();
    sample.kkt.equilibrium = measure ? uzawa.equilibrium_residual() : equilibrium;
    if (!observer.on_iteration(sample)) {
      answer.status = Status::cancelled;
      answer.reason.clear();
      running = false;
    }
  }
  answer.iterations = sample.iteration;
  answer.criterion = sample.criterion;
  answer.energy = sample.energy;
  answer.kkt = sample.kkt;
  answer.kkt_relative = uzawa.relative(sample.kkt);
  describe(problem, mesh, loads, uzawa, fields, answer);
  return answer;
}

}  // namespace anticrack::contact
