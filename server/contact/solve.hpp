// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "contact/observer.hpp"
#include "contact/options.hpp"
#include "contact/trace_problem.hpp"
#include "contact/trace_state.hpp"
#include "contact/traces.hpp"

namespace anticrack::contact {

class ContactProblem;
struct Answer;

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

/// The force F_j on an inclusion: the part that acts on its trace nodes, and the part that goes to
/// whatever holds it.
struct InclusionForce {
  RigidForce on_nodes;
  RigidForce on_holders;
};

/// Condensed loads, one per subdomain, and the forces on inclusions, one per inclusion or none at
/// all. The loads include the forces' on_nodes.
struct CaseLoads {
  std::span<const ddm::CondensedLoad> subdomains;
  std::span<const InclusionForce> inclusion_forces = {};
};

/// Work that a force does on a motion (A, Bx, By).
double work(const RigidForce& force, const Eigen::Ref<const Eigen::Vector3d>& motion);

/// The held values p of a load.
Eigen::VectorXd held_values(const ddm::Decomposition& decomposition,
                            std::span<const ddm::CondensedLoad> loads);

/// Solves the exact contact problem, with iterative refinement. Each step reports a sample; its
/// criterion is that of step 3 of Algorithm 2, 1 in the first step (for a joined membrane: the work
/// of the step relative to all work). `start`: closed contacts to start from (Answer::closed of
/// another load); empty: the problem chooses. `tied`: as in LcpOptions; their pressure may be
/// negative. The bits of a condensed problem depend on the final set only. Ends not_converged at
/// max_steps, if a part of the membrane held by contact only is pulled off, or if a relative
/// residual is above solution_residual. Throws errors::Error (numerical) if the energy overflows.
Answer solve_active_set(const ContactProblem& problem, const mesh::Mesh& mesh,
                        const CaseLoads& loads, const ActiveSetOptions& options, bool fields,
                        Observer& observer, std::span<const char> start = {},
                        std::span<const char> tied = {});

/// The skeleton's values w, from the traces of an answer. O(n).
Eigen::VectorXd unknowns_of(const ddm::Decomposition& decomposition, const Answer& answer);

/// A load case to recover fields for; its answer has side_traces.
struct SolvedCase {
  std::span<const ddm::CondensedLoad> loads;  ///< one per subdomain
  Answer& answer;
};
/// Fills Answer::fields by backward solves in blocks of columns; the bits of a case do not depend
/// on the others. O(N) each.
void recover_fields(const TraceProblem& problem, std::span<const SolvedCase> cases);

/// The same without an answer: `traces` and `u`, on all nodes, of each subdomain.
struct Recovery {
  std::span<const ddm::CondensedLoad> loads;
  std::vector<std::span<const double>> traces;
  std::vector<std::span<double>> u;
};
void recover(const TraceProblem& problem, std::span<const Recovery> cases);

/// Fills an answer from the last state and sample: energy, residuals, traces, contact, inclusions.
/// The resultant on inclusion j is the sum of the fluxes of its sides (its own and, through
/// contact, the delaminated ones), computed without the force F_j in the load. In the solution it
/// equals F_j unless the inclusion is held or shares nodes. The moment is that of the same fluxes.
void describe(const TraceProblem& problem, const mesh::Mesh& mesh, const CaseLoads& loads,
              const TraceState& state, const Sample& sample, Answer& answer);

/// The relative residuals as text, for messages.
std::string residuals_of(const Answer& answer);

/// Positions and conditions of the nodes of every interface.
std::vector<TraceGeometry> trace_geometry(const ddm::Decomposition& decomposition,
                                          const mesh::Mesh& mesh);

}  // namespace anticrack::contact
