// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::ddm {

/// F = T (T'S T)^-1 T', the answer of one subdomain's traces to forces on them while rigid
/// inclusions hold some constant. T maps the skeleton unknowns (values of free trace nodes, then
/// one A_j per inclusion) to the trace: row i has its single 1 in column `skeleton(i)`.
/// What is rigid may lie on both sides of a slit and at its tips.
/// F applied to a load is the paper's section 6 in trace space: the K-orthogonal projection of the
/// unconstrained answer onto K = {constant on gamma}. Without inclusions F = S^-1.
class Flexibility {
 public:
  /// `rigid`: per trace node the inclusion that holds it, or -1. O(n_G^3).
  Flexibility(const Eigen::MatrixXd& schur, std::span<const std::int32_t> rigid);

  /// t = F rhs; `reduced` and `skeleton` are workspace of size skeleton_size(); on return
  /// `skeleton` holds the free values and the A_j. No allocation. O(skeleton_size()^2).
  void apply(const Eigen::VectorXd& rhs, Eigen::VectorXd& reduced, Eigen::VectorXd& skeleton,
             Eigen::VectorXd& trace) const;

  /// Column of A_j in the skeleton, or -1 when inclusion j's plus side is not here.
  Eigen::Index inclusion_column(std::int32_t inclusion) const noexcept;
  Eigen::Index trace_size() const noexcept { return static_cast<Eigen::Index>(_column.size()); }
  Eigen::Index skeleton_size() const noexcept { return _inverse.rows(); }
  std::size_t bytes() const noexcept;

 private:
  std::vector<Eigen::Index> _column;            // of each trace node
  std::vector<Eigen::Index> _inclusion_column;  // of each inclusion up to the last one held
  Eigen::MatrixXd _inverse;                     // (T'S T)^-1
};

}  // namespace anticrack::ddm
