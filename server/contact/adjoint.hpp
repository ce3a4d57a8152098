// SPDX-License-Identifier: GPL-3.0-or-later
//
// The adjoint of a contact problem at an answer tells how a displacement of an inclusion depends on
// the load: the closed contacts stay closed, and the adjoint stays in the cone of the answer's
// jumps and pressures.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "contact/contact_problem.hpp"
#include "contact/solve.hpp"

namespace anticrack::contact {

/// Adjoints of one answer of the active set method.
class Adjoint {
 public:
  /// `possible` is false if the mesh has dependent contacts (ddm::Skeleton::dependent). O(n).
  Adjoint(const TraceProblem& traces, const Answer& answer);
  bool possible() const noexcept { return _possible; }

  /// z_0, the response to a unit force: the closed contacts stay closed, the others are open.
  struct Goal {
    const UnitForce* force;
    Eigen::VectorXd jumps, reactions;
    double compliance = 0;  ///< the goal's own displacement: |z_0|^2
  };
  /// `opened`: from ContactProblem::solve_open for force.r and the answer's closed contacts.
  Goal aim(const UnitForce& force, const Opened& opened) const;

  /// Jumps of z: those of z_0, clipped to [-c [u], c [u]].
  Eigen::VectorXd jumps(const Goal& goal, double c) const;
  /// Load of z' on the contacts, all of which are open: r plus the reactions clipped to [-c lambda,
  /// c lambda], and to 0 where cracks cross.
  Eigen::VectorXd load(const Goal& goal, double c) const;

 private:
  bool _possible = false;
  std::vector<char> _open;          // of the contacts
  Eigen::VectorXd _jumps, _lambda;  // of the answer; lambda 0 where cracks cross
};

}  // namespace anticrack::contact
