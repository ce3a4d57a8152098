// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <vector>

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// Takes the first prepared case and, if it needs fields, the next ones that need them too, up to
/// an equal `share` of all, since fields are recovered in blocks.
std::vector<PreparedCase> take_together(std::deque<PreparedCase>& prepared, int share);

/// Solves each case by the active set, then recovers the fields of all that need them in one pass
/// over the factors, and computes the bounds from the fields. All cases must be on one mesh. The
/// bits of a case do not depend on the others. Throws nothing. Call it without the lock.
std::vector<EndedCase> solve_exactly(const std::vector<PreparedCase>& cases, EngineCore& core);

}  // namespace anticrack::jobs
