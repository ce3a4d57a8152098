// SPDX-License-Identifier: GPL-3.0-or-later
//
// Contacts kept closed or open whatever the sign of their jumps: the linear problems that adjoints
// are made of, on dense matrices or, where the membrane is joined, by conjugate gradients.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/joined_problem.hpp"
#include "contact/skeleton_problem.hpp"

namespace anticrack::contact {

/// A unit force on a sum of the skeleton's unknowns, every contact closed. Refers to the sum.
struct UnitForce {
  const ddm::Terms* on;
  Eigen::VectorXd r;      ///< per contact
  double compliance = 0;  ///< the sum's own displacement
};
/// O(n^2); of a joined membrane two solves.
UnitForce unit_force(const SkeletonProblem& problem, const ddm::Terms& on);
UnitForce unit_force(const JoinedProblem& problem, const ddm::Terms& on);

/// d = 0 on the closed contacts, (S^ d)_i = r_i on the open ones, to 1e-10 of r where `solved`: not
/// so where nothing but contact holds a part.
struct Opened {
  Eigen::VectorXd d;
  Eigen::VectorXd residual;  ///< r - S^ d: minus the reactions of the closed contacts
  bool solved = true;
};
/// For each r, with its own bits. `closed`: of all conditions, as in LcpStep; empty: none is, which
/// has a factor of its own in a SkeletonProblem. Dense: O(c^3), then O(c^2) each.
std::vector<Opened> solve_open(const SkeletonProblem& problem, const std::vector<char>& closed,
                               std::span<const Eigen::VectorXd> r);
std::vector<Opened> solve_open(const JoinedProblem& problem, const std::vector<char>& closed,
                               std::span<const Eigen::VectorXd> r);

/// A unit force with jumps d.
struct Displaced {
  const ddm::Terms* force;
  Eigen::VectorXd d;
};
/// u of each on the nodes of the subdomains one after another, 0 on the Dirichlet boundary. O(N)
/// each.
std::vector<std::vector<double>> fields_of(const SkeletonProblem& problem,
                                           std::span<const Displaced> displaced);
std::vector<std::vector<double>> fields_of(const JoinedProblem& problem,
                                           std::span<const Displaced> displaced);

}  // namespace anticrack::contact
