// SPDX-License-Identifier: GPL-3.0-or-later
//
// The adjoint of a contact problem at an answer tells how a displacement of an inclusion depends on
// the load: the closed contacts stay closed, and the adjoint stays in the cone of the answer's
// jumps and pressures.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/contact_problem.hpp"

namespace anticrack::contact {

/// Adjoints of one answer of the active set method. Where cracks cross, a contact that depends on
/// others (ddm::Skeleton::dependent) has a jump and a force as they have. Keeps references.
class Adjoint {
 public:
  /// `closed`: Answer::closed.
  Adjoint(const Conditions& conditions, const std::vector<char>& closed)
      : _conditions(conditions), _closed(closed) {}

  /// z_0, the response to a unit force: the closed contacts stay closed, the others are open.
  struct Goal {
    const UnitForce* force;
    Eigen::VectorXd jumps;      ///< per contact
    Eigen::VectorXd reactions;  ///< per condition
    double compliance = 0;      ///< the goal's own displacement: |z_0|^2
  };
  /// `opened`: from ContactProblem::solve_open for force.r and the answer's closed contacts.
  Goal aim(const UnitForce& force, const Opened& opened) const;

  /// Per condition, what jumps and forces of an adjoint may be; 0 or more.
  struct Room {
    Eigen::VectorXd jumps, forces;
  };
  /// Jumps of z: those of z_0, of which those of the sign of `sign` are clipped to `room`. Where a
  /// dependent contact would leave it, all jumps of its node are scaled down.
  Eigen::VectorXd jumps(const Goal& goal, double sign, const Room& room) const;
  /// Reactions of z', per condition: those of z_0, of which those of the other sign are clipped.
  Eigen::VectorXd reactions(const Goal& goal, double sign, const Room& room) const;
  /// Load of z' on the contacts, all of which are open: r plus the reactions.
  Eigen::VectorXd load(const Goal& goal, double sign, const Room& room) const;

  /// For each c, what is clipped if the room is c times `room`: of the jumps, and of the load.
  struct Clippings {
    Eigen::MatrixXd jumps, load;
  };
  Clippings clippings(const Goal& goal, double sign, const Room& room,
                      std::span<const double> c) const;

 private:
  Eigen::VectorXd on_contacts(const Eigen::VectorXd& reactions) const;

  const Conditions& _conditions;
  const std::vector<char>& _closed;
};

}  // namespace anticrack::contact
