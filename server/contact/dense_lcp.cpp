// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/dense_lcp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "contact/dense.hpp"
#include "mesh/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rounding = lcp_rounding;

/// All scaled: unit diagonal of S, rows of norm 1.
struct Problem {
  const MatrixXd& matrix;
  const std::vector<ddm::Terms>& rows;
  const VectorXd& weights;

  Index nodes() const { return matrix.rows(); }
  Index row(std::size_t k) const { return nodes() + static_cast<Index>(k); }
  bool any_open(std::size_t k, const std::vector<char>& closed) const {
    return std::ranges::any_of(
        rows[k], [&closed](const ddm::Term& term) { return closed[at(term.index)] == 0; });
  }

  /// Jumps of the rows below those of the nodes.
  void add_rows(VectorXd& jumps) const {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      jumps[row(k)] = 0;
      for (const ddm::Term& term : rows[k]) jumps[row(k)] += term.factor * jumps[term.index];
    }
  }

  /// lambda of nodes and rows from S d - r in the nodes. What a row carries is taken off its nodes.
  void split(const std::vector<char>& closed, VectorXd& lambda) const {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const bool open = any_open(k, closed);
      double nu = 0;
      if (open && closed[at(row(k))] != 0)
        nu = balancing(k, closed, lambda);
      else if (!open)
        nu = least(k, lambda);
      lambda[row(k)] = nu;
      for (const ddm::Term& term : rows[k]) lambda[term.index] -= nu * term.factor;
    }
  }

  /// The multiplier of a row that leaves none on its open nodes.
  double balancing(std::size_t k, const std::vector<char>& closed, const VectorXd& lambda) const {
    double sum = 0, size = 0;
    for (const ddm::Term& term : rows[k]) {
      if (closed[at(term.index)] != 0) continue;
      sum += term.factor * lambda[term.index];
      size += term.factor * term.factor;
    }
    return sum / size;
  }

 private:
  /// Of least weighted squares among those that leave no lambda below 0, if there are any.
  double least(std::size_t k, const VectorXd& lambda) const {
    double sum = 0, size = weights[row(k)], low = 0, high = std::numeric_limits<double>::infinity();
    for (const auto& [i, factor] : rows[k]) {
      sum += weights[i] * factor * lambda[i];
      size += weights[i] * factor * factor;
      (factor > 0 ? high : low) =
          factor > 0 ? std::min(high, lambda[i] / factor) : std::max(low, lambda[i] / factor);
    }
    return std::clamp(sum / size, low, std::max(low, high));
  }
};

/// One run on scaled data: load of size 1.
class Run {
 public:
  Run(const Problem& problem, const VectorXd& r, const LcpOptions& options,
      std::span<const char> start, std::function<bool(const Run&)> on_step)
      : closed(start.begin(), start.end()),
        d(VectorXd::Zero(problem.row(problem.rows.size()))),
        lambda(VectorXd::Zero(d.size())),
        _problem(problem),
        _r(r),
        _options(options),
        _on_step(std::move(on_step)) {
    lambda.head(r.size()) = -r;
    if (closed.size() < at(r.size())) closed.resize(at(r.size()), 1);
    closed.resize(at(d.size()), 0);
  }

