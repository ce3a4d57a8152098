// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/warm_lcp.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "contact/dense.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Where more nodes change than these, the load is another and the set before it says little: then
/// coarse problems are quicker than steps from there. Their steps cost as much as small problems'.
constexpr Index far_off = 8, small = 128;

}  // namespace

WarmLcp::WarmLcp(const DenseLcp& lcp, int max_steps, std::span<const char> start,
                 const NestedStart* nested)
    : _lcp(lcp),
      _nested(lcp.size() > small ? nested : nullptr),
      _max_steps(max_steps),
      _closed(start.begin(), start.end()),
      _factor(lcp.size() * lcp.size()) {
  _closed.resize(at(lcp.size()), 1);
  _met.reserve(_closed.size());
  _factored.reserve(_closed.size());
  _open.reserve(_closed.size());
  for (VectorXd* vector : {&_r, &_d, &_force, &_jump, &_pressure, &_right_hand_side}) {
    vector->setZero(lcp.size());
  }
}

LcpStatus WarmLcp::solve(const VectorXd& r, const VectorXd& magnitude) {
  const double largest =
      r.size() == 0 ? 0 : _lcp.scale().cwiseProduct(magnitude).lpNorm<Eigen::Infinity>();
  const double unit = largest > 0 ? largest : 1;
  _r = _lcp.scale().cwiseProduct(r) / unit;
  _steps = 0;
  const LcpStatus status = find_set(r, magnitude);
  if (status == LcpStatus::solved) {
    finish(r, unit);
  }
  return status;
}

/// The closed nodes, with d and the forces where nothing was in the way.
LcpStatus WarmLcp::find_set(const VectorXd& r, const VectorXd& magnitude) {
  _met.clear();
  for (;;) {
    if (!factorise()) {
      return start_over(r, magnitude);
    }
    solve_open();
    ++_steps;
    const Index changed = step();
    if (changed == 0) {
      close_undecided();
      return LcpStatus::solved;
    }
    if (_steps == 1 && changed > far_off && _nested != nullptr) {
      if (std::vector<char> closed = _nested->closed(r, magnitude); !closed.empty()) {
        _closed = std::move(closed);
      }
    }
    if (_steps >= _max_steps) {
      return LcpStatus::step_limit;
    }
    // Brent's way to see a circle: the set of the last step whose number is a power of two.
    if (_closed == _met) {
      return start_over(r, magnitude);
    }
    if (std::has_single_bit(static_cast<unsigned>(_steps))) {
      _met = _closed;
    }
  }
}

/// Of the open nodes, in increasing order. False where S is singular on them.
bool WarmLcp::factorise() {
  if (_factored == _closed && !_factored.empty()) {
    return _regular;
  }
  _factored = _closed;
  _open.clear();
  for (std::size_t i = 0; i < _closed.size(); ++i) {
    if (_closed[i] == 0) {
      _open.push_back(static_cast<Index>(i));
    }
  }
  const auto n = static_cast<Index>(_open.size());
  const MatrixXd& s = _lcp.scaled_matrix();
  Eigen::Map<MatrixXd> factor(_factor.data(), n, n);
  for (Index j = 0; j < n; ++j) {
    const double* from = s.col(_open[at(j)]).data();
    double* to = factor.col(j).data();
    for (Index i = j; i < n; ++i) {
      to[i] = from[_open[at(i)]];
    }
  }
  _regular = cholesky(factor) &&
             (n == 0 || regular_pivot(factor.diagonal().array().square().minCoeff(), n));
  return _regular;
}

/// d for the open nodes that were factorised, and the forces it takes.
void WarmLcp::solve_open() {
  const auto n = static_cast<Index>(_open.size());
  const Eigen::Map<const MatrixXd> factor(_factor.data(), n, n);
  Eigen::Map<VectorXd> x(_right_hand_side.data(), n);
  for (Index i = 0; i < n; ++i) {
    x[i] = _r[_open[at(i)]];
  }
  _d.setZero();
  if (n > 0) {
    solve_lower(factor, x);
    solve_lower_transposed(factor, x);
    for (Index i = 0; i < n; ++i) {
      _d[_open[at(i)]] = x[i];
    }
    _force.noalias() = _lcp.scaled_matrix() * _d;
    _force -= _r;
  } else {
    _force = -_r;
  }
}

/// The next set; how many nodes have changed.
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

/// A node that is open by rounding only is closed, for a unique set.
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

void WarmLcp::finish(const VectorXd& r, double unit) {
  if (_d.size() > 0 && _d.minCoeff() < 0) {
    _d = _d.cwiseMax(0.0);
    _force.noalias() = _lcp.scaled_matrix() * _d;
    _force -= _r;
  }
  double error = 0, size = 0;
  for (Index i = 0; i < _d.size(); ++i) {
    const double lambda = _closed[at(i)] != 0 ? std::max(_force[i], 0.0) : 0;
    const double to_force = unit / _lcp.scale()[i];
    _jump[i] = _lcp.scale()[i] * _d[i] * unit;
    _pressure[i] = lambda * to_force;
    error = std::max(error, std::abs(lambda - _force[i]) * to_force);
    size = std::max({size, std::abs(r[i]), _pressure[i]});
  }
  _residual = error == 0 ? 0 : error / size;
}

}  // namespace anticrack::contact
