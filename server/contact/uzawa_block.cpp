// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/uzawa_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "contact/trace_state.hpp"
#include "errors/errors.hpp"

namespace anticrack::contact {
namespace {

constexpr double safety = 0.97;  // of theta*, for `auto`
constexpr int equilibrium_period = 64;

std::string bound_of(const UzawaOptions& options, int held_at_bound) {
  return fmt::format(
      "the multipliers are held at their bound p = {:g} in {} node{}, so this is not a solution: "
      "raise "
      "p, or use the method \"active-set\"",
      options.p, held_at_bound, held_at_bound == 1 ? "" : "s");
}

std::string thetas_of(const Answer& answer) {
  return fmt::format("theta = {:g}, theta* = {:g}", answer.theta, answer.theta_star);
}

bool far_from_theta_star(const Answer& answer) {
  return answer.theta < answer.theta_star / 2 || answer.theta > answer.theta_star;
}

std::string oscillation_reason(const Answer& answer) {
  return fmt::format(
      "the iteration oscillates and cannot converge: theta = {:g} is above theta* = {:g} of this "
      "mesh "
      "(Theorem 4), criterion stuck near {:g}; set theta to auto, or below {:g}",
      answer.theta, answer.theta_star, answer.criterion, answer.theta_star);
}

std::string overflow_reason(const Answer& answer) {
  return fmt::format("the iterates are no longer finite with {}; scale the load down{}",
                     thetas_of(answer),
                     answer.theta > answer.theta_star ? ", and set theta to auto" : "");
}

std::string limit_reason(const Answer& answer, const UzawaOptions& options, int held_at_bound) {
  const std::optional<double> wanted = options.kkt_tolerance;
  const std::string fault =
      wanted ? fmt::format("{}, not all below kkt_tolerance = {:g}", residuals_of(answer), *wanted)
             : fmt::format("the criterion is {:g}, not below epsilon = {:g}", answer.criterion,
                           options.epsilon);
  const std::string cure =
      held_at_bound > 0
          ? bound_of(options, held_at_bound)
          : fmt::format("raise max_iterations or {}{}", wanted ? "kkt_tolerance" : "epsilon",
                        far_from_theta_star(answer) ? ", or set theta to auto" : "");
  return fmt::format("after {} iterations {} ({}); {}", options.max_iterations, fault,
                     thetas_of(answer), cure);
}

std::string unsolved_reason(const Answer& answer, const UzawaOptions& options, int held_at_bound) {
  const std::string fault =
      held_at_bound > 0
          ? "but " + bound_of(options, held_at_bound)
          : fmt::format(
                "criterion {:g} below epsilon = {:g}, but {}, not all below {:g} ({}); {}set "
                "kkt_tolerance to stop by the residuals, or use the method \"active-set\"",
                answer.criterion, options.epsilon, residuals_of(answer), solution_residual,
                thetas_of(answer), far_from_theta_star(answer) ? "set theta to auto, " : "");
  return fmt::format("the iteration stopped after {} iterations, {}", answer.iterations, fault);
}

}  // namespace

UzawaBlock::UzawaBlock(const TraceProblem& problem, const mesh::Mesh& mesh, Mass mass, int capacity)
    : _problem(problem),
      _mesh(mesh),
      _mass(mass),
      _theta_star(problem.theta_star(mass)),
      _uzawa(problem, mass, capacity),
      _cases(at(capacity)) {
  for (int c = 0; c < capacity; ++c) column(c).place = c;
}

int UzawaBlock::add(const CaseLoads& loads, const UzawaOptions& options, bool fields,
                    Observer& observer) {
  if (_running + _ended == capacity()) {
    throw errors::Error(errors::Reason::internal,
                        "a block of {} columns is full; take the columns that have ended first",
                        capacity());
  }
  if (options.mass != _mass) {
    throw errors::Error(errors::Reason::internal,
                        "a load case with another interface mass than the block's");
  }
  const int c = _running;
  exchange(c, _running + _ended);  // the first that has ended goes behind the last
  Case& joining = column(c);
  joining = {joining.place, loads, options, fields, &observer, 0, {}, {}, End::running};
  // Without an interface there is nothing to relax, and any theta works.
  joining.theta = options.theta.value_or(std::isfinite(_theta_star) ? safety * _theta_star : 1.0);
  _uzawa.start(c, loads.subdomains, joining.theta, options.p);
  ++_running;
  return joining.place;
}

void UzawaBlock::exchange(int a, int b) {
  _uzawa.exchange(a, b);
  std::swap(column(a), column(b));
}

void UzawaBlock::step() {
  _uzawa.step(_running);
  // Backwards, so that a column moved to the place of one that ends has been observed already.
  for (int c = _running - 1; c >= 0; --c) {
    observe(c);
    if (column(c).end != End::running) {
      --_running;
      ++_ended;
      exchange(c, _running);
    }
  }
}

void UzawaBlock::observe(int c) {
  Case& seen = column(c);
  const Iterate& iterate = _uzawa.iterate(c);
  const ddm::Decomposition& decomposition = _problem.decomposition();
  Sample& sample = seen.sample;
  const double equilibrium = sample.kkt.equilibrium;
  sample.iteration = iterate.number;
  sample.criterion = iterate.criterion;
  sample.energy = iterate.energy;
  sample.contact_count = contact_count(decomposition, _uzawa.mu(c));
  sample.kkt = contact_residuals(decomposition, _uzawa.mu(c), _uzawa.jump(c));
  sample.kkt.equilibrium = equilibrium;

  seen.end = judge(c);
  if (seen.end != End::running || iterate.number == 1 || iterate.number % equilibrium_period == 0)
    sample.kkt.equilibrium = _uzawa.equilibrium(c);
  if (!seen.observer->on_iteration(sample)) seen.end = End::cancelled;
}

UzawaBlock::End UzawaBlock::judge(int c) {
  Case& seen = column(c);
  const Iterate& iterate = _uzawa.iterate(c);
  if (!std::isfinite(iterate.criterion) || !std::isfinite(iterate.energy)) return End::overflow;
  const std::optional<double> wanted = seen.options.kkt_tolerance;
  if (wanted ? within_tolerance(c, _uzawa.scales(c), *wanted)
             : iterate.criterion < seen.options.epsilon)
    return (wanted || solved(c)) && _uzawa.held_at_bound(c) == 0 ? End::converged : End::unsolved;
  if (seen.theta > _theta_star && seen.monitor.add(iterate.criterion, iterate.turned))
    return End::oscillation;
  return iterate.number >= seen.options.max_iterations ? End::limit : End::running;
}

/// Whether all relative residuals are below the tolerance; the costly equilibrium comes last.
bool UzawaBlock::within_tolerance(int c, const Scales& scales, double tolerance) {
  KktResiduals& absolute = column(c).sample.kkt;
  if (absolute.gap > tolerance * scales.trace || absolute.sign > tolerance * scales.mu ||
      absolute.complementarity > tolerance * scales.mu * scales.trace)
    return false;
  absolute.equilibrium = _uzawa.equilibrium(c);
  return within(
      relative_residuals(_problem.decomposition(), _uzawa.mu(c), _uzawa.jump(c), scales, absolute),
      tolerance);
}

/// Whether the residuals are those of a solution. A load that closes the crack may leave all traces
/// near 0, so the gap is measured by the displacement in the subdomains as well.
bool UzawaBlock::solved(int c) {
  Scales scales = _uzawa.scales(c);
  scales.trace = std::max(scales.trace, _uzawa.iterate(c).size);
  return within_tolerance(c, scales, solution_residual);
}

std::vector<UzawaBlock::Ended> UzawaBlock::take_ended() {
  std::vector<Ended> ended;
  ended.reserve(at(_ended));
  for (int c = _running; c < _running + _ended; ++c) ended.push_back({column(c).place, answer(c)});
  std::vector<SolvedCase> wanted;
  for (int c = 0; c < _ended; ++c) {
    const Case& one = column(_running + c);
    if (one.fields) wanted.push_back({one.loads.subdomains, ended[at(c)].answer});
  }
  recover_fields(_problem, wanted);
  _ended = 0;
  std::sort(ended.begin(), ended.end(),
            [](const Ended& a, const Ended& b) { return a.place < b.place; });
  return ended;
}

Answer UzawaBlock::answer(int c) {
  const Case& ended = column(c);
  const TraceState state = _uzawa.state(c);
  Answer answer;
  answer.theta = ended.theta;
  answer.theta_star = _theta_star;
  answer.iterations = ended.sample.iteration;
  answer.criterion = ended.sample.criterion;
  describe(_problem, _mesh, ended.loads, state, ended.sample, answer);
  switch (ended.end) {
    case End::running:
      break;
    case End::converged:
      answer.status = Status::converged;
      break;
    case End::unsolved:
      answer.reason = unsolved_reason(answer, ended.options, _uzawa.held_at_bound(c));
      break;
    case End::cancelled:
      answer.status = Status::cancelled;
      break;
    case End::overflow:
      answer.reason = overflow_reason(answer);
      break;
    case End::oscillation:
      answer.reason = oscillation_reason(answer);
      break;
    case End::limit:
      answer.reason = limit_reason(answer, ended.options, _uzawa.held_at_bound(c));
      break;
  }
  return answer;
}

}  // namespace anticrack::contact
