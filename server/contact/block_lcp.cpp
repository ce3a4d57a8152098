// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/block_lcp.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "contact/dense.hpp"
#include "errors/errors.hpp"
#include "stop/stop.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Conjugate gradients end at this fraction of the preconditioned size of the load.
constexpr double first_tolerance = 0.1, last_tolerance = 1e-13, rounding_tolerance = 1e-15;
/// Below this fraction of the load, in scaled numbers, d and lambda are errors of the solves.
constexpr double solve_rounding = 4 * lcp_rounding;
/// Range of loads whose squares neither overflow nor vanish; others are scaled by a power of two.
constexpr double least_load = 1e-100, most_load = 1e100;
/// Most steps of the blocks before single contacts decide; most iterations of conjugate gradients.
constexpr int block_steps = 25, most_iterations = 400;

/// The factor that brings a load of this size into that range; 1 if it is there already.
double factor_for(double size) {
  const bool fits = size == 0 || !std::isfinite(size) || (size >= least_load && size <= most_load);
  return fits ? 1 : std::ldexp(1.0, -std::ilogb(size));
}

}  // namespace

BlockLcp::BlockLcp(const JoinedMembrane& membrane, const ContactBlocks& blocks,
                   const Conditions& conditions)
    : _membrane(membrane),
      _blocks(blocks),
      _conditions(conditions),
      _scale(VectorXd::Ones(conditions.size())) {
  for (const ContactBlock& block : blocks.blocks()) _scale(block.conditions) = block.lcp.scale();
}

std::vector<char> BlockLcp::of_block(const ContactBlock& block, const std::vector<char>& closed) {
  std::vector<char> result;
  result.reserve(block.conditions.size());
  for (const std::int32_t c : block.conditions) result.push_back(closed[at(c)]);
  return result;
}

/// The steps of the solution for one load.
class BlockLcp::Steps {
 public:
  Steps(const BlockLcp& lcp, const VectorXd& r)
      : closed(at(lcp._conditions.size()), 1),
        d(VectorXd::Zero(r.size())),
        residual(r),
        _lcp(lcp),
        _blocks(lcp._blocks.blocks()),
        _factors(_blocks.size()) {
    for (std::size_t k = at(r.size()); k < closed.size(); ++k) closed[k] = 0;
  }

  std::vector<char> closed;
  VectorXd d, residual;  // r - S^ d
  int solves = 0;

  /// Starts from the solution of the contact problem on the hats, if long cracks have hats.
  void start_coarse() {
    if (!_lcp._blocks.coarse()) return;
    const auto& hats = _lcp._blocks.hats();
    const LcpAnswer answer = _lcp._blocks.coarse()->solve(hats.transpose() * residual, {}, {}, {});
    if (answer.status != LcpStatus::solved) return;
    d = hats * answer.d;
    for (Index i = 0; i < d.size(); ++i)
      if (d[i] > 0) closed[at(i)] = 0;
    subtract(d);
  }

  /// Solves the contact problem of every block while the jumps of the other blocks stay.
  void propose(double unit) {
    VectorXd next(d.size());
    for (const ContactBlock& block : _blocks) {
      stop::look("solving for contact");
      const auto& scale = block.lcp.scale();
      const VectorXd load = residual(block.contacts) + block.lcp.apply(d(block.contacts));
      const VectorXd size =
          VectorXd::Constant(load.size(), unit).cwiseQuotient(scale.head(block.lcp.size()));
      const LcpAnswer answer = block.lcp.solve(load, size, {}, of_block(block, closed));
      for (std::size_t k = 0; k < block.conditions.size(); ++k)
        closed[at(block.conditions[k])] = answer.closed[k];
      next(block.contacts) = answer.d.head(block.lcp.size());
    }
    move_to(next);
  }

  /// Sets d to `next` and updates the residual. One solve.
  void move_to(const VectorXd& next) {
    const VectorXd step = next - d;
    if (step.isZero(0)) return;
    subtract(step);
    d = next;
  }

  void factorise() {
    for (std::size_t b = 0; b < _blocks.size(); ++b) {
      stop::look("solving for contact");
      _factors[b].factorise(_blocks[b].lcp.scaled_matrix(),
                            _blocks[b].lcp.scaled_conditions().rows(),
                            of_block(_blocks[b], closed));
    }
    factorise_hats();
  }

