// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "contact/answer.hpp"
#include "contact/trace_problem.hpp"
#include "contact/trace_state.hpp"

namespace anticrack::contact {

/// Fills traces, contact and inclusions from the last state. The resultant on inclusion j is the
/// sum of the fluxes of all sides that hang on A_j in the forest (its own, and through contact the
/// delaminated ones), of the load without the force F_j on the inclusion: F_j in the solution.
/// `inclusion_forces`: F_j, in the condensed loads; empty for none.
void describe(const TraceProblem& problem, const mesh::Mesh& mesh,
              std::span<const ddm::CondensedLoad> loads, std::span<const double> inclusion_forces,
              const TraceState& state, Answer& answer);

}  // namespace anticrack::contact
