// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/uzawa.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace anticrack::contact {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

/// The default tolerance of weakly active nodes, see ActiveSetOptions.
constexpr double weak_pressure = 1e-12;

}  // namespace

Uzawa::Uzawa(const TraceProblem& problem, Mass mass, int capacity)
    : _problem(problem), _mass(mass), _columns(index(capacity)) {
  const ddm::Decomposition& decomposition = problem.decomposition();
  Index rows = 0;
  for (std::size_t s = 0; s < problem.operators().size(); ++s) {
    const ddm::Flexibility& flexibility = *problem.operators()[s].flexibility();
    const MatrixXd skeleton = MatrixXd::Zero(flexibility.skeleton_size(), capacity);
    _sides.push_back({rows, flexibility.trace_size(), skeleton, skeleton});
    _unbalanced.emplace_back(flexibility.trace_size());
    const std::vector<std::int32_t>& rigid = decomposition.subdomains[s].rigid;
    for (std::size_t i = 0; i < rigid.size(); ++i) {
      if (rigid[i] >= 0) {
        _inclusion_row.resize(std::max(_inclusion_row.size(), at(rigid[i]) + 1));
        _inclusion_row[at(rigid[i])] = rows + static_cast<Index>(i);
      }
    }
    rows += flexibility.trace_size();
  }
  _pairs.reserve(decomposition.pairs.size());
  for (const ddm::NodePair& pair : decomposition.pairs) {
    const auto row = [this](std::int32_t subdomain, std::int32_t trace) {
      return _sides[at(subdomain)].first + trace;
    };
    _pairs.push_back(
        {row(pair.minus, pair.minus_trace), row(pair.plus, pair.plus_trace), pair.unilateral()});
  }
  _mu = _jump = _pair_force = _change = MatrixXd::Zero(problem.pair_count(), capacity);
  _g = _trace = _force = _previous_trace = _previous_force = MatrixXd::Zero(rows, capacity);
  _on_motions.resize(static_cast<Index>(decomposition.skeleton.free));
}

void Uzawa::start(int column, std::span<const ddm::CondensedLoad> loads, double theta, double p) {
  _columns[index(column)] = {loads, theta, p, {}};
  for (MatrixXd* values : {&_mu, &_jump, &_pair_force, &_change, &_trace, &_force})
    values->col(column).setZero();
  for (std::size_t s = 0; s < _sides.size(); ++s)
    _g.col(column).segment(_sides[s].first, _sides[s].size) = loads[s].g;
}

void Uzawa::exchange(int a, int b) {
  if (a == b) return;
  std::swap(_columns[index(a)], _columns[index(b)]);
  for (MatrixXd* values : {&_mu, &_jump, &_pair_force, &_change, &_g, &_trace, &_force})
    values->col(a).swap(values->col(b));
}

void Uzawa::step(int columns) {
  for (int c = 0; c < columns; ++c) {
    update_multipliers(c);
    ++_columns[index(c)].iterate.number;
  }
  apply_forces(columns);
  solve_sides(columns);
  for (int c = 0; c < columns; ++c) {
    measure(c);
    measure_jump(c);
  }
}

/// Changes nothing before the first iteration, where mu and the jump are zero.
void Uzawa::update_multipliers(int c) {
  Column& column = _columns[index(c)];
  const Eigen::VectorXd& mass = _problem.lumped_mass();
  auto mu = _mu.col(c), change = _change.col(c);
  const auto jump = _jump.col(c);
  double turn = 0;
  for (Index i = 0; i < mu.size(); ++i) {
    const double lower = _pairs[at(i)].unilateral ? 0.0 : -column.p;
    const double next = std::clamp(mu[i] - column.theta * jump[i], lower, column.p);
    const double step = next - mu[i];
    turn += mass[i] * step * change[i];
    change[i] = step;
    mu[i] = next;
  }
  column.iterate.turned = turn < 0;
}

void Uzawa::apply_forces(int columns) {
  _problem.apply_mass(_mass, _mu.leftCols(columns), _pair_force.leftCols(columns));
  _previous_force.leftCols(columns) = _force.leftCols(columns);
  _force.leftCols(columns) = _g.leftCols(columns);
  for (int c = 0; c < columns; ++c) {
    auto force = _force.col(c);
    const auto of_pair = _pair_force.col(c);
    for (Index i = 0; i < of_pair.size(); ++i) {
      const Pair& pair = _pairs[at(i)];
      force[pair.minus] -= of_pair[i];
      force[pair.plus] += of_pair[i];
    }
  }
}

