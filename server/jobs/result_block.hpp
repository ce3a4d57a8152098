// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "jobs/live_job.hpp"
#include "operators/mesh_operator.hpp"
#include "store/block.hpp"

namespace anticrack::jobs {

/// The arrays of ReadResult for the cases that have an answer; null when none has. The answers are
/// freed on the way, so that they and the block are not all in memory at once.
std::shared_ptr<const store::Block> result_block(const operators::MeshOperator& mesh_operator,
                                                 std::vector<LiveCase>& cases);

/// Throws errors::Error (limit_exceeded, at load_cases or sweep.traces) where the result of the job
/// would have more than `max_arrays` arrays on a mesh of that many interfaces and subdomains.
void require_result_arrays(const store::JobSpec& spec, std::uint64_t interfaces,
                           std::uint64_t subdomains, std::uint64_t max_arrays);

}  // namespace anticrack::jobs
