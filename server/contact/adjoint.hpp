// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a displacement of an inclusion depends on, around an answer: the adjoint of the contact
// problem with its closed contacts kept, and within the cone of the answer's jumps and pressures.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "contact/skeleton_problem.hpp"
#include "contact/solve.hpp"

namespace anticrack::contact {

/// Adjoints of one answer of the active set. Keeps a reference to the problem. Dense, O(c^3) for c
/// contacts.
class Adjoint {
 public:
  /// Contacts up to which the dense factors pay.
  static constexpr Eigen::Index most_contacts = 1000;

  /// None where `possible` is false: too many contacts, contacts that depend on others, or parts
  /// that contact alone holds.
  Adjoint(const SkeletonProblem& problem, const CaseLoads& loads, const Answer& answer);
  bool possible() const noexcept { return _possible; }

  /// Unit force on a sum of the skeleton's unknowns, the goal: z_0 with the closed contacts kept.
  struct Goal {
    SkeletonProblem::Reduced load;
    Eigen::VectorXd jumps;      ///< of z_0
    Eigen::VectorXd reactions;  ///< of z_0
    double compliance = 0;      ///< the goal's own displacement: |z_0|^2
  };
  Goal aim(const ddm::Terms& goal) const;

  /// z with the jumps clipped to [-c [u], c [u]], z' with the reactions clipped to [-c lambda, c
  /// lambda], where cracks cross to 0, and free jumps; w of the skeleton.
  struct Pair {
    Eigen::VectorXd z, reacting;
  };
  Pair clipped(const Goal& goal, double c) const;

 private:
  const SkeletonProblem& _problem;
  bool _possible = false;
  Eigen::VectorXd _jumps, _lambda;  // of the answer; lambda 0 where cracks cross
  std::vector<Eigen::Index> _open;
  Eigen::LLT<Eigen::MatrixXd> _of_open, _of_all;  // of S, scaled
};

}  // namespace anticrack::contact
