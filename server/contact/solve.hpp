// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "contact/answer.hpp"
#include "contact/trace_problem.hpp"
#include "contact/trace_state.hpp"

namespace anticrack::contact {

class ContactProblem;

/// A force on an inclusion with its moments about the inclusion's middle.
struct RigidForce {
  double force = 0;
  double moment_x = 0, moment_y = 0;
};

inline void add(RigidForce& sum, const RigidForce& force, double factor) {
  sum.force += factor * force.force;
  sum.moment_x += factor * force.moment_x;
  sum.moment_y += factor * force.moment_y;
}

/// The force F_j on an inclusion: what acts on its trace nodes, and what only those who hold it
/// feel.
struct InclusionForce {
  RigidForce on_nodes;
  RigidForce on_holders;
};

/// Condensed loads, one per subdomain, and the forces on inclusions, of which on_nodes are already
/// in them (one per inclusion, or none at all).
struct CaseLoads {
  std::span<const ddm::CondensedLoad> subdomains;
  std::span<const InclusionForce> inclusion_forces = {};
};

/// Work of a force on a motion (A, Bx, By).
double work(const RigidForce& force, const Eigen::Ref<const Eigen::Vector3d>& motion);

/// p of a load: the values that are held.
Eigen::VectorXd held_values(const ddm::Decomposition& decomposition,
                            std::span<const ddm::CondensedLoad> loads);

/// The exact contact problem with iterative refinement; one sample a step, whose criterion is that
/// of step 3 of Algorithm 2, 1 in the first (of a joined membrane: the work of the step, of all
/// work). The bits of a condensed problem depend on the final set only, not on `start`: closed
/// contacts (Answer::closed of another load); empty: those that the problem knows. Ends
/// not_converged at max_steps, if a part of the membrane held by contact only is pulled off, or if
/// a relative residual is above solution_residual. Throws errors::Error (numerical) where the
/// energy overflows.
Answer solve_active_set(const ContactProblem& problem, const mesh::Mesh& mesh,
                        const CaseLoads& loads, const ActiveSetOptions& options, bool fields,
                        Observer& observer, std::span<const char> start = {});

/// w of an answer, from its traces. O(n).
Eigen::VectorXd unknowns_of(const ddm::Decomposition& decomposition, const Answer& answer);

/// A load case to recover fields for; its answer has side_traces.
struct SolvedCase {
  std::span<const ddm::CondensedLoad> loads;  ///< one per subdomain
  Answer& answer;
};
/// Fills Answer::fields by backward solves in blocks of columns; the bits of a case do not depend
/// on the others. O(N) each.
void recover_fields(const TraceProblem& problem, std::span<const SolvedCase> cases);

/// Fills an answer from the last state and sample: energy, residuals, traces, contact, inclusions.
/// The resultant on inclusion j is the sum of the fluxes of its sides (its own and, through
/// contact, the delaminated ones), of the load without the force F_j on the inclusion: F_j in the
/// solution unless it is held or shares nodes; the moment is that of the same forces.
void describe(const TraceProblem& problem, const mesh::Mesh& mesh, const CaseLoads& loads,
              const TraceState& state, const Sample& sample, Answer& answer);

/// The relative residuals, for messages.
std::string residuals_of(const Answer& answer);

/// Positions and conditions of the nodes of every interface.
std::vector<TraceGeometry> trace_geometry(const ddm::Decomposition& decomposition,
                                          const mesh::Mesh& mesh);

}  // namespace anticrack::contact
