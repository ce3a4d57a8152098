// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/block_lcp.hpp"

#include <algorithm>
#include <cmath>

#include "contact/dense.hpp"
#include "mesh/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of the preconditioned size of the load: what conjugate gradients end at.
constexpr double first_tolerance = 0.1, last_tolerance = 1e-13, rounding_tolerance = 1e-15;
/// Below this part of the load, in scaled numbers, d and lambda are rounding of the solves.
constexpr double solve_rounding = 4 * lcp_rounding;
/// Steps of the blocks before single contacts decide; iterations of one run of conjugate gradients.
constexpr int block_steps = 25, most_iterations = 400;

}  // namespace

BlockLcp::BlockLcp(const JoinedMembrane& membrane, const ContactBlocks& blocks)
    : _membrane(membrane),
      _blocks(blocks),
      _conditions(static_cast<Index>(membrane.decomposition().skeleton.contacts.size())),
      _scale(VectorXd::Ones(_conditions)) {
  for (const ContactBlock& block : blocks.blocks()) _scale(block.conditions) = block.lcp.scale();
}

std::vector<char> BlockLcp::of_block(const ContactBlock& block, const std::vector<char>& closed) {
  std::vector<char> result;
  result.reserve(block.conditions.size());
  for (const std::int32_t c : block.conditions) result.push_back(closed[at(c)]);
  return result;
}

VectorXd BlockLcp::jumps(const VectorXd& d, const std::vector<char>& closed) const {
  VectorXd result(_conditions);
  for (const ContactBlock& block : _blocks.blocks())
    result(block.conditions) = block.lcp.jumps(d(block.contacts), of_block(block, closed));
  return result;
}

VectorXd BlockLcp::signed_jumps(const VectorXd& d) const {
  const ddm::Skeleton& skeleton = _membrane.decomposition().skeleton;
  VectorXd result(_conditions);
  result.head(d.size()) = d;
  for (std::size_t k = 0; k < skeleton.dependent.size(); ++k)
    result[d.size() + static_cast<Index>(k)] = sum_of(skeleton.dependent[k], d);
  return result;
}

VectorXd BlockLcp::split(const VectorXd& force, const std::vector<char>& closed) const {
  VectorXd result(_conditions);
  for (const ContactBlock& block : _blocks.blocks())
    result(block.conditions) = block.lcp.split(force(block.contacts), of_block(block, closed));
  return result;
}

/// One load.
class BlockLcp::Run {
 public:
  Run(const BlockLcp& lcp, const VectorXd& r)
      : closed(at(lcp._conditions), 1),
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

  /// A start from the hats for long cracks.
  void start_coarse() {
    if (!_lcp._blocks.coarse()) return;
    const auto& hats = _lcp._blocks.hats();
    const LcpAnswer answer = _lcp._blocks.coarse()->solve(hats.transpose() * residual, {}, {}, {},
                                                          [](const LcpStep&) { return true; });
    if (answer.status != LcpStatus::solved) return;
    d = hats * answer.d;
    for (Index i = 0; i < d.size(); ++i)
      if (d[i] > 0) closed[at(i)] = 0;
    subtract(d);
  }

  /// Every block's contact problem with the other blocks as they are.
  void propose(double unit) {
    VectorXd next(d.size());
    for (const ContactBlock& block : _blocks) {
      stop::look("solving for contact");
      const auto& scale = block.lcp.scale();
      const VectorXd load = residual(block.contacts) + block.lcp.apply(d(block.contacts));
      const VectorXd size =
          VectorXd::Constant(load.size(), unit).cwiseQuotient(scale.head(block.lcp.size()));
      LcpAnswer answer = block.lcp.solve(load, size, {}, of_block(block, closed),
                                         [](const LcpStep&) { return true; });
      for (std::size_t k = 0; k < block.conditions.size(); ++k)
        closed[at(block.conditions[k])] = answer.closed[k];
      next(block.contacts) = answer.d.head(block.lcp.size());
    }
    move_to(next);
  }

  /// d <- next, and the residual. One solve.
  void move_to(const VectorXd& next) {
    const VectorXd step = next - d;
    if (step.isZero(0)) return;
    subtract(step);
    d = next;
  }

  /// Rows that hold by themselves.
  void close_rows_without_open_nodes() {
    const ddm::Skeleton& skeleton = _lcp._membrane.decomposition().skeleton;
    for (std::size_t k = 0; k < skeleton.dependent.size(); ++k) {
      const bool open = std::ranges::any_of(skeleton.dependent[k], [this](const ddm::Term& term) {
        return closed[at(term.index)] == 0;
      });
      if (!open) closed[skeleton.independent + k] = 1;
    }
  }

  void factorise() {
    for (std::size_t b = 0; b < _blocks.size(); ++b) {
      stop::look("solving for contact");
      _factors[b].factorise(_blocks[b].lcp.scaled_matrix(), _blocks[b].lcp.scaled_rows(),
                            of_block(_blocks[b], closed));
    }
    factorise_hats();
  }

  /// The open part of M^-1 b. Values of closed contacts are 0, and the rows that hold do.
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

  /// S^ d = r on the open contacts, from d as it is there, or as near as it gets.
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

  /// As far as rounding lets it: the residual of the iteration drifts.
  void solve_to_rounding(const VectorXd& r, double size) {
    solve_open(last_tolerance, size);
    residual = r - _lcp._membrane.apply(d, true);
    solves += 2;
    solve_open(rounding_tolerance, size);
  }

