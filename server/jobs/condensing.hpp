// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

struct Condensed {
  std::vector<PreparedCase> prepared;
  std::vector<EndedCase> ended;  ///< cases whose loads have errors
};

/// Condenses the loads of the cases with one pass over the factors of their mesh. If a job is
/// stopped meanwhile, its cases are taken out and the others are condensed again. Throws nothing.
/// Call it without the lock.
Condensed condense(const operators::MeshOperator& mesh_operator, const std::vector<Task>& tasks,
                   const store::Store& store);

}  // namespace anticrack::jobs
