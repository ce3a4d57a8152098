// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "contact/dense.hpp"

namespace anticrack::contact {

/// Values below this fraction of the load are rounding and neither open nor close a node.
constexpr double lcp_rounding = 256 * std::numeric_limits<double>::epsilon();

/// Whether S on n nodes is regular to rounding; `smallest`: least squared pivot of its Cholesky
/// factor, whose diagonal was 1.
constexpr bool regular_pivot(double smallest, Eigen::Index n) {
  return smallest > 64 * std::numeric_limits<double>::epsilon() * static_cast<double>(n);
}

/// Of all conditions: the c nodes, then the dependent ones. Closed ones have jump 0, open ones
/// lambda = 0.
struct LcpStep {
  int number = 0;  ///< from 1
  const std::vector<char>& closed;
  const Eigen::VectorXd& d;
  const Eigen::VectorXd& lambda;
};

enum class LcpStatus {
  solved,
  unbounded,   ///< the energy has no minimum: a part slides off along some d >= 0
  step_limit,  ///< max_steps
  stopped,     ///< by on_step
};

/// Vectors are of all conditions, as in LcpStep.
struct LcpAnswer {
  LcpStatus status = LcpStatus::step_limit;
  std::vector<char> closed;
  Eigen::VectorXd d;       ///< >= 0
  Eigen::VectorXd lambda;  ///< >= 0
  int steps = 0;
  int weakly_active = 0;      ///< neither jump nor lambda above tolerance
  std::vector<char> pressed;  ///< lambda above tolerance
  bool fell_back = false;
  OpenFactor factor;  ///< of the open nodes, where solved: for solve_open
};

struct LcpOptions {
  double tolerance = 1e-12;  ///< of weakly_active, relative to the load
  int max_steps = 1000;
  bool monotone_only = false;  ///< leaves out the primal-dual steps; to test the fall-back
};

/// Linear complementarity with a dense matrix S, the minimum of d'S d/2 - r'd over d >= 0, G d >=
/// 0:
///
///   d >= 0,  lambda = S d - r - G'nu >= 0,  d'lambda = 0,   G d >= 0,  nu >= 0,  nu'G d = 0
///
/// G has the few conditions that depend on others: each belongs to one node where cracks cross, and
/// no two have terms in common. Where all nodes of one are closed it holds by itself, and nu is the
/// share of their lambda that makes the weighted sum of squares of all of them least.
///
/// by the primal-dual active set method (Hintermueller, Ito, Kunisch 2003): solve with d = 0 on the
/// closed nodes and lambda = 0 on the open ones, close the open ones with d < 0, open the closed
/// ones with lambda < 0, until nothing changes; the rows of G likewise. Everything is scaled to a
/// unit diagonal of S, that is c_i = S_ii, and rows of norm 1.
///
/// Termination: all sets met are remembered. If one recurs, or S is singular on the open nodes, the
/// monotone method of Lawson and Hanson takes over. Each of its outer steps ends in the minimum
/// over {d : d = 0 on the closed nodes} with d > 0 on the open ones, reached along the segment from
/// the last d, and is accepted only if it lowers the computed energy, a function of the open set
/// alone. So no set recurs, and there are finitely many. If opening the node with the most negative
/// lambda does not lower the energy, lambda is zero to rounding, for in exact arithmetic it always
/// does. With rows of G a primal active set method takes its place, which frees or stops at one
/// condition at a time (Nocedal and Wright, Numerical Optimization, 16.5), by Bland's rule.
///
/// Immutable after construction. The answer's bits depend on r alone, not on the start: it is
/// computed from the final set, in which nodes with neither d nor lambda to rounding are closed.
class DenseLcp {
 public:
  using OnStep = std::function<bool(const LcpStep&)>;

  /// `matrix`: (c,c) symmetric, positive semidefinite, positive diagonal. Singular where parts of a
  /// membrane hold each other by contact only.
  /// `rows`: G. `weights`: of the conditions in the sum of squares of lambda; empty: 1.
  explicit DenseLcp(Eigen::MatrixXd matrix, std::vector<ddm::Terms> rows = {},
                    Eigen::VectorXd weights = {});

  /// `magnitude`: (c) sums of the absolute terms of r, the scale of its rounding errors; empty:
  /// |r|. `start`: closed conditions to start from; missing nodes are closed, missing rows open.
  /// on_step returns false to stop. O(c^3) a step.
  LcpAnswer solve(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude,
                  const LcpOptions& options, std::span<const char> start,
                  const OnStep& on_step) const;

  /// x with (S x)_i = b_i on the open nodes of an answer's factor, else 0, for refinement. O(c^2).
  Eigen::VectorXd solve_open(const OpenFactor& open, const Eigen::VectorXd& b) const;

  /// S d. O(c^2).
  Eigen::VectorXd apply(const Eigen::VectorXd& d) const;

  /// The jumps of all conditions: d, then G d, 0 where closed and not below.
  Eigen::VectorXd jumps(const Eigen::VectorXd& d, const std::vector<char>& closed) const;
  /// lambda of all conditions from S d - r, given which are closed. O(c).
  Eigen::VectorXd split(const Eigen::VectorXd& force, const std::vector<char>& closed) const;

  /// 1 / sqrt(S_ii) of the nodes, the norms of the rows of S-scaled d; and S with it on both sides:
  /// what the steps compute with.
  const Eigen::VectorXd& scale() const noexcept { return _scale; }
  const std::vector<ddm::Terms>& scaled_rows() const noexcept { return _rows; }
  const Eigen::MatrixXd& scaled_matrix() const noexcept { return _matrix; }
  Eigen::Index size() const noexcept { return _matrix.rows(); }  ///< c
  Eigen::Index conditions() const noexcept {
    return size() + static_cast<Eigen::Index>(_rows.size());
  }
  std::size_t bytes() const noexcept;

 private:
  Eigen::MatrixXd _matrix;        // scaled: unit diagonal
  std::vector<ddm::Terms> _rows;  // scaled: norm 1
  Eigen::VectorXd _scale;         // (conditions)
  Eigen::VectorXd _weights;       // of scaled lambda
};

}  // namespace anticrack::contact
