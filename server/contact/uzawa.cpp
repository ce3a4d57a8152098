// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/uzawa.hpp"

#include <algorithm>

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

double ratio(double value, double scale) {
  return value == 0 ? 0 : value / scale;
}

}  // namespace

Uzawa::Uzawa(const TraceProblem& problem, Mass mass, int capacity)
    : _problem(problem), _mass(mass), _columns(index(capacity)) {
  _mu = _jump = _pair_force = _change = MatrixXd::Zero(problem.pair_count(), capacity);
  for (const ddm::SubdomainOperator& subdomain : problem.operators()) {
    const ddm::Flexibility& flexibility = *subdomain.flexibility();
    const MatrixXd trace = MatrixXd::Zero(flexibility.trace_size(), capacity);
    const MatrixXd skeleton = MatrixXd::Zero(flexibility.skeleton_size(), capacity);
    _sides.push_back({trace, trace, trace, trace, skeleton, skeleton});
    _unbalanced.emplace_back(flexibility.trace_size());
  }
  for (std::size_t s = 0; s < _sides.size(); ++s) {
    const std::vector<std::int32_t>& rigid = problem.decomposition().subdomains[s].rigid;
    for (std::size_t i = 0; i < rigid.size(); ++i) {
      if (rigid[i] >= 0) {
        _inclusions.resize(std::max(_inclusions.size(), at(rigid[i]) + 1));
        _inclusions[at(rigid[i])] = {s, static_cast<Index>(i)};
      }
    }
  }
  _on_inclusion.resize(static_cast<Index>(_inclusions.size()));
}

void Uzawa::start(int column, std::span<const ddm::CondensedLoad> loads, double theta, double p) {
  _columns[index(column)] = {loads, theta, p, {}};
  for (MatrixXd* values : {&_mu, &_jump, &_pair_force, &_change}) {
    values->col(column).setZero();
  }
  for (Side& side : _sides) {
    side.trace.col(column).setZero();
    side.force.col(column).setZero();
  }
}

void Uzawa::exchange(int a, int b) {
  if (a == b) {
    return;
  }
  std::swap(_columns[index(a)], _columns[index(b)]);
  for (MatrixXd* values : {&_mu, &_jump, &_pair_force, &_change}) {
    values->col(a).swap(values->col(b));
  }
  for (Side& side : _sides) {
    side.trace.col(a).swap(side.trace.col(b));
    side.force.col(a).swap(side.force.col(b));
  }
}

void Uzawa::step(int columns) {
  for (int c = 0; c < columns; ++c) {
    update_multipliers(c);
    Iterate& iterate = _columns[index(c)].iterate;
    ++iterate.number;
    iterate.criterion = iterate.number == 1 ? 1 : 0;
    iterate.energy = 0;
  }
  apply_forces(columns);
  for (std::size_t s = 0; s < _sides.size(); ++s) {
    solve_side(s, columns);
    for (int c = 0; c < columns; ++c) {
      measure(s, c);
    }
  }
  for (int c = 0; c < columns; ++c) {
    measure_jump(c);
  }
}

/// Changes nothing before the first iteration: there mu and the jump are zero.
void Uzawa::update_multipliers(int c) {
  Column& column = _columns[index(c)];
  const auto& pairs = _problem.decomposition().pairs;
  auto mu = _mu.col(c), change = _change.col(c);
  const auto jump = _jump.col(c);
  const Eigen::VectorXd& mass = _problem.lumped_mass();
  double turn = 0;
  for (Index i = 0; i < mu.size(); ++i) {
    const bool unilateral = pairs[static_cast<std::size_t>(i)].unilateral();
    const double next =
        std::clamp(mu[i] - column.theta * jump[i], unilateral ? 0.0 : -column.p, column.p);
    const double step = next - mu[i];
    turn += mass[i] * step * change[i];
    change[i] = step;
    mu[i] = next;
  }
  column.iterate.turned = turn < 0;
}

