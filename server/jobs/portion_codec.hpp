// SPDX-License-Identifier: GPL-3.0-or-later
//
// Portions as they lie in the store. The body of a solved one is a store::disk::SolvedPortion, of
// growth a SolvedPosition.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "jobs/growth_final.hpp"
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

/// Portion::request, and back. Throws errors::Error (storage,
/// invalid_argument) if it is none.
std::string pack(const PositionRequest& request);
PositionRequest unpack_request(const std::string& request);

/// The body of a position's portion, and back. Throws errors::Error (storage) if it is none under
/// so many `loads`.
std::string pack(const SolvedPosition& position);
SolvedPosition unpack_position(const std::string& body, std::size_t loads);

}  // namespace anticrack::jobs
