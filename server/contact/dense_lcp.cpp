// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/dense_lcp.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "contact/dense.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rounding = lcp_rounding;

/// One run on scaled data: unit diagonal, load of size 1.
class Run {
 public:
  Run(const MatrixXd& matrix, const VectorXd& r, const LcpOptions& options,
      std::span<const char> start, std::function<bool(const Run&)> on_step)
      : closed(start.begin(), start.end()),
        d(VectorXd::Zero(r.size())),
        lambda(-r),
        _matrix(matrix),
        _r(r),
        _options(options),
        _on_step(std::move(on_step)) {
    closed.resize(at(r.size()), 1);
  }

  LcpStatus solve() {
    const bool settled = !_options.monotone_only && primal_dual();
    if (!settled && !status) {
      fell_back = true;
      monotone();
    }
    if (!status) {
      close_undecided();
      status = LcpStatus::solved;
    }
    return *status;
  }

  std::vector<char> closed;
  VectorXd d, lambda;
  int steps = 0;
  bool fell_back = false;
  std::optional<LcpStatus> status;  ///< once the run has ended

  /// Factor for the nodes that are open now.
  const OpenFactor& factor() {
    _factor.factorise(_matrix, closed);
    return _factor;
  }
  OpenFactor take_factor() {
    factor();
    return std::move(_factor);
  }

 private:
  void set_multipliers() {
    multiply(_matrix, d, lambda);
    lambda -= _r;
    for (Index i = 0; i < lambda.size(); ++i) lambda[i] = closed[at(i)] == 0 ? 0 : lambda[i];
  }

  /// Counts and reports a step; false ends the run.
  bool report() {
    ++steps;
    if (!_on_step(*this)) status = LcpStatus::stopped;
    return !status;
  }

  bool may_go_on() {
    if (!status && steps >= _options.max_steps) status = LcpStatus::step_limit;
    return !status;
  }

  /// True when settled; false when a set recurs or S is singular on the open nodes.
  bool primal_dual() {
    std::set<std::vector<char>> met;
    while (met.insert(closed).second) {
      if (!factor().regular()) return false;
      d = factor().solve(_r);
      set_multipliers();
      std::vector<char> next = closed;
      for (Index i = 0; i < d.size(); ++i)
        if (closed[at(i)] == 0 && d[i] < -rounding)
          next[at(i)] = 1;
        else if (closed[at(i)] != 0 && lambda[i] < -rounding)
          next[at(i)] = 0;
      const bool settled = next == closed;
      if (!report() || settled) return settled;
      if (!may_go_on()) return false;
      closed = std::move(next);
    }
    return false;
  }

  double energy() const { return -_r.dot(d) / 2; }  // in the minimum over a face

  /// Moves d >= 0 to the minimum over the face of the open nodes, closing nodes whose d would turn
  /// negative, at least one a pass. S must be regular on the open nodes.
  void settle() {
    for (;;) {
      const VectorXd target = factor().solve(_r);
      double way = 1;
      for (Index i = 0; i < d.size(); ++i)
        if (closed[at(i)] == 0 && target[i] <= 0)
          way = std::min(way, d[i] <= 0 ? 0 : d[i] / (d[i] - target[i]));
      bool complete = true;
      for (Index i = 0; i < d.size(); ++i) {
        if (closed[at(i)] != 0) continue;
        const bool blocks = target[i] <= 0 && (d[i] <= 0 || d[i] / (d[i] - target[i]) <= way);
        d[i] = blocks ? 0 : d[i] + way * (target[i] - d[i]);
        closed[at(i)] = blocks ? 1 : 0;
        complete = complete && !blocks;
      }
      if (complete) {
        d = target;
        return;
      }
    }
  }

  void monotone() {
    d.setZero();
    if (!factor().regular()) std::fill(closed.begin(), closed.end(), char{1});
    settle();
    for (;;) {
      set_multipliers();
      if (!report()) return;
      Index first;
      if (lambda.size() == 0 || lambda.minCoeff(&first) >= -rounding) return;
      if (!may_go_on()) return;
      const std::vector<char> closed_before = closed;
      const VectorXd d_before = d;
      const double before = energy();
      for (Index i = 0; i < d.size(); ++i)
        closed[at(i)] = lambda[i] < -rounding ? 0 : closed[at(i)];
      if (factor().regular()) {
        settle();
        if (energy() < before) continue;
      }
      closed = closed_before;
      d = d_before;
      open_one(first);
      if (status) return;
      if (!(energy() < before)) {
        closed = closed_before;
        d = d_before;
        return;
      }
    }
  }

