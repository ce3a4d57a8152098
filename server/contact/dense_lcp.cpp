// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/dense_lcp.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "base/at.hpp"
#include "contact/nested_start.hpp"
#include "stop/stop.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rounding = lcp_rounding;

/// If more conditions than `far_off` change in the first step, coarse problems give a better start
/// than the last set. Not worth while for `small` problems.
constexpr Index far_off = 8, small = 128;

}  // namespace

DenseLcp::DenseLcp(MatrixXd matrix, std::vector<ddm::Terms> rows, VectorXd weights)
    : _matrix(std::move(matrix)),
      _scale(size() + static_cast<Index>(rows.size())),
      _conditions(size(), {}, {}) {
  _scale.head(size()) = _matrix.diagonal().cwiseSqrt().cwiseInverse();
  for (Index j = 0; j < _matrix.cols(); ++j)
    for (Index i = 0; i < _matrix.rows(); ++i) _matrix(i, j) *= _scale[i] * _scale[j];
  for (std::size_t k = 0; k < rows.size(); ++k) {
    double norm = 0;
    for (ddm::Term& term : rows[k]) {
      term.factor *= _scale[term.index];
      norm = std::hypot(norm, term.factor);
    }
    for (ddm::Term& term : rows[k]) term.factor /= norm;
    _scale[_conditions.row(k)] = norm;
  }
  if (weights.size() == 0) weights.setOnes(_scale.size());
  _conditions = {size(), std::move(rows), weights.cwiseQuotient(_scale.cwiseAbs2())};
}

LcpAnswer DenseLcp::solve(const VectorXd& r, const VectorXd& magnitude, const LcpOptions& options,
                          std::span<const char> start, const OnStep& on_step) const {
  LcpSequence once(*this, options, start);
  once.solve(r, magnitude, on_step);
  return std::move(once).take();
}

VectorXd DenseLcp::solve_open(const OpenFactor& open, const VectorXd& b) const {
  const auto of_nodes = _scale.head(size());
  return of_nodes.cwiseProduct(open.solve(of_nodes.cwiseProduct(b)));
}

VectorXd DenseLcp::apply(const VectorXd& d) const {
  const auto of_nodes = _scale.head(size());
  VectorXd result(d.size());
  multiply(_matrix, d.cwiseQuotient(of_nodes), result);
  return result.cwiseQuotient(of_nodes);
}

std::size_t DenseLcp::bytes() const noexcept {
  return sizeof(double) * at(_matrix.size() + 2 * _scale.size());
}

LcpSequence::LcpSequence(const DenseLcp& lcp, const LcpOptions& options,
                         std::span<const char> start, const NestedStart* nested,
                         OpenResponses* responses)
    : _lcp(lcp),
      _matrix(lcp.scaled_matrix()),
      _conditions(lcp.scaled_conditions()),
      _nested(lcp.size() > small && options.tied.empty() ? nested : nullptr),
      _options(options) {
  _closed.assign(start.begin(), start.end());
  if (_closed.size() < at(lcp.size())) _closed.resize(at(lcp.size()), 1);
  _closed.resize(at(lcp.conditions()), 0);
  _met.reserve(_closed.size());
  _answer.pressed.resize(_closed.size(), 0);
  _answer.factor.reserve(lcp.size());
  _r.setZero(lcp.size());
  for (VectorXd* vector : {&_d, &_force, &_lambda, &_answer.d, &_answer.lambda})
    vector->setZero(lcp.conditions());
  if (responses != nullptr && responses->pay() && _conditions.rows().empty() &&
      options.tied.empty())
    _responses = responses;
  close_tied();
}

void LcpSequence::close_tied() {
  for (Index i = 0; i < nodes(); ++i)
    if (tied(i)) _closed[at(i)] = 1;
}