  /// M^-1 b on the open contacts, 0 on the closed ones; the result satisfies the closed rows.
  VectorXd precondition(const VectorXd& b) const {
    VectorXd result(b.size());
    for (std::size_t k = 0; k < _blocks.size(); ++k) {
      const ContactBlock& block = _blocks[k];
      const auto scale = block.lcp.scale().head(block.lcp.size());
      result(block.contacts) =
          scale.cwiseProduct(_factors[k].solve(scale.cwiseProduct(b(block.contacts))));
    }
    if (!_open_hats.empty()) {
      const auto& hats = _lcp._blocks.hats();
      VectorXd coarse = (hats.transpose() * b)(_open_hats);
      solve_lower(_hat_factor, coarse);
      solve_lower_transposed(_hat_factor, coarse);
      VectorXd all = VectorXd::Zero(hats.cols());
      all(_open_hats) = coarse;
      result += hats * all;
    }
    return result;
  }

  /// Solves S^ d = r on the open contacts, starting from the present d, as far as it converges.
  void solve_open(double tolerance, double size) {
    restrict();
    factorise();
    VectorXd left = open_residual(), z = precondition(left), direction = z;
    double product = z.dot(left);
    for (int k = 0; k < most_iterations; ++k) {
      stop::look("solving for contact");
      if (!(product > tolerance * tolerance * size)) return;
      const VectorXd image = _lcp._membrane.apply(direction);
      ++solves;
      const double curvature = direction.dot(image);
      if (!(curvature > 0)) return;
      const double way = product / curvature;
      d += way * direction;
      residual -= way * image;
      left = open_residual();
      z = precondition(left);
      const double next = z.dot(left);
      direction = z + next / product * direction;
      product = next;
    }
  }

  /// Solves to rounding: the residual is computed afresh once, as that of the iteration drifts.
  void solve_to_rounding(const VectorXd& r, double size) {
    solve_open(last_tolerance, size);
    residual = r - _lcp._membrane.apply(d, true);
    solves += 2;
    solve_open(rounding_tolerance, size);
  }

  /// b'M^-1 b with all contacts open: the square of the size that the tolerance is relative to.
  double size_of(const VectorXd& b) {
    std::vector<char> all_open(closed.size(), 0);
    std::swap(all_open, closed);
    factorise();
    std::swap(all_open, closed);
    return b.dot(precondition(b));
  }

  /// The part of the residual that the iteration brings to 0. The forces of closed rows are taken
  /// off, as they would cancel in products.
  VectorXd open_residual() const {
    VectorXd left = residual;
    project(left);
    return left;
  }

 private:
  void subtract(const VectorXd& step) {
    residual -= _lcp._membrane.apply(step);
    ++solves;
  }

  /// Makes d satisfy what is closed: 0 on closed contacts, G d = 0 on closed rows.
  void restrict() {
    VectorXd next = d;
    project(next);
    move_to(next);
  }

  /// Projects values onto those that are 0 on closed contacts and satisfy the closed rows.
  void project(VectorXd& values) const {
    for (Index i = 0; i < values.size(); ++i)
      if (closed[at(i)] != 0) values[i] = 0;
    const Conditions& conditions = _lcp._conditions;
    for (std::size_t k = 0; k < conditions.rows().size(); ++k) {
      if (closed[at(conditions.row(k))] == 0) continue;
      const double nu = conditions.balancing(k, closed, values);
      for (const auto& [i, factor] : conditions.rows()[k])
        if (closed[at(i)] == 0) values[i] -= factor * nu;
    }
  }

  /// Factorises P'S^ P for the hats that lie wholly on open contacts.
  void factorise_hats() {
    _open_hats.clear();
    const auto& hats = _lcp._blocks.hats();
    for (Index k = 0; k < hats.cols(); ++k) {
      bool open = true;
      for (Eigen::SparseMatrix<double>::InnerIterator entry(hats, k); entry; ++entry)
        open = open && closed[at(entry.row())] == 0;
      if (open) _open_hats.push_back(k);
    }
    if (_open_hats.empty()) return;
    _hat_factor = _lcp._blocks.coarse_matrix()(_open_hats, _open_hats);
    if (!cholesky(_hat_factor)) _open_hats.clear();
  }

  const BlockLcp& _lcp;
  const std::vector<ContactBlock>& _blocks;
  std::vector<OpenFactor> _factors;
  std::vector<Index> _open_hats;
  MatrixXd _hat_factor;
};

Opened BlockLcp::solve_open(const VectorXd& r, const std::vector<char>& closed,
                            double tolerance) const {
  const double factor =
      r.size() == 0 ? 1
                    : factor_for(_scale.head(r.size()).cwiseProduct(r).lpNorm<Eigen::Infinity>());
  if (factor != 1) {
    Opened opened = solve_open(factor * r, closed, tolerance);
    opened.d /= factor;
    opened.residual /= factor;
    return opened;
  }
  Steps steps(*this, r);
  const double size = steps.size_of(r);
  if (closed.empty())
    steps.closed.assign(steps.closed.size(), 0);
  else
    steps.closed = closed;
  if (tolerance > 0) {
    steps.solve_open(tolerance, size);
    return {std::move(steps.d), std::move(steps.residual), true};
  }
  steps.solve_to_rounding(r, size);
  const auto largest = [scale = _scale.head(r.size())](const VectorXd& of) {
    return of.size() == 0 ? 0 : scale.cwiseProduct(of).lpNorm<Eigen::Infinity>();
  };
  const double left = largest(steps.open_residual());
  return {std::move(steps.d), std::move(steps.residual), left == 0 || left / largest(r) <= 1e-10};
}

