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

  /// t = F rhs, column by column, as one product of matrices; `reduced` and `skeleton` are
  /// workspace with skeleton_size() rows and as many columns. A column's bits may depend on how
  /// many there are, never on what is in the others. No allocation. O(skeleton_size()^2 columns).
  void apply(const Eigen::Ref<const Eigen::MatrixXd>& rhs, Eigen::Ref<Eigen::MatrixXd> reduced,
             Eigen::Ref<Eigen::MatrixXd> skeleton, Eigen::Ref<Eigen::MatrixXd> trace) const;

  /// The sizes of what apply() takes, and the memory of the matrices, bytes.
  Eigen::Index trace_size() const noexcept { return static_cast<Eigen::Index>(_column.size()); }
  Eigen::Index skeleton_size() const noexcept { return _inverse.rows(); }
  std::size_t bytes() const noexcept;

 private:
  std::vector<Eigen::Index> _column;  // of each trace node
  bool _nothing_rigid;
  Eigen::MatrixXd _inverse;  // (T'S T)^-1, symmetric to the bit
};

}  // namespace anticrack::ddm
