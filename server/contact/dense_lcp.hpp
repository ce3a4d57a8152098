// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contact/conditions.hpp"
#include "contact/dense.hpp"
#include "contact/open_responses.hpp"

namespace anticrack::contact {

/// Values below this fraction of the load are rounding errors and neither open nor close a node.
constexpr double lcp_rounding = 256 * std::numeric_limits<double>::epsilon();

/// Whether S on n nodes is regular to rounding. `smallest`: the least squared pivot of the Cholesky
/// factor of S, scaled to a unit diagonal.
constexpr bool regular_pivot(double smallest, Eigen::Index n) {
  return smallest > 64 * std::numeric_limits<double>::epsilon() * static_cast<double>(n);
}

/// One step; vectors have an entry per condition. Closed ones have jump 0, open ones lambda = 0.
struct LcpStep {
  int number = 0;  ///< from 1
  const std::vector<char>& closed;
  const Eigen::VectorXd& d;
  const Eigen::VectorXd& lambda;
};
/// Called after each step; returns false to stop. May be empty.
using OnStep = std::function<bool(const LcpStep&)>;

enum class LcpStatus {
  solved,
  unbounded,   ///< the energy has no minimum: a part slides off along some d >= 0
  step_limit,  ///< max_steps
  stopped,     ///< by on_step
};

/// Vectors have an entry per condition, as in LcpStep.
struct LcpAnswer {
  LcpStatus status = LcpStatus::step_limit;
  std::vector<char> closed;
  Eigen::VectorXd d;          ///< >= 0
  Eigen::VectorXd lambda;     ///< >= 0
  std::vector<char> pressed;  ///< 1 where lambda is above the tolerance
  int steps = 0;
  int weakly_active = 0;  ///< conditions with neither jump nor lambda above the tolerance
  bool fell_back = false;
  int solves = 0;  ///< applications of S^ where it is not formed
  /// Largest |lambda - (S d - r)| with d and lambda clipped at 0, relative to the largest magnitude
  /// or lambda.
  double residual = 0;
  OpenFactor factor;  ///< of the open nodes, for solve_open; set if solved and S is formed
};

struct LcpOptions {
  double tolerance = 1e-12;  ///< of weakly_active, relative to the load
  int max_steps = 1000;
  bool monotone_only = false;  ///< skips the primal-dual steps, to test the fall-back
  /// (contacts) 1: d = 0, whatever pulls, and no lambda; empty: none. Kept as a reference.
  std::span<const char> tied{};
};

/// Linear complementarity with a dense matrix S, the minimum of d'S d/2 - r'd under Conditions:
///
///   d >= 0,  lambda = S d - r - G'nu >= 0,  d'lambda = 0,   G d >= 0,  nu >= 0,  nu'G d = 0
///
/// Everything is scaled so that S has a unit diagonal (c_i = S_ii) and the rows of G have norm 1.
/// Immutable after construction; LcpSequence solves it.
class DenseLcp {
 public:
  /// `matrix`: (c,c) symmetric, positive semidefinite, positive diagonal. It is singular where
  /// parts of a membrane hold each other by contact only. `rows`, `weights`: as in Conditions.
  explicit DenseLcp(Eigen::MatrixXd matrix, std::vector<ddm::Terms> rows = {},
                    Eigen::VectorXd weights = {});

  /// Solves for one r, as LcpSequence::solve does from `start`. O(c^3) a step.
  LcpAnswer solve(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude,
                  const LcpOptions& options, std::span<const char> start,
                  const OnStep& on_step = {}) const;

  /// x with (S x)_i = b_i on the open nodes of an answer's factor, 0 elsewhere; for refinement.
  /// O(c^2).
  Eigen::VectorXd solve_open(const OpenFactor& open, const Eigen::VectorXd& b) const;

  /// S d. O(c^2).
  Eigen::VectorXd apply(const Eigen::VectorXd& d) const;

  /// The scaled problem that the steps compute with. scale(): 1 / sqrt(S_ii) of the nodes, then of
  /// each row of G its norm on scaled d; the matrix is S with the scale on both sides; the
  /// conditions are those on scaled jumps.
  const Eigen::VectorXd& scale() const noexcept { return _scale; }
  const Eigen::MatrixXd& scaled_matrix() const noexcept { return _matrix; }
  const Conditions& scaled_conditions() const noexcept { return _conditions; }
  Eigen::Index size() const noexcept { return _matrix.rows(); }  ///< c
  Eigen::Index conditions() const noexcept { return _conditions.size(); }
  std::size_t bytes() const noexcept;

