// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "jobs/live_sweep.hpp"
#include "operators/mesh_operator.hpp"
#include "store/block.hpp"

namespace anticrack::jobs {

/// The arrays of ReadResult for a sweep; null when no row has an answer. Rows that have none have
/// the status `unsolved` and zeros. The chunks are empty after.
std::shared_ptr<const store::Block> sweep_result(const operators::MeshOperator& mesh_operator,
                                                 LiveSweep& sweep, contact::Status unsolved);

}  // namespace anticrack::jobs
