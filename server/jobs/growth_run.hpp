// SPDX-License-Identifier: GPL-3.0-or-later
//
// Growth of cracks and delaminations under a load case.
#pragma once

#include "jobs/engine_core.hpp"

namespace anticrack::contact {
struct Answer;
class Observer;
}  // namespace anticrack::contact

namespace anticrack::jobs {

/// Throws errors::Error (invalid_argument, limit_exceeded, expression_invalid) with the field, for
/// what needs no mesh.
void check_growth(const records::JobSpec& spec, const EngineOptions& options);

/// The answer of the first state with the rows of growth, each of which the job's log hears of as
/// it comes. Throws errors::Error at "growth...": as operators::Growth, and invalid_argument for an
/// unknown inclusion; as add_final; cancelled.
contact::Answer grow(const PreparedCase& prepared, EngineCore& core, contact::Observer& observer);

}  // namespace anticrack::jobs
