// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "contact/contact_blocks.hpp"
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
  /// Of all conditions, as in DenseLcp.
  struct Answer {
    LcpStatus status = LcpStatus::step_limit;
    std::vector<char> closed;
    Eigen::VectorXd d;       ///< independent contacts, >= 0
    Eigen::VectorXd lambda;  ///< >= 0
    std::vector<char> pressed;
    int steps = 0;
    int weakly_active = 0;
    int solves = 0;       ///< applications of S^
    double residual = 0;  ///< largest |lambda - (S^ d - r)|, of the largest of |r|
  };
  /// Returns false to stop.
  using OnStep = std::function<bool(const LcpStep&)>;

  /// Keeps references.
  BlockLcp(const JoinedMembrane& membrane, const ContactBlocks& blocks);

  /// `magnitude`, `start`: as for DenseLcp::solve; an empty start: all closed, or what the hats
  /// say.
  Answer solve(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude,
               const LcpOptions& options, std::span<const char> start, const OnStep& on_step) const;

  /// d = 0 on the closed contacts, (S^ d)_i = r_i on the open ones, whatever the signs.
  struct Opened {
    Eigen::VectorXd d;
    Eigen::VectorXd residual;  ///< r - S^ d
    double left = 0;           ///< largest residual on open contacts, of the largest of |r|
  };
  /// `closed`: of all conditions; empty: none is.
  Opened solve_open(const Eigen::VectorXd& r, const std::vector<char>& closed) const;

  /// Jumps of all conditions.
  Eigen::VectorXd jumps(const Eigen::VectorXd& d, const std::vector<char>& closed) const;
  /// lambda of all conditions from S^ d - r.
  Eigen::VectorXd split(const Eigen::VectorXd& force, const std::vector<char>& closed) const;
  Eigen::Index conditions() const noexcept { return _conditions; }

 private:
  class Run;
  static std::vector<char> of_block(const ContactBlock& block, const std::vector<char>& closed);
  /// d, then the dependent ones as they come out.
  Eigen::VectorXd signed_jumps(const Eigen::VectorXd& d) const;

  const JoinedMembrane& _membrane;
  const ContactBlocks& _blocks;
  Eigen::Index _conditions;
  Eigen::VectorXd _scale;  // of the conditions, as DenseLcp's
};

}  // namespace anticrack::contact
