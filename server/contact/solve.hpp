// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "contact/answer.hpp"
#include "contact/trace_problem.hpp"

namespace anticrack::contact {

/// Algorithm 2 from mu_0 = 0 until step 3's criterion is below epsilon, until it is seen that it
/// cannot converge, until `max_iterations`, or until the observer stops it; then everything an
/// answer carries. Samples measure `equilibrium` in the first, every 64th and the last iteration
/// and repeat it in between: it costs as much as an iteration and is zero to rounding.
/// `loads`: one per subdomain. Deterministic. `mesh` is the one that was cut.
Answer solve_uzawa(const TraceProblem& problem, const mesh::Mesh& mesh,
                   std::span<const ddm::CondensedLoad> loads, const UzawaOptions& options,
                   bool fields, Observer& observer);

/// Places and conditions of the nodes of every interface.
std::vector<TraceGeometry> trace_geometry(const ddm::Decomposition& decomposition,
                                          const mesh::Mesh& mesh);

}  // namespace anticrack::contact
