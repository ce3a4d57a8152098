// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "contact/answer.hpp"
#include "contact/skeleton_problem.hpp"
#include "contact/trace_problem.hpp"

namespace anticrack::contact {

/// Condensed loads, one per subdomain, and the forces F_j on inclusions that are already in them
/// (one per inclusion, or none at all).
struct CaseLoads {
  std::span<const ddm::CondensedLoad> subdomains;
  std::span<const double> inclusion_forces = {};
};

/// Algorithm 2 from mu_0 = 0 until step 3's criterion is below epsilon (or, with kkt_tolerance, all
/// relative residuals are below that), until it is seen that it cannot converge, until
/// `max_iterations`, or until the observer stops it; then everything an answer carries. Samples
/// measure `equilibrium` in the first, every 64th and the last iteration (with kkt_tolerance also
/// where the other residuals are small) and repeat it in between: it costs as much as an iteration
/// and is zero to rounding. Deterministic. `mesh` is the one that was cut; ddm::uzawa_obstacle must
/// be empty.
Answer solve_uzawa(const TraceProblem& problem, const mesh::Mesh& mesh, const CaseLoads& loads,
                   const UzawaOptions& options, bool fields, Observer& observer);

/// The contact problem exactly, by DenseLcp and a step of iterative refinement. A sample a step;
/// its criterion is that of step 3 of Algorithm 2, 1 in the first step. The answer's bits depend on
/// the final set only, not on `start`: the closed contacts to start from (Answer::closed of another
/// load); empty: those of NestedStart. NOT_CONVERGED when max_steps is reached or when a part of
/// the membrane that is held by contact only is pulled off.
Answer solve_active_set(const SkeletonProblem& problem, const mesh::Mesh& mesh,
                        const CaseLoads& loads, const ActiveSetOptions& options, bool fields,
                        Observer& observer, std::span<const char> start = {});

/// A load case whose answer has side_traces and is to have fields.
struct SolvedCase {
  std::span<const ddm::CondensedLoad> loads;  ///< one per subdomain
  Answer& answer;
};
/// Fills Answer::fields: backward solves of all cases together, in blocks of columns. The bits of
/// one do not depend on the others. O(N) each.
void recover_fields(const TraceProblem& problem, std::span<const SolvedCase> cases);

/// Places and conditions of the nodes of every interface.
std::vector<TraceGeometry> trace_geometry(const ddm::Decomposition& decomposition,
                                          const mesh::Mesh& mesh);

}  // namespace anticrack::contact
