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
/// Each step: every block solves its own contact problem with the others as they are, which gives
/// the set of closed contacts; then conjugate gradients for the open ones, preconditioned by the
/// blocks and the hats, to a tolerance that falls tenfold a step. Where the set no longer changes,
/// conjugate gradients go on to rounding; the answer has d > 0 on the open contacts and lambda >= 0
/// on the closed ones. Should the steps not settle, those of the primal-dual method take over,
/// which look at single contacts.
///
/// Bits depend on r and on the start. For one thread.
class BlockLcp {
 public:
  /// Keeps references.
  BlockLcp(const JoinedMembrane& membrane, const ContactBlocks& blocks,
           const Conditions& conditions);

  /// `magnitude`, `start`: as for DenseLcp::solve; an empty start: all closed, or what the hats
  /// say.
  LcpAnswer solve(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude,
                  const LcpOptions& options, std::span<const char> start,
                  const OnStep& on_step = {}) const;
  /// As ContactProblem::solve_open.
  Opened solve_open(const Eigen::VectorXd& r, const std::vector<char>& closed) const;

 private:
  class Steps;
  static std::vector<char> of_block(const ContactBlock& block, const std::vector<char>& closed);

  const JoinedMembrane& _membrane;
  const ContactBlocks& _blocks;
  const Conditions& _conditions;
  Eigen::VectorXd _scale;  // of the conditions, as DenseLcp's
};

}  // namespace anticrack::contact
