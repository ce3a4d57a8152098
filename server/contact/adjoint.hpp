// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a displacement of an inclusion depends on, around an answer: the adjoint of the contact
// problem with its closed contacts kept, and within the cone of the answer's jumps and pressures.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "contact/contact_problem.hpp"
#include "contact/solve.hpp"

namespace anticrack::contact {

/// Adjoints of one answer of the active set.
class Adjoint {
 public:
  /// Not `possible` where contacts depend on others. O(n).
  Adjoint(const TraceProblem& traces, const Answer& answer);
  bool possible() const noexcept { return _possible; }

  /// z_0 of a unit force: the closed contacts kept, the others open.
  struct Goal {
    const UnitForce* force;
    Eigen::VectorXd jumps, reactions;
    double compliance = 0;  ///< the goal's own displacement: |z_0|^2
  };
  /// `opened`: ContactProblem::solve_open with the answer's closed contacts, for force.r.
  Goal aim(const UnitForce& force, const Opened& opened) const;

  /// Jumps of z: clipped to [-c [u], c [u]].
  Eigen::VectorXd jumps(const Goal& goal, double c) const;
  /// What z' is loaded with, every contact open: r and the reactions, clipped to [-c lambda,
  /// c lambda], where cracks cross to 0.
  Eigen::VectorXd load(const Goal& goal, double c) const;

 private:
  bool _possible = false;
  std::vector<char> _open;          // of the contacts
  Eigen::VectorXd _jumps, _lambda;  // of the answer; lambda 0 where cracks cross
};

}  // namespace anticrack::contact