void Uzawa::solve_sides(int columns) {
  _previous_trace.leftCols(columns) = _trace.leftCols(columns);
  for (std::size_t s = 0; s < _sides.size(); ++s) {
    Side& side = _sides[s];
    _problem.operators()[s].flexibility()->apply(
        _force.block(side.first, 0, side.size, columns), side.reduced.leftCols(columns),
        side.skeleton.leftCols(columns), _trace.block(side.first, 0, side.size, columns));
  }
}

void Uzawa::measure(int c) {
  Column& column = _columns[index(c)];
  Iterate& iterate = column.iterate;
  iterate.energy = iterate.size = 0;
  iterate.criterion = iterate.number == 1 ? 1 : 0;
  for (std::size_t s = 0; s < _sides.size(); ++s) {
    const Index first = _sides[s].first, size = _sides[s].size;
    const ddm::CondensedLoad& load = column.loads[s];
    const auto trace = _trace.col(c).segment(first, size);
    const auto force = _force.col(c).segment(first, size);
    const double trace_energy = trace.dot(force);  // t'S t
    iterate.energy += trace_energy / 2 - load.g.dot(trace) + load.energy_constant;
    const double norm = trace_energy - 2 * load.g_boundary.dot(trace) + load.norm_constant;
    const double tension = _problem.decomposition().subdomains[s].tension.mean;
    iterate.size = std::max(iterate.size, std::sqrt(std::max(norm, 0.0) / tension));
    if (iterate.number > 1) {
      const double change = (trace - _previous_trace.col(c).segment(first, size))
                                .dot(force - _previous_force.col(c).segment(first, size));  // d'S d
      iterate.criterion = std::max(iterate.criterion, ratio(std::max(change, 0.0), norm));
    }
  }
}

void Uzawa::measure_jump(int c) {
  const auto trace = _trace.col(c);
  auto jump = _jump.col(c);
  for (Index i = 0; i < jump.size(); ++i) {
    const Pair& pair = _pairs[at(i)];
    jump[i] = trace[pair.plus] - trace[pair.minus];
  }
}

double Uzawa::equilibrium(int column) {
  for (std::size_t s = 0; s < _sides.size(); ++s) {
    _problem.operators()[s].factor().apply_schur(trace(column, s), _unbalanced[s]);
    _unbalanced[s] -= _force.col(column).segment(_sides[s].first, _sides[s].size);
  }
  return largest_unbalanced(_problem.decomposition(), _unbalanced, _on_motions);
}

Scales Uzawa::scales(int column) const {
  return {std::max(largest(_pair_force.col(column)), largest(_g.col(column))),
          largest(_trace.col(column)), largest(_mu.col(column))};
}

int Uzawa::held_at_bound(int column) const {
  constexpr double rounding = 1e-9;  // of the largest trace
  const double p = _columns[index(column)].p;
  const double tolerance = rounding * largest(_trace.col(column));
  int count = 0;
  for (Index i = 0; i < _mu.rows(); ++i) {
    const double mu = _mu(i, column), jump = _jump(i, column);
    const bool lower = !_pairs[at(i)].unilateral && mu <= -p && jump > tolerance;
    count += (mu >= p && jump < -tolerance) || lower ? 1 : 0;
  }
  return count;
}

TraceState Uzawa::state(int column) const {
  const std::span<const ddm::CondensedLoad> loads = _columns[index(column)].loads;
  TraceState state;
  for (std::size_t s = 0; s < _sides.size(); ++s) state.trace.emplace_back(trace(column, s));
  state.flux = fluxes(_problem.operators(), loads, state.trace);
  state.motion.setZero(3, static_cast<Index>(_inclusion_row.size()));
  for (std::size_t j = 0; j < _inclusion_row.size(); ++j)
    state.motion(0, static_cast<Index>(j)) = displacement(column, j);
  state.mu = _mu.col(column);
  state.force = _pair_force.col(column);
  state.jump = _jump.col(column);
  // A step of mu is theta times a jump; smaller ones come from rounding in traces that just touch.
  const double weak = weak_pressure * _problem.theta_star(_mass) * largest(_trace.col(column));
  for (std::size_t i = 0; i < _pairs.size(); ++i)
    state.contact.push_back(_pairs[i].unilateral && _mu(static_cast<Index>(i), column) > weak);
  return state;
}

}  // namespace anticrack::contact