const LcpAnswer& LcpSequence::solve(const VectorXd& r, const VectorXd& magnitude,
                                    const OnStep& on_step, const VectorXd& coefficients) {
  _given = {&r, magnitude.size() == 0 ? &r : &magnitude, &on_step};
  const auto scale = _lcp.scale().head(nodes());
  const double largest =
      nodes() == 0 ? 0 : scale.cwiseProduct(*_given.magnitude).lpNorm<Eigen::Infinity>();
  _unit = largest > 0 ? largest : 1;
  _r = scale.cwiseProduct(r) / _unit;
  if (_responses != nullptr) _coefficients = coefficients / _unit;
  _d.setZero();
  if (_answer.status == LcpStatus::unbounded) close_all();
  _answer.steps = 0;
  _answer.fell_back = false;
  _ended.reset();
  _answer.status = find_set();
  if (_answer.status == LcpStatus::solved) close_undecided();
  finish();
  return _answer;
}

void LcpSequence::close_all() {
  std::fill_n(_closed.begin(), nodes(), char{1});
  std::fill(_closed.begin() + nodes(), _closed.end(), char{0});
}

LcpStatus LcpSequence::find_set() {
  if (!_options.monotone_only) {
    const bool all_closed = std::count(_closed.begin(), _closed.begin() + nodes(), 0) == 0;
    bool settled = primal_dual();
    if (!settled && !_ended && !all_closed) {
      close_all();
      settled = primal_dual();
    }
    if (settled || _ended) return _ended.value_or(LcpStatus::solved);
  }
  _answer.fell_back = true;
  if (_conditions.rows().empty())
    monotone();
  else
    one_by_one();
  return _ended.value_or(LcpStatus::solved);
}

/// Factorises for the nodes that are open now.
const OpenFactor& LcpSequence::factor() {
  stop::look("solving for contact");
  _answer.factor.factorise(_matrix, _conditions.rows(), _closed);
  return _answer.factor;
}

/// Computes d for the present set, and with responses _force; returns false if S is singular on its
/// open nodes.
bool LcpSequence::solve_open() {
  if (_responses != nullptr) {
    const auto response = _responses->of(_closed, _matrix, _lcp.scale(), _answer.factor);
    if (!response->regular) return false;
    _d.noalias() = response->d.lazyProduct(_coefficients);
    _force.noalias() = response->force.lazyProduct(_coefficients);
    return true;
  }
  if (!factor().regular()) return false;
  _answer.factor.solve(_r, _d.head(nodes()));
  _conditions.add_rows(_d);
  apply();
  return true;
}

/// Writes S d - r into _force.
void LcpSequence::apply() {
  if (std::find(_closed.begin(), _closed.begin() + nodes(), 0) == _closed.begin() + nodes()) {
    _force.head(nodes()) = -_r;
  } else {
    multiply(_matrix, _d.head(nodes()), _force.head(nodes()));
    _force.head(nodes()) -= _r;
  }
}

void LcpSequence::set_multipliers() {
  apply();
  share_forces();
}

/// Multipliers of the present set from _force.
void LcpSequence::share_forces() {
  _conditions.split(_closed, _force);
  for (Index i = 0; i < _force.size(); ++i)
    _lambda[i] = _closed[at(i)] == 0 || tied(i) ? 0 : _force[i];
}

/// Multipliers for the method that frees one condition at a time. Rows whose contacts are all
/// closed are not in its set and have none.
void LcpSequence::set_multipliers_of_set() {
  apply();
  _force.tail(_force.size() - nodes()).setZero();
  for (std::size_t k = 0; k < _conditions.rows().size(); ++k) {
    if (_closed[at(_conditions.row(k))] == 0 || !_conditions.any_open(k, _closed)) continue;
    const double nu = _conditions.balancing(k, _closed, _force);
    _force[_conditions.row(k)] = nu;
    for (const ddm::Term& term : _conditions.rows()[k]) _force[term.index] -= nu * term.factor;
  }
  for (Index i = 0; i < _force.size(); ++i)
    _lambda[i] = i < nodes() && (_closed[at(i)] == 0 || tied(i)) ? 0 : _force[i];
}

