// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/warm_lcp.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "contact/trace_state.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// If more nodes than `far_off` change in the first step, coarse problems give a better start than
/// the last set. Not worth while for `small` problems.
constexpr Index far_off = 8, small = 128;

}  // namespace

WarmLcp::WarmLcp(const DenseLcp& lcp, int max_steps, std::span<const char> start,
                 const NestedStart* nested, double tolerance)
    : _lcp(lcp),
      _nested(lcp.size() > small ? nested : nullptr),
      _max_steps(max_steps),
      _tolerance(std::max(tolerance, lcp_rounding)),
      _closed(start.begin(), start.end()) {
  if (_closed.size() < at(lcp.size())) _closed.resize(at(lcp.size()), 1);
  _closed.resize(at(lcp.conditions()), 0);
  _pressed.resize(_closed.size(), 0);
  _met.reserve(_closed.size());
  _open.reserve(lcp.size());
  for (VectorXd* vector : {&_r, &_d, &_force, &_jump}) vector->setZero(lcp.size());
  _pressure.setZero(lcp.conditions());
}

LcpStatus WarmLcp::solve_with_rows(const VectorXd& r, const VectorXd& magnitude) {
  LcpOptions options;
  options.max_steps = _max_steps;
  options.tolerance = _tolerance;
  LcpAnswer answer =
      _lcp.solve(r, magnitude, options, _closed, [](const LcpStep&) { return true; });
  _steps = answer.steps;
  if (answer.status != LcpStatus::solved) return answer.status;
  _closed = std::move(answer.closed);
  _pressed = std::move(answer.pressed);
  _jump = answer.d.head(_lcp.size());
  _pressure = std::move(answer.lambda);
  const auto scale = _lcp.scale().head(_lcp.size());
  _d = _jump.cwiseQuotient(scale);
  const VectorXd force = (_lcp.scaled_matrix() * _d).cwiseQuotient(scale) - r;
  const double size = std::max(largest(magnitude), largest(_pressure));
  const double error =
      (_lcp.split(force, _closed).cwiseMax(0.0) - _pressure).lpNorm<Eigen::Infinity>();
  _residual = error == 0 ? 0 : error / size;
  return LcpStatus::solved;
}

LcpStatus WarmLcp::solve(const VectorXd& r, const VectorXd& magnitude) {
  if (_lcp.conditions() > _lcp.size()) return solve_with_rows(r, magnitude);
  const double largest =
      r.size() == 0 ? 0 : _lcp.scale().cwiseProduct(magnitude).lpNorm<Eigen::Infinity>();
  const double unit = largest > 0 ? largest : 1;
  _r = _lcp.scale().cwiseProduct(r) / unit;
  _steps = 0;
  const LcpStatus status = find_set(r, magnitude);
  if (status == LcpStatus::solved) finish(magnitude, unit);
  return status;
}

LcpStatus WarmLcp::find_set(const VectorXd& r, const VectorXd& magnitude) {
  _met.clear();
  for (;;) {
    if (!factorise()) return start_over(r, magnitude);
    solve_open();
    ++_steps;
    const Index changed = step();
    if (changed == 0) {
      close_undecided();
      return LcpStatus::solved;
    }
    if (_steps == 1 && changed > far_off && _nested != nullptr) {
      if (std::vector<char> closed = _nested->closed(r, magnitude); !closed.empty())
        _closed = std::move(closed);
    }
    if (_steps >= _max_steps) return LcpStatus::step_limit;
    // Brent's cycle detection: compare with the set of the last step whose number is a power of 2.
    if (_closed == _met) return start_over(r, magnitude);
    if (std::has_single_bit(static_cast<unsigned>(_steps))) _met = _closed;
  }
}

/// d for the open nodes that were factorised, and the force S d - r.
void WarmLcp::solve_open() {
  _open.solve(_r, _d);
  if (_open.empty()) {
    _force = -_r;
  } else {
    _force.noalias() = _lcp.scaled_matrix() * _d;
    _force -= _r;
  }
}

/// Changes the set; returns how many nodes changed.
Index WarmLcp::step() {
  Index changed = 0;
  for (Index i = 0; i < _d.size(); ++i) {
    char& closed = _closed[at(i)];
    if (closed == 0 ? _d[i] < -lcp_rounding : _force[i] < -lcp_rounding) {
      closed = closed == 0 ? 1 : 0;
      ++changed;
    }
  }
  return changed;
}

LcpStatus WarmLcp::start_over(const VectorXd& r, const VectorXd& magnitude) {
  LcpOptions options;
  options.max_steps = std::max(_max_steps - _steps, 1);
  const LcpAnswer answer =
      _lcp.solve(r, magnitude, options, {}, [](const LcpStep&) { return true; });
  _steps += answer.steps;
  if (answer.status == LcpStatus::solved) {
    _closed = answer.closed;
    factorise();
    solve_open();
  } else {
    std::fill(_closed.begin(), _closed.end(), char{1});
  }
  return answer.status;
}

/// Closes nodes that are open by rounding only, which makes the set unique.
void WarmLcp::close_undecided() {
  bool changed = false;
  for (Index i = 0; i < _d.size(); ++i) {
    if (_closed[at(i)] == 0 && _d[i] <= lcp_rounding) {
      _closed[at(i)] = 1;
      changed = true;
    }
  }
  if (changed) {
    factorise();
    solve_open();
  }
}

void WarmLcp::finish(const VectorXd& magnitude, double unit) {
  if (_d.size() > 0 && _d.minCoeff() < 0) {
    _d = _d.cwiseMax(0.0);
    _force.noalias() = _lcp.scaled_matrix() * _d;
    _force -= _r;
  }
  double error = 0, size = 0;
  for (Index i = 0; i < _d.size(); ++i) {
    const double lambda = _closed[at(i)] != 0 ? std::max(_force[i], 0.0) : 0;
    _pressed[at(i)] = lambda > _tolerance ? 1 : 0;
    const double to_force = unit / _lcp.scale()[i];
    _jump[i] = _lcp.scale()[i] * _d[i] * unit;
    _pressure[i] = lambda * to_force;
    error = std::max(error, std::abs(lambda - _force[i]) * to_force);
    size = std::max({size, magnitude[i], _pressure[i]});
  }
  _residual = error == 0 ? 0 : error / size;
}

}  // namespace anticrack::contact
