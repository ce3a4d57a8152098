// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solved portions of sweeps as they lie in the store. A body is a store::disk::SolvedPortion.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "jobs/sweep_chunk.hpp"
#include "store/queue.hpp"

namespace anticrack::jobs {

/// The body of a portion of these chunks, whose answers are in the spool. Throws errors::Error
/// (storage).
std::string pack(const std::vector<std::pair<SweepChunk, records::SweepRecord>>& chunks,
                 const store::Spool& spool);

/// The chunks of a portion, whose answers are put into the job's spool. Throws errors::Error
/// (storage) if the body is none of pack() for this job.
std::vector<EndedChunk> unpack(const store::SolvedPortion& portion, const JobPtr& job);

}  // namespace anticrack::jobs