 private:
  Eigen::MatrixXd _matrix;  // unit diagonal
  Eigen::VectorXd _scale;   // (conditions)
  Conditions _conditions;   // rows of norm 1
};

class NestedStart;

/// Solves a DenseLcp for one r after another, each from the closed conditions of the one before and
/// with the factor of its open nodes, by the primal-dual active set method (Hintermueller, Ito,
/// Kunisch 2003): solve with d = 0 on the closed nodes and lambda = 0 on the open ones, close the
/// open ones with d < 0, open the closed ones with lambda < 0, until nothing changes; the rows of G
/// likewise. A step that changes the set is O(c^3); an r with the set of the one before costs two
/// triangular solves and a product, O(c^2), and allocates nothing, unless there are rows of G.
/// Where every r combines a few loads, and there are no rows of G, steps use OpenResponses.
///
/// Termination: where a set recurs (Brent's cycle detection), or S is singular on the open nodes,
/// the steps begin anew from all closed; if that ends so as well, the monotone method of Lawson and
/// Hanson takes over. Each of its outer steps ends in the minimum over {d : d = 0 on the closed
/// nodes} with d > 0 on the open ones, reached along the segment from the last d, and is accepted
/// only if it lowers the computed energy, a function of the open set alone. So no set recurs, and
/// there are finitely many. If opening the node with the most negative lambda does not lower the
/// energy, lambda is zero to rounding, for in exact arithmetic it always does. With rows of G a
/// primal active set method takes its place, which frees or stops at one condition at a time
/// (Nocedal and Wright, Numerical Optimization, 16.5), by Bland's rule.
///
/// An answer's bits depend on r and its loads alone, not on the start nor on what came before: it
/// is computed from the final set, in which nodes with neither d nor lambda to rounding are closed.
/// For one thread.
class LcpSequence {
 public:
  /// Keeps references. `start`: closed conditions; missing nodes are closed, missing rows open.
  /// `nested`: of the same problem, gives the start for an r far from the one before; may be null.
  /// `responses`: to loads of which every r is a combination; null: none are known.
  LcpSequence(const DenseLcp& lcp, const LcpOptions& options, std::span<const char> start,
              const NestedStart* nested = nullptr, OpenResponses* responses = nullptr);

  /// `magnitude`: (c) sums of the absolute terms of r, the scale of its rounding errors; empty:
  /// |r|. The answer is valid until the next call; its factor is the sequence's. `coefficients`: of
  /// the loads, if they are known; the answer has no factor then where responses to them pay.
  const LcpAnswer& solve(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude,
                         const OnStep& on_step = {}, const Eigen::VectorXd& coefficients = {});
  const LcpAnswer& answer() const noexcept { return _answer; }
  LcpAnswer take() && { return std::move(_answer); }

 private:
  Eigen::Index nodes() const { return _r.size(); }
  void close_all();
  bool tied(Eigen::Index i) const {
    return i < nodes() && !_options.tied.empty() && _options.tied[static_cast<std::size_t>(i)] != 0;
  }
  void close_tied();
  const OpenFactor& factor();
  LcpStatus find_set();
  bool primal_dual();
  void monotone();
  void one_by_one();
  bool solve_open();
  void apply();
  void set_multipliers();
  void share_forces();
  void set_multipliers_of_set();
  Eigen::Index find_next();
  bool report();
  bool may_go_on();
  double energy() const { return -_r.dot(_d.head(nodes())) / 2; }  // in the minimum over a face
  void settle();
  void open_one(Eigen::Index node);
  Eigen::Index go_towards(const Eigen::VectorXd& from);
  void close_undecided();
  void finish();

  const DenseLcp& _lcp;
  const Eigen::MatrixXd& _matrix;
  const Conditions& _conditions;
  const NestedStart* const _nested;
  const LcpOptions _options;
  LcpAnswer _answer;
  std::vector<char>& _closed = _answer.closed;
  std::vector<char> _next, _met;
  std::optional<LcpStatus> _ended;
  // Scaled, load of size 1. _force is S d - r, less what rows carry; _lambda that where closed.
  Eigen::VectorXd _r, _d, _force, _lambda;
  OpenResponses* _responses = nullptr;
  Eigen::VectorXd _coefficients;  // of the load of size 1
  double _unit = 1;
  struct Given {
    const Eigen::VectorXd *r, *magnitude;
    const OnStep* on_step;
  } _given{};  // while it is solved
};

}  // namespace anticrack::contact