  void open_one(Index node) {
    const VectorXd against_node = factor().solve(_matrix.col(node));
    closed[at(node)] = 0;
    if (!factor().regular()) {
      // The energy falls linearly along this null direction, until an open node closes.
      VectorXd ray = -against_node;
      ray[node] = 1;
      Index blocking = -1;
      double way = std::numeric_limits<double>::infinity();
      for (Index i = 0; i < d.size(); ++i) {
        if (ray[i] < -rounding && -d[i] / ray[i] < way) {
          way = -d[i] / ray[i];
          blocking = i;
        }
      }
      if (blocking < 0) {
        status = LcpStatus::unbounded;
        return;
      }
      d = (d + way * ray).cwiseMax(0.0);
      d[blocking] = 0;
      closed[at(blocking)] = 1;
    }
    settle();
  }

  /// Closes nodes that are open by rounding only, which makes the set unique.
  void close_undecided() {
    bool changed = false;
    for (Index i = 0; i < d.size(); ++i) {
      if (closed[at(i)] == 0 && d[i] <= rounding) {
        closed[at(i)] = 1;
        changed = true;
      }
    }
    if (changed || fell_back) {
      d = factor().solve(_r);
      set_multipliers();
    }
    d = d.cwiseMax(0.0);
    lambda = lambda.cwiseMax(0.0);
  }

  const MatrixXd& _matrix;
  const VectorXd& _r;
  const LcpOptions& _options;
  std::function<bool(const Run&)> _on_step;
  OpenFactor _factor;
};

}  // namespace

DenseLcp::DenseLcp(MatrixXd matrix)
    : _scale(matrix.diagonal().cwiseSqrt().cwiseInverse()), _matrix(std::move(matrix)) {
  for (Index j = 0; j < _matrix.cols(); ++j)
    for (Index i = 0; i < _matrix.rows(); ++i) _matrix(i, j) *= _scale[i] * _scale[j];
}

LcpAnswer DenseLcp::solve(const VectorXd& r, const VectorXd& magnitude, const LcpOptions& options,
                          std::span<const char> start, const OnStep& on_step) const {
  const VectorXd& terms = magnitude.size() == 0 ? r : magnitude;
  const double largest = size() == 0 ? 0 : _scale.cwiseProduct(terms).lpNorm<Eigen::Infinity>();
  const double unit = largest > 0 ? largest : 1;
  const VectorXd scaled = _scale.cwiseProduct(r) / unit;
  const auto jump = [&](const VectorXd& d) { return VectorXd(_scale.cwiseProduct(d) * unit); };
  const auto pressure = [&](const VectorXd& lambda) {
    return VectorXd(lambda.cwiseQuotient(_scale) * unit);
  };
  Run run(_matrix, scaled, options, start, [&](const Run& state) {
    return on_step({state.steps, state.closed, jump(state.d), pressure(state.lambda)});
  });
  LcpAnswer answer;
  answer.status = run.solve();
  answer.steps = run.steps;
  answer.fell_back = run.fell_back;
  answer.d = jump(run.d.cwiseMax(0.0));
  answer.lambda = pressure(run.lambda.cwiseMax(0.0));
  const double weak = std::max(options.tolerance, rounding);
  for (Index i = 0; i < size(); ++i) {
    answer.weakly_active += run.d[i] <= weak && run.lambda[i] <= weak ? 1 : 0;
    answer.pressed.push_back(run.lambda[i] > weak ? 1 : 0);
  }
  if (answer.status == LcpStatus::solved) answer.factor = run.take_factor();
  answer.closed = std::move(run.closed);
  return answer;
}

VectorXd DenseLcp::solve_open(const OpenFactor& open, const VectorXd& b) const {
  return _scale.cwiseProduct(open.solve(_scale.cwiseProduct(b)));
}

std::size_t DenseLcp::bytes() const noexcept {
  return sizeof(double) * at(_matrix.size() + _scale.size());
}

}  // namespace anticrack::contact
