// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/uzawa.hpp"

#include <algorithm>
#include <cmath>

namespace anticrack::contact {
namespace {

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

double ratio(double value, double scale) {
  return value == 0 ? 0 : value / scale;
}

}  // namespace

Uzawa::Uzawa(const TraceProblem& problem, std::span<const ddm::CondensedLoad> loads, double theta,
             double p, Mass mass)
    : _problem(problem), _loads(loads), _theta(theta), _p(p), _mass(mass) {
  const Eigen::Index pairs = problem.pair_count();
  _iterate.mu = _iterate.jump = Eigen::VectorXd::Zero(pairs);
  _pair_force = _change = _previous_change = Eigen::VectorXd::Zero(pairs);
  for (const ddm::SubdomainOperator& subdomain : problem.operators()) {
    const ddm::Flexibility& flexibility = *subdomain.flexibility();
    const Eigen::VectorXd trace = Eigen::VectorXd::Zero(flexibility.trace_size());
    const Eigen::VectorXd skeleton = Eigen::VectorXd::Zero(flexibility.skeleton_size());
    _iterate.trace.push_back(trace);
    _sides.push_back({trace, trace, trace, skeleton, skeleton});
  }
  for (std::size_t s = 0; s < _sides.size(); ++s) {
    for (const std::int32_t inclusion : problem.decomposition().subdomains[s].rigid) {
      if (inclusion >= 0) {
        _inclusions.resize(std::max(_inclusions.size(), at(inclusion) + 1));
        _inclusions[at(inclusion)] = {
            s, problem.operators()[s].flexibility()->inclusion_column(inclusion)};
      }
    }
  }
  _iterate.displacement = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(_inclusions.size()));
}

const Iterate& Uzawa::step() {
  if (_iterate.number > 0) {
    update_multipliers();
  }
  ++_iterate.number;
  apply_forces();
  solve_sides();

  const ddm::Decomposition& decomposition = _problem.decomposition();
  for (std::size_t i = 0; i < decomposition.pairs.size(); ++i) {
    const ddm::NodePair& pair = decomposition.pairs[i];
    _iterate.jump[static_cast<Eigen::Index>(i)] = _iterate.trace[at(pair.plus)][pair.plus_trace] -
                                                  _iterate.trace[at(pair.minus)][pair.minus_trace];
  }
  for (std::size_t j = 0; j < _inclusions.size(); ++j) {
    const Held& held = _inclusions[j];
    _iterate.displacement[static_cast<Eigen::Index>(j)] =
        _sides[held.subdomain].skeleton[held.column];
  }
  return _iterate;
}

void Uzawa::update_multipliers() {
  _previous_change.swap(_change);
  const auto& pairs = _problem.decomposition().pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double next = std::clamp(_iterate.mu[k] - _theta * _iterate.jump[k],
                                   pairs[i].unilateral() ? 0.0 : -_p, _p);
    _change[k] = next - _iterate.mu[k];
    _iterate.mu[k] = next;
  }
  _iterate.turned = _problem.lumped_mass().cwiseProduct(_change).dot(_previous_change) < 0;
}

void Uzawa::apply_forces() {
  _problem.apply_mass(_mass, _iterate.mu, _pair_force);
  for (std::size_t s = 0; s < _sides.size(); ++s) {
    _sides[s].previous_force.swap(_sides[s].force);
    _sides[s].force = _loads[s].g;
  }
  const auto& pairs = _problem.decomposition().pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double force = _pair_force[static_cast<Eigen::Index>(i)];
    _sides[at(pairs[i].minus)].force[pairs[i].minus_trace] -= force;
    _sides[at(pairs[i].plus)].force[pairs[i].plus_trace] += force;
  }
}

void Uzawa::solve_sides() {
  _iterate.energy = 0;
  _iterate.criterion = _iterate.number == 1 ? 1 : 0;
  for (std::size_t s = 0; s < _sides.size(); ++s) {
    Side& side = _sides[s];
    Eigen::VectorXd& trace = _iterate.trace[s];
    side.previous_trace.swap(trace);
    _problem.operators()[s].flexibility()->apply(side.force, side.reduced, side.skeleton, trace);

    const ddm::CondensedLoad& load = _loads[s];
    const double trace_energy = trace.dot(side.force);  // t'S t
    _iterate.energy += trace_energy / 2 - load.g.dot(trace) + load.energy_constant;
    if (_iterate.number > 1) {
      const double norm = trace_energy - 2 * load.g_boundary.dot(trace) + load.norm_constant;
      const double change =
          (trace - side.previous_trace).dot(side.force - side.previous_force);  // d'S d
      _iterate.criterion = std::max(_iterate.criterion, ratio(std::max(change, 0.0), norm));
    }
  }
}

TraceState Uzawa::state() const {
  return {_iterate.trace,        fluxes(_problem.operators(), _loads, _iterate.trace),
          _iterate.displacement, _iterate.mu,
          _pair_force,           _iterate.jump};
}

}  // namespace anticrack::contact
