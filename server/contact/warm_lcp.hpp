// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/dense_lcp.hpp"
#include "contact/nested_start.hpp"

namespace anticrack::contact {

/// DenseLcp for one r after another, each from the closed nodes of the one before: the same
/// primal-dual steps, with the Cholesky factor of the open nodes kept as long as they stay the
/// same. Then an r costs two triangular solves and a product, O(c^2); a step that changes the set
/// O(c^3). Where the sets go round in a circle, or S is singular on the open nodes, DenseLcp starts
/// over from all closed, with all it promises.
/// d and lambda are computed from the final set alone, with a factor that is a function of the
/// set alone: same r, same answer to the last bit whatever came before.
/// No allocation in solve() but where DenseLcp or NestedStart takes over. One object belongs to one
/// thread.
class WarmLcp {
 public:
  /// Keeps references. `start`: closed nodes to start from; empty: all. `nested`: of the same
  /// problem, where a load that is far from the one before starts; null: there as well.
  WarmLcp(const DenseLcp& lcp, int max_steps, std::span<const char> start,
          const NestedStart* nested = nullptr);

  /// `r` and `magnitude` as DenseLcp::solve takes them, both given. The rest is valid where the
  /// answer is `solved`, until the next call.
  LcpStatus solve(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude);

  const Eigen::VectorXd& d() const noexcept { return _jump; }           ///< >= 0
  const Eigen::VectorXd& lambda() const noexcept { return _pressure; }  ///< >= 0
  /// max_i |lambda - (S d - r)|_i, relative to the largest of |r| and lambda: what d and lambda,
  /// both clipped at 0, leave of all conditions.
  double residual() const noexcept { return _residual; }
  int steps() const noexcept { return _steps; }
  const std::vector<char>& closed() const noexcept { return _closed; }

 private:
  LcpStatus find_set(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude);
  bool factorise();
  void solve_open();
  Eigen::Index step();
  LcpStatus start_over(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude);
  void close_undecided();
  void finish(const Eigen::VectorXd& r, double unit);

  const DenseLcp& _lcp;
  const NestedStart* const _nested;
  const int _max_steps;
  std::vector<char> _closed, _met;
  // Scaled: unit diagonal, load of size 1. _force is S d - r.
  Eigen::VectorXd _r, _d, _force;
  Eigen::VectorXd _jump, _pressure;
  double _residual = 0;
  int _steps = 0;
  // Cholesky factor of S on the open nodes of `_factored`, lower, (n,n) column-major at the front.
  std::vector<char> _factored;
  std::vector<Eigen::Index> _open;
  Eigen::VectorXd _factor, _right_hand_side;
  bool _regular = false;
};

}  // namespace anticrack::contact
