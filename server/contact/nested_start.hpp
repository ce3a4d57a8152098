// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact/dense_lcp.hpp"

namespace anticrack::contact {

/// Where the active set is to start: the same problem with jumps that are linear between every
/// second contact of a crack, solved from the start that the next coarser one gives. The steps of
/// the active set move the ends of a contact zone by a few nodes each; of a coarse problem they
/// cost an eighth or less. Immutable after construction.
class NestedStart {
 public:
  /// `matrix`: S, as DenseLcp takes it. `chains`: contacts that follow each other along a crack,
  /// each contact once. O(c^2).
  NestedStart(const Eigen::MatrixXd& matrix, std::vector<std::vector<std::int32_t>> chains);

  /// Closed contacts to start from; empty where nothing is gained or known. A function of the load
  /// alone. `r`, `magnitude`: as DenseLcp::solve takes them. About a third of a solve.
  std::vector<char> closed(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude) const;

  /// Memory of the levels.
  std::size_t bytes() const noexcept;

 private:
  struct Level {
    Eigen::SparseMatrix<double> prolongation;  // from its jumps to those of the next finer level
    DenseLcp lcp;
  };
  std::vector<Level> _levels;  // from fine to coarse
};

}  // namespace anticrack::contact
