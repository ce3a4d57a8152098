// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/contact_blocks.hpp"
#include "contact/contact_problem.hpp"
#include "contact/dense_lcp.hpp"

namespace anticrack::contact {

/// DenseLcp's problem for very many contacts, where S^ is applied and never formed.
///
/// In each step every block solves its own contact problem while the jumps of the others stay,
/// which gives the set of closed contacts; then conjugate gradients, preconditioned by the blocks
/// and the hats, solve for the jumps of the open ones, to a tolerance that falls tenfold a step.
/// When the set no longer changes, conjugate gradients go on to rounding; the answer has d > 0 on
/// the open contacts and lambda >= 0 on the closed ones. If the steps do not settle, primal-dual
/// steps, which open and close single contacts, take over.
///
/// The bits of an answer depend on r and on the start. For one thread.
class BlockLcp {
 public:
  /// Keeps references.
  BlockLcp(const JoinedMembrane& membrane, const ContactBlocks& blocks,
           const Conditions& conditions);

  /// `magnitude`, `start`: as for DenseLcp::solve. With an empty `start` all contacts begin closed,
  /// except those that the problem on the hats opens. Throws errors::Error (limit_exceeded) for
  /// options.tied, of which this method has none.
  LcpAnswer solve(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude,
                  const LcpOptions& options, std::span<const char> start,
                  const OnStep& on_step = {}) const;
  /// As ContactProblem::solve_open.
  Opened solve_open(const Eigen::VectorXd& r, const std::vector<char>& closed,
                    double tolerance = 0) const;

 private:
  class Steps;
  static std::vector<char> of_block(const ContactBlock& block, const std::vector<char>& closed);

  const JoinedMembrane& _membrane;
  const ContactBlocks& _blocks;
  const Conditions& _conditions;
  Eigen::VectorXd _scale;  // per condition, as in DenseLcp
};

}  // namespace anticrack::contact
