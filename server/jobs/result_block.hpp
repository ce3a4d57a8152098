// SPDX-License-Identifier: GPL-3.0-or-later
//
// The result of a job of load cases. Each case's arrays go into the job's spool when it ends, so
// that no more answers are in memory than cases are solved at once.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "jobs/live_job.hpp"
#include "records/block.hpp"

namespace anticrack::contact {
struct Answer;
struct Sample;
}  // namespace anticrack::contact

namespace anticrack::jobs {

/// Traces, history, fields, indicator and flux (may be empty) of a load case; the arrays' names
/// have the index of the case.
records::Block case_arrays(std::size_t index, const contact::Answer& answer,
                           const std::vector<contact::Sample>& history,
                           const std::vector<double>& indicator = {},
                           const std::vector<double>& balanced_flux = {});

/// The arrays of ReadResult for the cases that have an answer, in their order; null if none has.
/// Throws errors::Error (storage).
std::shared_ptr<const records::BlockSource> result_block(const LiveJob& job);

/// Throws errors::Error (limit_exceeded, at load_cases or sweep.traces) if the job's result would
/// have more than `max_arrays` arrays on a mesh of that many interfaces and subdomains.
void require_result_arrays(const records::JobSpec& spec, std::uint64_t interfaces,
                           std::uint64_t subdomains, std::uint64_t max_arrays);

/// Most bytes of the answers of a job, which are in one message with its definition.
constexpr std::uint64_t max_answer_bytes = std::uint64_t{5} << 19U;

/// Throws errors::Error (limit_exceeded, at load_cases) if the job's answers on a mesh with these
/// inclusions may take more than max_answer_bytes.
void require_answers(const records::JobSpec& spec, const std::vector<std::string>& inclusions);

/// Whether the numbers of that many parts of the boundary and tips may be in each of the job's
/// answers as well. What a load case keeps of them is in memory and in the log of events until the
/// job is removed.
bool has_room(const records::JobSpec& spec, const std::vector<std::string>& inclusions,
              std::size_t parts, std::size_t tips);

}  // namespace anticrack::jobs
