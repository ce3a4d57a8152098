// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "base/lazy.hpp"
#include "contact/contact_problem.hpp"
#include "contact/nested_start.hpp"

namespace anticrack::contact {

/// The conditions of a ContactProblem with S^ as a dense matrix. Immutable after construction,
/// thread-safe.
class DenseContact {
 public:
  /// `matrix`: S^, shape (c, c). O(c^2).
  DenseContact(Eigen::MatrixXd matrix, const TraceProblem& traces);

  // As the functions of ContactProblem; `motions`: how much the jumps change each sum, shape
  // (sums, c).
  LcpAnswer solve(const Reduced& load, const LcpOptions& options, std::span<const char> start,
                  const OnStep& on_step) const;
  std::vector<Opened> solve_open(const std::vector<char>& closed,
                                 std::span<const Eigen::VectorXd> r) const;
  Eigen::VectorXd apart(const Eigen::MatrixXd& d, const Eigen::MatrixXd& r) const;
  std::unique_ptr<RowContact> rows(const LcpOptions& options, std::span<const char> start,
                                   Eigen::MatrixXd motions, OpenResponses* responses) const;

  const DenseLcp& lcp() const noexcept { return _lcp; }
  std::size_t bytes() const noexcept;

 private:
  const OpenFactor& all_open() const;

  NestedStart _nested_start;
  DenseLcp _lcp;
  base::Lazy<OpenFactor> _all_open;  // factor of the lcp with every contact open
};

}  // namespace anticrack::contact
