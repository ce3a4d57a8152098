// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::ddm {

/// F = T (T'S T)^-1 T': the response of one subdomain's traces to forces while rigid inclusions
/// hold some of them constant. T maps the skeleton unknowns (free trace nodes, then one A_j per
/// inclusion) to the trace, one 1 per row. Rigid nodes may lie on both sides of a slit and at its
/// tips. Applying F is section 6 of the paper in trace space: the K-orthogonal projection of the
/// unconstrained response onto K = {constant on gamma}. Without inclusions F = S^-1.
class Flexibility {
 public:
  /// `rigid`: per trace node the inclusion that holds it constant, or -1. O(n_G^3).
  Flexibility(const Eigen::MatrixXd& schur, std::span<const std::int32_t> rigid);

  /// t = F rhs as one matrix product. `reduced`, `skeleton`: workspace, (skeleton_size(), columns).
  /// The bits of a column may depend on the number of columns, but not on the other columns. No
  /// allocation. O(skeleton_size()^2 columns).
  void apply(const Eigen::Ref<const Eigen::MatrixXd>& rhs, Eigen::Ref<Eigen::MatrixXd> reduced,
             Eigen::Ref<Eigen::MatrixXd> skeleton, Eigen::Ref<Eigen::MatrixXd> trace) const;

  /// The sizes of the arguments of apply(), and the memory of the matrices in bytes.
  Eigen::Index trace_size() const noexcept { return static_cast<Eigen::Index>(_column.size()); }
  Eigen::Index skeleton_size() const noexcept { return _inverse.rows(); }
  std::size_t bytes() const noexcept;

 private:
  std::vector<Eigen::Index> _column;  // column of T for each trace node
  bool _nothing_rigid;
  Eigen::MatrixXd _inverse;  // (T'S T)^-1, symmetric to the bit
};

}  // namespace anticrack::ddm