/// Counts and reports a step; returns false if the run is to end.
bool LcpSequence::report() {
  ++_answer.steps;
  if (*_given.on_step) {
    const VectorXd d = _lcp.scale().cwiseProduct(_d) * _unit,
                   lambda = _lambda.cwiseQuotient(_lcp.scale()) * _unit;
    if (!(*_given.on_step)({_answer.steps, _closed, d, lambda})) _ended = LcpStatus::stopped;
  }
  return !_ended;
}

bool LcpSequence::may_go_on() {
  if (!_ended && _answer.steps >= _options.max_steps) _ended = LcpStatus::step_limit;
  return !_ended;
}

/// Returns true when settled, false when a set recurs or S is singular on the open nodes.
bool LcpSequence::primal_dual() {
  _met.clear();
  for (unsigned step = 1;; ++step) {
    _conditions.close_rows_without_open_contacts(_closed);
    if (!solve_open()) return false;
    share_forces();
    const Index changed = find_next();
    if (!report() || changed == 0) return changed == 0;
    if (!may_go_on()) return false;
    _closed.swap(_next);
    if (_answer.steps == 1 && changed > far_off && _nested != nullptr) {
      if (const std::vector<char> start = _nested->closed(*_given.r, *_given.magnitude);
          !start.empty()) {
        close_all();
        std::copy(start.begin(), start.end(), _closed.begin());
      }
    }
    // Brent: compare with the set after the last step whose number is a power of 2.
    if (_closed == _met) return false;
    if (std::has_single_bit(step)) _met = _closed;
  }
}

/// Writes the next set into _next; returns how many conditions change.
Index LcpSequence::find_next() {
  _next = _closed;
  Index changed = 0;
  for (Index i = 0; i < _d.size(); ++i) {
    if (_closed[at(i)] == 0 ? _d[i] < -rounding : _lambda[i] < -rounding) {
      _next[at(i)] = _closed[at(i)] == 0 ? 1 : 0;
      ++changed;
    }
  }
  return changed;
}

/// Moves d >= 0 to the minimum over the face of the open nodes, closing nodes whose d would turn
/// negative, at least one a pass. S must be regular on the open nodes.
void LcpSequence::settle() {
  for (;;) {
    const VectorXd target = factor().solve(_r);
    double way = 1;
    for (Index i = 0; i < _d.size(); ++i)
      if (_closed[at(i)] == 0 && target[i] <= 0)
        way = std::min(way, _d[i] <= 0 ? 0 : _d[i] / (_d[i] - target[i]));
    bool complete = true;
    for (Index i = 0; i < _d.size(); ++i) {
      if (_closed[at(i)] != 0) continue;
      const bool blocks = target[i] <= 0 && (_d[i] <= 0 || _d[i] / (_d[i] - target[i]) <= way);
      _d[i] = blocks ? 0 : _d[i] + way * (target[i] - _d[i]);
      _closed[at(i)] = blocks ? 1 : 0;
      complete = complete && !blocks;
    }
    if (complete) {
      _d = target;
      return;
    }
  }
}

void LcpSequence::monotone() {
  _d.setZero();
  if (!factor().regular()) std::fill(_closed.begin(), _closed.end(), char{1});
  settle();
  for (;;) {
    set_multipliers();
    if (!report()) return;
    Index first;
    if (_lambda.size() == 0 || _lambda.minCoeff(&first) >= -rounding) return;
    if (!may_go_on()) return;
    const std::vector<char> closed_before = _closed;
    const VectorXd d_before = _d;
    const double before = energy();
    for (Index i = 0; i < _d.size(); ++i)
      _closed[at(i)] = _lambda[i] < -rounding ? 0 : _closed[at(i)];
    if (factor().regular()) {
      settle();
      if (energy() < before) continue;
    }
    _closed = closed_before;
    _d = d_before;
    open_one(first);
    if (_ended) return;
    if (!(energy() < before)) {
      _closed = closed_before;
      _d = d_before;
      return;
    }
  }
}