  /// sqrt(b'M^-1 b) squared of the load with all contacts open, the scale of the tolerance.
  double size_of(const VectorXd& b) {
    std::vector<char> all_open(closed.size(), 0);
    std::swap(all_open, closed);
    factorise();
    std::swap(all_open, closed);
    return b.dot(precondition(b));
  }

  /// What the iteration has to bring to 0: without the forces of the rows that hold, which would
  /// cancel in products.
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

  /// Puts d to 0 where closed, and onto the rows that hold.
  void restrict() {
    VectorXd next = d;
    project(next);
    move_to(next);
  }

  /// Onto the d that are 0 where closed and on the rows that hold.
  void project(VectorXd& values) const {
    for (Index i = 0; i < values.size(); ++i)
      if (closed[at(i)] != 0) values[i] = 0;
    const ddm::Skeleton& skeleton = _lcp._membrane.decomposition().skeleton;
    for (std::size_t k = 0; k < skeleton.dependent.size(); ++k) {
      if (closed[skeleton.independent + k] == 0) continue;
      double sum = 0, size = 0;
      for (const auto& [i, factor] : skeleton.dependent[k]) {
        if (closed[at(i)] != 0) continue;
        sum += factor * values[i];
        size += factor * factor;
      }
      for (const auto& [i, factor] : skeleton.dependent[k])
        if (closed[at(i)] == 0) values[i] -= factor * sum / size;
    }
  }

  /// Hats wholly on open contacts.
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

BlockLcp::Opened BlockLcp::solve_open(const VectorXd& r, const std::vector<char>& closed) const {
  Run run(*this, r);
  const double size = run.size_of(r);
  if (closed.empty())
    run.closed.assign(run.closed.size(), 0);
  else
    run.closed = closed;
  run.solve_to_rounding(r, size);
  const auto largest = [scale = _scale.head(r.size())](const VectorXd& of) {
    return of.size() == 0 ? 0 : scale.cwiseProduct(of).lpNorm<Eigen::Infinity>();
  };
  const double left = largest(run.open_residual());
  return {std::move(run.d), std::move(run.residual), left == 0 ? 0 : left / largest(r)};
}

BlockLcp::Answer BlockLcp::solve(const VectorXd& r, const VectorXd& magnitude,
                                 const LcpOptions& options, std::span<const char> start,
                                 const OnStep& on_step) const {
  Answer answer;
  const auto scale = _scale.head(r.size());
  const VectorXd& terms = magnitude.size() == 0 ? r : magnitude;
  const double largest = r.size() == 0 ? 0 : scale.cwiseProduct(terms).lpNorm<Eigen::Infinity>();
  const double unit = largest > 0 ? largest : 1;
  Run run(*this, r);
  const double size = run.size_of(r);
  if (start.empty())
    run.start_coarse();
  else
    std::copy(start.begin(), start.end(), run.closed.begin());
  double tolerance = first_tolerance;
  bool by_blocks = true, settled = false;
  VectorXd jump, lambda;
  for (; !settled && answer.steps < options.max_steps;
       tolerance = std::max(tolerance / 10, last_tolerance)) {
    const std::vector<char> before = run.closed;
    if (by_blocks) run.propose(unit);
    if (run.closed == before && answer.steps > 0) tolerance = last_tolerance;
    by_blocks = by_blocks && answer.steps < block_steps;
    if (!by_blocks) tolerance = last_tolerance;
    if (tolerance > last_tolerance)
      run.solve_open(tolerance, size);
    else
      run.solve_to_rounding(r, size);
    ++answer.steps;
    jump = signed_jumps(run.d);
    run.close_rows_without_open_nodes();
    lambda = split(-run.residual, run.closed);
    if (!on_step({answer.steps, run.closed, jump, lambda.cwiseMax(0.0)})) {
      answer.status = LcpStatus::stopped;
      break;
    }
    if (tolerance > last_tolerance) continue;
    std::vector<char> next = run.closed;
    for (Index i = 0; i < _conditions; ++i) {
      if (run.closed[at(i)] == 0 ? jump[i] < -solve_rounding * unit * _scale[i]
                                 : lambda[i] * _scale[i] < -solve_rounding * unit)
        next[at(i)] = run.closed[at(i)] == 0 ? 1 : 0;
    }
    settled = next == run.closed;
    run.closed = std::move(next);
  }
  if (settled) answer.status = LcpStatus::solved;
  // Nodes that are open by solve_rounding only are closed, which makes the set unique.
  for (Index i = 0; settled && i < r.size(); ++i)
    if (run.closed[at(i)] == 0 && run.d[i] <= solve_rounding * unit * _scale[i])
      run.closed[at(i)] = 1;
  answer.d = run.d.cwiseMax(0.0);
  answer.lambda = lambda.cwiseMax(0.0);
  answer.solves = run.solves;
  const double weak = std::max(options.tolerance, solve_rounding);
  answer.residual = scale.cwiseProduct(run.open_residual()).lpNorm<Eigen::Infinity>() / unit;
  for (Index i = 0; i < _conditions; ++i) {
    const bool pressed = lambda[i] * _scale[i] > weak * unit;
    answer.pressed.push_back(pressed ? 1 : 0);
    answer.weakly_active += !pressed && jump[i] <= weak * unit * _scale[i] ? 1 : 0;
  }
  answer.closed = std::move(run.closed);
  return answer;
}

}  // namespace anticrack::contact
