// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/dense_lcp.hpp"
#include "contact/nested_start.hpp"

namespace anticrack::contact {

/// DenseLcp for a sequence of r, each started from the closed nodes of the one before: the same
/// primal-dual steps, keeping the factor of the open nodes while they stay the same. An r then
/// costs two triangular solves and a product, O(c^2); a step that changes the set O(c^3). If sets
/// recur, or S is singular on the open nodes, DenseLcp starts over from all closed. d and lambda
/// are computed from the final set alone: same r, same bits, whatever came before. With dependent
/// conditions DenseLcp solves each r. solve() allocates only where DenseLcp or NestedStart takes
/// over. For one thread.
class WarmLcp {
 public:
  /// Keeps references. `start`: closed nodes; empty: all. `nested`: of the same problem, gives the
  /// start for a load far from the one before; may be null.
  /// `tolerance`: of pressed(), as LcpOptions has it.
  WarmLcp(const DenseLcp& lcp, int max_steps, std::span<const char> start,
          const NestedStart* nested = nullptr, double tolerance = LcpOptions{}.tolerance);

  /// `r`, `magnitude`: as for DenseLcp::solve, both given. The results below are valid until the
  /// next call if this returns `solved`.
  LcpStatus solve(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude);

  const Eigen::VectorXd& d() const noexcept { return _jump; }             ///< (c) >= 0
  const Eigen::VectorXd& lambda() const noexcept { return _pressure; }    ///< (conditions) >= 0
  const std::vector<char>& pressed() const noexcept { return _pressed; }  ///< LcpAnswer::pressed
  /// max_i |lambda - (S d - r)|_i over the largest of magnitude and lambda, with d and lambda
  /// clipped at 0.
  double residual() const noexcept { return _residual; }
  int steps() const noexcept { return _steps; }
  const std::vector<char>& closed() const noexcept { return _closed; }

 private:
  LcpStatus find_set(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude);
  /// Factorises S on the open nodes; false if it is singular there.
  bool factorise() { return _open.factorise(_lcp.scaled_matrix(), {}, _closed); }
  void solve_open();
  Eigen::Index step();
  LcpStatus start_over(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude);
  void close_undecided();
  void finish(const Eigen::VectorXd& magnitude, double unit);
  LcpStatus solve_with_rows(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude);

  const DenseLcp& _lcp;
  const NestedStart* const _nested;
  const int _max_steps;
  const double _tolerance;
  std::vector<char> _closed, _met, _pressed;
  // Scaled: unit diagonal, load of size 1. _force is S d - r.
  Eigen::VectorXd _r, _d, _force;
  Eigen::VectorXd _jump, _pressure;
  double _residual = 0;
  int _steps = 0;
  OpenFactor _open;
};

}  // namespace anticrack::contact
