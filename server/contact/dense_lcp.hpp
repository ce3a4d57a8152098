// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "contact/open_factor.hpp"

namespace anticrack::contact {

/// What is below this times the load is rounding: neither opens nor closes a node.
constexpr double lcp_rounding = 256 * std::numeric_limits<double>::epsilon();

/// Whether S on n nodes is regular to rounding, from the smallest squared pivot of its Cholesky
/// factor: what is left of a diagonal of 1.
constexpr bool regular_pivot(double smallest, Eigen::Index n) {
  return smallest > 64 * std::numeric_limits<double>::epsilon() * static_cast<double>(n);
}

/// A node that is closed has d = 0, one that is open has lambda = 0.
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

struct LcpAnswer {
  LcpStatus status = LcpStatus::step_limit;
  std::vector<char> closed;
  Eigen::VectorXd d;       ///< >= 0
  Eigen::VectorXd lambda;  ///< >= 0
  int steps = 0;
  int weakly_active = 0;  ///< neither d nor lambda above tolerance
  bool fell_back = false;
  OpenFactor factor;  ///< of the open nodes, where solved: for solve_open
};

struct LcpOptions {
  double tolerance = 1e-12;  ///< of weakly_active, relative to the load
  int max_steps = 1000;
  bool monotone_only = false;  ///< leaves out the primal-dual steps; to test the fall-back
};

/// Linear complementarity with a dense matrix S, the minimum of d'S d/2 - r'd over d >= 0:
///
///   d >= 0,  lambda = S d - r >= 0,  d'lambda = 0
///
/// by the primal-dual active set method (Hintermueller, Ito, Kunisch 2003): solve with d = 0 on the
/// closed nodes and lambda = 0 on the open ones, close the open ones with d < 0, open the closed
/// ones with lambda < 0, until nothing changes. Everything is scaled to a unit diagonal of S, that
/// is c_i = S_ii.
///
/// It terminates. Every set met is remembered; when one comes back (or S is singular on the open
/// nodes) a monotone method takes over, Lawson and Hanson's. There every outer step ends in the
/// minimum over {d : d = 0 on the closed nodes} with d > 0 on the open ones, found on the straight
/// way from the last d, and is taken only if the computed energy is less than before. The computed
/// energy is a function of the open set alone, so no set comes back, and there are finitely many.
/// If opening the node with the most negative lambda brings no less energy, then lambda is zero to
/// rounding: in exact arithmetic that step always does, for its direction descends and no open node
/// has d = 0.
///
/// Immutable after construction. Same r, same answer to the last bit whatever the start: the answer
/// is computed from the final set, in which a node with neither d nor lambda to rounding is closed.
class DenseLcp {
 public:
  using OnStep = std::function<bool(const LcpStep&)>;

  /// `matrix`: (c,c) symmetric, positive semidefinite, with positive diagonal. May be singular
  /// where the parts of a membrane hold each other by contact only.
  explicit DenseLcp(Eigen::MatrixXd matrix);

  /// `magnitude`: (c) of the terms whose sum r is: what r's rounding errors are relative to;
  /// empty: |r|. `start`: closed nodes to start from; empty: all. on_step returns false to stop.
  /// O(c^3) a step.
  LcpAnswer solve(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude,
                  const LcpOptions& options, std::span<const char> start,
                  const OnStep& on_step) const;

  /// x with (S x)_i = b_i on the open nodes of an answer's factor, x = 0 on the closed ones. For
  /// iterative refinement. O(c^2).
  Eigen::VectorXd solve_open(const OpenFactor& open, const Eigen::VectorXd& b) const;

  /// 1 / sqrt(S_ii), and S with it on both sides: what the steps compute with.
  const Eigen::VectorXd& scale() const noexcept { return _scale; }
  const Eigen::MatrixXd& scaled_matrix() const noexcept { return _matrix; }
  Eigen::Index size() const noexcept { return _matrix.rows(); }
  std::size_t bytes() const noexcept;

 private:
  Eigen::VectorXd _scale;   // 1 / sqrt(S_ii)
  Eigen::MatrixXd _matrix;  // scaled: unit diagonal
};

}  // namespace anticrack::contact