  LcpStatus solve() {
    const bool settled = !_options.monotone_only && primal_dual();
    if (!settled && !status) {
      fell_back = true;
      if (_problem.rows.empty())
        monotone();
      else
        one_by_one();
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
    stop::look("solving for contact");
    _factor.factorise(_problem.matrix, _problem.rows, closed);
    return _factor;
  }
  OpenFactor take_factor() {
    factor();
    return std::move(_factor);
  }

 private:
  Index nodes() const { return _r.size(); }

  /// d from the set.
  void solve_open() {
    VectorXd of_nodes(nodes());
    factor().solve(_r, of_nodes);
    set_jumps(of_nodes);
  }
  void set_jumps(const VectorXd& of_nodes) {
    d.head(nodes()) = of_nodes;
    _problem.add_rows(d);
  }

  void set_multipliers() {
    multiply(_problem.matrix, d.head(nodes()), lambda.head(nodes()));
    lambda.head(nodes()) -= _r;
    _problem.split(closed, lambda);
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
    for (;;) {
      close_rows_without_open_nodes();
      if (!met.insert(closed).second) return false;
      if (!factor().regular()) return false;
      solve_open();
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
  }

  void close_rows_without_open_nodes() {
    for (std::size_t k = 0; k < _problem.rows.size(); ++k)
      if (!_problem.any_open(k, closed)) closed[at(_problem.row(k))] = 1;
  }

  double energy() const { return -_r.dot(d.head(nodes())) / 2; }  // in the minimum over a face

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
    const VectorXd against_node = factor().solve(_problem.matrix.col(node));
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

  /// To the minimum with the closed conditions as equalities, as far as no open one is violated.
  void one_by_one() {
    std::fill_n(closed.begin(), nodes(), char{1});
    std::fill(closed.begin() + nodes(), closed.end(), char{0});
    set_jumps(VectorXd::Zero(nodes()));
    while (may_go_on()) {
      if (!factor().regular()) {
        status = LcpStatus::unbounded;
        return;
      }
      const VectorXd from = d;
      solve_open();
      const Index blocking = go_towards(from);
      if (blocking >= 0) {
        closed[at(blocking)] = 1;
        ++steps;
        continue;
      }
      set_multipliers_of_set();
      if (!report()) return;
      const auto pulled = std::find_if(lambda.begin(), lambda.end(),
                                       [](double value) { return value < -rounding; });
      if (pulled == lambda.end()) break;
      closed[at(pulled - lambda.begin())] = 0;
    }
  }

  /// Shortens the way from `from` to d where an open condition blocks it; returns that, or -1.
  Index go_towards(const VectorXd& from) {
    double way = 1;
    Index blocking = -1;
    for (Index i = 0; i < d.size(); ++i) {
      const bool moves = i < nodes() || _problem.any_open(at(i - nodes()), closed);
      if (closed[at(i)] != 0 || !moves || d[i] >= 0 || d[i] >= from[i]) continue;
      const double here = std::max(from[i], 0.0) / (from[i] - d[i]);
      if (here < way) {
        way = here;
        blocking = i;
      }
    }
    if (blocking >= 0) set_jumps((from + way * (d - from)).head(nodes()));
    return blocking;
  }

  /// Rows that hold by themselves are not of the set and take nothing.
  void set_multipliers_of_set() {
    multiply(_problem.matrix, d.head(nodes()), lambda.head(nodes()));
    lambda.head(nodes()) -= _r;
    lambda.tail(lambda.size() - nodes()).setZero();
    for (std::size_t k = 0; k < _problem.rows.size(); ++k) {
      if (closed[at(_problem.row(k))] == 0 || !_problem.any_open(k, closed)) continue;
      const double nu = _problem.balancing(k, closed, lambda);
      lambda[_problem.row(k)] = nu;
      for (const ddm::Term& term : _problem.rows[k]) lambda[term.index] -= nu * term.factor;
    }
    for (Index i = 0; i < nodes(); ++i) lambda[i] = closed[at(i)] == 0 ? 0 : lambda[i];
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
    close_rows_without_open_nodes();
    if (changed || fell_back) {
      solve_open();
      set_multipliers();
    }
    d = d.cwiseMax(0.0);
    lambda = lambda.cwiseMax(0.0);
  }

  const Problem& _problem;
  const VectorXd& _r;
  const LcpOptions& _options;
  std::function<bool(const Run&)> _on_step;
  OpenFactor _factor;
};

}  // namespace

DenseLcp::DenseLcp(MatrixXd matrix, std::vector<ddm::Terms> rows, VectorXd weights)
    : _matrix(std::move(matrix)), _rows(std::move(rows)), _scale(conditions()) {
  _scale.head(size()) = _matrix.diagonal().cwiseSqrt().cwiseInverse();
  for (Index j = 0; j < _matrix.cols(); ++j)
    for (Index i = 0; i < _matrix.rows(); ++i) _matrix(i, j) *= _scale[i] * _scale[j];
  for (std::size_t k = 0; k < _rows.size(); ++k) {
    double norm = 0;
    for (ddm::Term& term : _rows[k]) {
      term.factor *= _scale[term.index];
      norm = std::hypot(norm, term.factor);
    }
    for (ddm::Term& term : _rows[k]) term.factor /= norm;
    _scale[size() + static_cast<Index>(k)] = norm;
  }
  if (weights.size() == 0) weights.setOnes(conditions());
  _weights = weights.cwiseQuotient(_scale.cwiseAbs2());
}

VectorXd DenseLcp::jumps(const VectorXd& d, const std::vector<char>& closed) const {
  VectorXd result(conditions());
  result.head(size()) = d.cwiseQuotient(_scale.head(size()));
  Problem{_matrix, _rows, _weights}.add_rows(result);
  result = result.cwiseProduct(_scale);
  result.head(size()) = d;
  for (Index k = size(); k < result.size(); ++k)
    result[k] = closed[at(k)] != 0 ? 0 : std::max(result[k], 0.0);
  return result;
}

VectorXd DenseLcp::split(const VectorXd& force, const std::vector<char>& closed) const {
  VectorXd lambda(conditions());
  lambda.head(size()) = force;
  if (!_rows.empty()) {
    lambda.head(size()) = force.cwiseProduct(_scale.head(size()));
    Problem{_matrix, _rows, _weights}.split(closed, lambda);
    lambda = lambda.cwiseQuotient(_scale);
  }
  for (Index i = 0; i < lambda.size(); ++i) lambda[i] = closed[at(i)] != 0 ? lambda[i] : 0;
  return lambda;
}

LcpAnswer DenseLcp::solve(const VectorXd& r, const VectorXd& magnitude, const LcpOptions& options,
                          std::span<const char> start, const OnStep& on_step) const {
  const VectorXd& terms = magnitude.size() == 0 ? r : magnitude;
  const auto of_nodes = _scale.head(size());
  const double largest = size() == 0 ? 0 : of_nodes.cwiseProduct(terms).lpNorm<Eigen::Infinity>();
  const double unit = largest > 0 ? largest : 1;
  const VectorXd scaled = of_nodes.cwiseProduct(r) / unit;
  const auto jump = [&](const VectorXd& d) { return VectorXd(_scale.cwiseProduct(d) * unit); };
  const auto pressure = [&](const VectorXd& lambda) {
    return VectorXd(lambda.cwiseQuotient(_scale) * unit);
  };
  const Problem problem{_matrix, _rows, _weights};
  Run run(problem, scaled, options, start, [&](const Run& state) {
    return on_step({state.steps, state.closed, jump(state.d), pressure(state.lambda)});
  });
  LcpAnswer answer;
  answer.status = run.solve();
  answer.steps = run.steps;
  answer.fell_back = run.fell_back;
  answer.d = jump(run.d.cwiseMax(0.0));
  answer.lambda = pressure(run.lambda.cwiseMax(0.0));
  const double weak = std::max(options.tolerance, rounding);
  for (Index i = 0; i < conditions(); ++i) {
    answer.weakly_active += run.d[i] <= weak && run.lambda[i] <= weak ? 1 : 0;
    answer.pressed.push_back(run.lambda[i] > weak ? 1 : 0);
  }
  if (answer.status == LcpStatus::solved) answer.factor = run.take_factor();
  answer.closed = std::move(run.closed);
  return answer;
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

}  // namespace anticrack::contact
