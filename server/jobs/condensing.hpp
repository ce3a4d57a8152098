// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "jobs/block_run.hpp"
#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

struct Condensed {
  std::vector<PreparedCase> prepared;
  std::vector<EndedCase> ended;  ///< what was wrong with a load is the end of its case
};

/// Condenses the loads of the cases with one pass over the factors of their mesh. A job that is
/// stopped meanwhile takes its own cases out: the others are condensed again, without them. Throws
/// nothing. Without a lock.
Condensed condense(const operators::MeshOperator& mesh_operator, const std::vector<Task>& tasks,
                   const store::Store& store);

}  // namespace anticrack::jobs