LcpAnswer BlockLcp::solve(const VectorXd& r, const VectorXd& magnitude, const LcpOptions& options,
                          std::span<const char> start, const OnStep& on_step) const {
  if (!options.tied.empty()) {
    throw errors::Error(errors::Reason::limit_exceeded,
                        "{} nodes of cracks and delaminations are too many for fronts that move: "
                        "take a coarser mesh along the paths",
                        r.size());
  }
  LcpAnswer answer;
  const auto scale = _scale.head(r.size());
  const VectorXd& terms = magnitude.size() == 0 ? r : magnitude;
  const double largest = r.size() == 0 ? 0 : scale.cwiseProduct(terms).lpNorm<Eigen::Infinity>();
  const double unit = largest > 0 ? largest : 1, factor = factor_for(largest);
  if (factor != 1) {
    answer = solve(factor * r, factor * terms, options, start, [&](const LcpStep& step) {
      const VectorXd d = step.d / factor, lambda = step.lambda / factor;
      return !on_step || on_step({step.number, step.closed, d, lambda});
    });
    answer.d /= factor;
    answer.lambda /= factor;
    return answer;
  }
  Steps steps(*this, r);
  const double size = steps.size_of(r);
  if (start.empty())
    steps.start_coarse();
  else
    std::copy(start.begin(), start.end(), steps.closed.begin());
  double tolerance = first_tolerance;
  bool by_blocks = true, settled = false;
  VectorXd jump = VectorXd::Zero(_conditions.size()), lambda = jump;
  for (; !settled && answer.steps < options.max_steps;
       tolerance = std::max(tolerance / 10, last_tolerance)) {
    const std::vector<char> before = steps.closed;
    if (by_blocks) steps.propose(unit);
    if (steps.closed == before && answer.steps > 0) tolerance = last_tolerance;
    by_blocks = by_blocks && answer.steps < block_steps;
    if (!by_blocks) tolerance = last_tolerance;
    if (tolerance > last_tolerance)
      steps.solve_open(tolerance, size);
    else
      steps.solve_to_rounding(r, size);
    ++answer.steps;
    jump.head(r.size()) = steps.d;
    _conditions.add_rows(jump);
    _conditions.close_rows_without_open_contacts(steps.closed);
    lambda = _conditions.multipliers(-steps.residual, steps.closed);
    if (on_step && !on_step({answer.steps, steps.closed, jump, lambda.cwiseMax(0.0)})) {
      answer.status = LcpStatus::stopped;
      break;
    }
    if (tolerance > last_tolerance) continue;
    std::vector<char> next = steps.closed;
    for (Index i = 0; i < _conditions.size(); ++i) {
      if (steps.closed[at(i)] == 0 ? jump[i] < -solve_rounding * unit * _scale[i]
                                   : lambda[i] * _scale[i] < -solve_rounding * unit)
        next[at(i)] = steps.closed[at(i)] == 0 ? 1 : 0;
    }
    settled = next == steps.closed;
    steps.closed = std::move(next);
  }
  if (settled) answer.status = LcpStatus::solved;
  // Nodes that are open by solve_rounding only are closed, which makes the set unique.
  for (Index i = 0; settled && i < r.size(); ++i)
    if (steps.closed[at(i)] == 0 && steps.d[i] <= solve_rounding * unit * _scale[i])
      steps.closed[at(i)] = 1;
  answer.d = jump.cwiseMax(0.0);
  answer.lambda = lambda.cwiseMax(0.0);
  answer.solves = steps.solves;
  const double weak = std::max(options.tolerance, solve_rounding);
  answer.residual = scale.cwiseProduct(steps.open_residual()).lpNorm<Eigen::Infinity>() / unit;
  for (Index i = 0; i < _conditions.size(); ++i) {
    const bool pressed = lambda[i] * _scale[i] > weak * unit;
    answer.pressed.push_back(pressed ? 1 : 0);
    answer.weakly_active += !pressed && jump[i] <= weak * unit * _scale[i] ? 1 : 0;
  }
  answer.closed = std::move(steps.closed);
  return answer;
}

}  // namespace anticrack::contact
