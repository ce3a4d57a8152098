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

  /// Per contact, the jumps of the answer and its forces lambda: what jumps and reactions of an
  /// adjoint may be is a multiple of them. Both are 0 or more; lambda is 0 on open contacts, and
  /// where cracks cross.
  struct Room {
    Eigen::VectorXd jumps, forces;
  };
  const Room& room() const noexcept { return _room; }
  /// Jumps of z: those of z_0, of which those of the sign of `sign` are clipped to `room`.
  static Eigen::VectorXd jumps(const Goal& goal, double sign, const Room& room);
  /// Load of z' on the contacts, all of which are open: r plus the reactions, of which those of the
  /// other sign are clipped to `room`.
  static Eigen::VectorXd load(const Goal& goal, double sign, const Room& room);

 private:
  bool _possible = false;
  std::vector<char> _open;  // of the contacts
  Room _room;
};

}  // namespace anticrack::contact
