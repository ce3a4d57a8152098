// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact/dense_lcp.hpp"

namespace anticrack::contact {

/// Finds a start for the active set: solves the same problem with jumps that are linear between
/// every second contact of a crack, itself started from the next coarser problem. A step of the
/// active set moves the ends of a contact zone by a few nodes only; in a coarse problem it costs an
/// eighth or less. Immutable after construction.
class NestedStart {
 public:
  /// `matrix`: S, as for DenseLcp. `chains`: contacts in their order along each crack, each contact
  /// once. O(c^2).
  NestedStart(const Eigen::MatrixXd& matrix, std::vector<std::vector<std::int32_t>> chains);

  /// Closed contacts to start from; empty if the coarse problems are of no help. Depends on the
  /// load alone. `r`, `magnitude`: as for DenseLcp::solve. Takes about a third of the time of a
  /// solve.
  std::vector<char> closed(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude) const;

  /// Memory of the levels in bytes.
  std::size_t bytes() const noexcept;

 private:
  struct Level {
    Eigen::SparseMatrix<double> prolongation;  // from its jumps to those of the next finer level
    DenseLcp lcp;
  };
  std::vector<Level> _levels;  // from fine to coarse
};

}  // namespace anticrack::contact