void Uzawa::apply_forces(int columns) {
  _problem.apply_mass(_mass, _mu.leftCols(columns), _pair_force.leftCols(columns));
  for (std::size_t s = 0; s < _sides.size(); ++s) {
    Side& side = _sides[s];
    side.previous_force.leftCols(columns) = side.force.leftCols(columns);
    for (int c = 0; c < columns; ++c) {
      side.force.col(c) = _columns[index(c)].loads[s].g;
    }
  }
  const auto& pairs = _problem.decomposition().pairs;
  for (int c = 0; c < columns; ++c) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double force = _pair_force(static_cast<Index>(i), c);
      _sides[at(pairs[i].minus)].force(pairs[i].minus_trace, c) -= force;
      _sides[at(pairs[i].plus)].force(pairs[i].plus_trace, c) += force;
    }
  }
}

void Uzawa::solve_side(std::size_t s, int columns) {
  Side& side = _sides[s];
  side.previous_trace.leftCols(columns) = side.trace.leftCols(columns);
  _problem.operators()[s].flexibility()->apply(
      side.force.leftCols(columns), side.reduced.leftCols(columns), side.skeleton.leftCols(columns),
      side.trace.leftCols(columns));
}

void Uzawa::measure(std::size_t s, int c) {
  const Side& side = _sides[s];
  const ddm::CondensedLoad& load = _columns[index(c)].loads[s];
  Iterate& iterate = _columns[index(c)].iterate;
  const auto trace = side.trace.col(c), force = side.force.col(c);
  const double trace_energy = trace.dot(force);  // t'S t
  iterate.energy += trace_energy / 2 - load.g.dot(trace) + load.energy_constant;
  if (iterate.number > 1) {
    const double norm = trace_energy - 2 * load.g_boundary.dot(trace) + load.norm_constant;
    const double change =
        (trace - side.previous_trace.col(c)).dot(force - side.previous_force.col(c));  // d'S d
    iterate.criterion = std::max(iterate.criterion, ratio(std::max(change, 0.0), norm));
  }
}

void Uzawa::measure_jump(int c) {
  const auto& pairs = _problem.decomposition().pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const ddm::NodePair& pair = pairs[i];
    _jump(static_cast<Index>(i), c) = _sides[at(pair.plus)].trace(pair.plus_trace, c) -
                                      _sides[at(pair.minus)].trace(pair.minus_trace, c);
  }
}

double Uzawa::equilibrium(int column) {
  for (std::size_t s = 0; s < _sides.size(); ++s) {
    _problem.operators()[s].factor().apply_schur(_sides[s].trace.col(column), _unbalanced[s]);
    _unbalanced[s] -= _sides[s].force.col(column);
  }
  return largest_unbalanced(_problem.decomposition(), _unbalanced, _on_inclusion);
}

Scales Uzawa::scales(int column) const {
  Scales result{largest(_pair_force.col(column)), 0, largest(_mu.col(column))};
  for (std::size_t s = 0; s < _sides.size(); ++s) {
    result.force = std::max(result.force, largest(_columns[index(column)].loads[s].g));
    result.trace = std::max(result.trace, largest(_sides[s].trace.col(column)));
  }
  return result;
}

TraceState Uzawa::state(int column) const {
  const std::span<const ddm::CondensedLoad> loads = _columns[index(column)].loads;
  TraceState state;
  for (const Side& side : _sides) {
    state.trace.emplace_back(side.trace.col(column));
  }
  state.flux = fluxes(_problem.operators(), loads, state.trace);
  state.displacement.resize(static_cast<Index>(_inclusions.size()));
  for (std::size_t j = 0; j < _inclusions.size(); ++j) {
    state.displacement[static_cast<Index>(j)] = displacement(column, j);
  }
  state.mu = _mu.col(column);
  state.force = _pair_force.col(column);
  state.jump = _jump.col(column);
  return state;
}

}  // namespace anticrack::contact