void LcpSequence::open_one(Index node) {
  const VectorXd against_node = factor().solve(_matrix.col(node));
  _closed[at(node)] = 0;
  if (!factor().regular()) {
    // The energy falls linearly along this null direction, until an open node closes.
    VectorXd ray = -against_node;
    ray[node] = 1;
    Index blocking = -1;
    double way = std::numeric_limits<double>::infinity();
    for (Index i = 0; i < _d.size(); ++i) {
      if (ray[i] < -rounding && -_d[i] / ray[i] < way) {
        way = -_d[i] / ray[i];
        blocking = i;
      }
    }
    if (blocking < 0) {
      _ended = LcpStatus::unbounded;
      return;
    }
    _d = (_d + way * ray).cwiseMax(0.0);
    _d[blocking] = 0;
    _closed[at(blocking)] = 1;
  }
  settle();
}

/// Moves to the minimum with the closed conditions as equalities, without violating an open one.
void LcpSequence::one_by_one() {
  close_all();
  _d.setZero();
  while (may_go_on()) {
    if (!factor().regular()) {
      _ended = LcpStatus::unbounded;
      return;
    }
    const VectorXd from = _d;
    solve_open();
    const Index blocking = go_towards(from);
    if (blocking >= 0) {
      _closed[at(blocking)] = 1;
      ++_answer.steps;
      continue;
    }
    set_multipliers_of_set();
    if (!report()) return;
    const auto pulled = std::find_if(_lambda.begin(), _lambda.end(),
                                     [](double value) { return value < -rounding; });
    if (pulled == _lambda.end()) break;
    _closed[at(pulled - _lambda.begin())] = 0;
  }
}

/// Shortens the way from `from` to d if an open condition blocks it; returns that condition, or -1.
Index LcpSequence::go_towards(const VectorXd& from) {
  double way = 1;
  Index blocking = -1;
  for (Index i = 0; i < _d.size(); ++i) {
    const bool moves = i < nodes() || _conditions.any_open(at(i - nodes()), _closed);
    if (_closed[at(i)] != 0 || !moves || _d[i] >= 0 || _d[i] >= from[i]) continue;
    const double here = std::max(from[i], 0.0) / (from[i] - _d[i]);
    if (here < way) {
      way = here;
      blocking = i;
    }
  }
  if (blocking >= 0) {
    _d = from + way * (_d - from);
    _conditions.add_rows(_d);
  }
  return blocking;
}

/// Closes nodes that are open by rounding only, which makes the set unique.
void LcpSequence::close_undecided() {
  bool changed = false;
  for (Index i = 0; i < _d.size(); ++i) {
    if (_closed[at(i)] == 0 && _d[i] <= rounding) {
      _closed[at(i)] = 1;
      changed = true;
    }
  }
  _conditions.close_rows_without_open_contacts(_closed);
  if (changed || _answer.fell_back) {
    solve_open();
    share_forces();
  }
  if (nodes() > 0 && _d.head(nodes()).minCoeff() < 0) {
    _d = _d.cwiseMax(0.0);
    _conditions.add_rows(_d);
    set_multipliers();
  }
  if (_responses == nullptr) factor();  // which now has the rows closed above
}

void LcpSequence::finish() {
  const double weak = std::max(_options.tolerance, rounding);
  double error = 0, size = 0;
  _answer.weakly_active = 0;
  for (Index i = 0; i < _d.size(); ++i) {
    const double d = std::max(_d[i], 0.0), lambda = std::max(_lambda[i], 0.0);
    const double to_force = _unit / _lcp.scale()[i];
    _answer.d[i] = _lcp.scale()[i] * d * _unit;
    _answer.lambda[i] = lambda * to_force;
    _answer.pressed[at(i)] = lambda > weak ? 1 : 0;
    _answer.weakly_active += _d[i] <= weak && _lambda[i] <= weak && !tied(i) ? 1 : 0;
    size = std::max(size, _answer.lambda[i]);
    if (i >= nodes() || tied(i)) continue;
    error = std::max(error, std::abs(lambda - _force[i]) * to_force);
    size = std::max(size, (*_given.magnitude)[i]);
  }
  _answer.residual = error == 0 ? 0 : error / size;
}

}  // namespace anticrack::contact
