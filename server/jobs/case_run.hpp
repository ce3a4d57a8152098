// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "jobs/live_job.hpp"
#include "store/store.hpp"

namespace anticrack::jobs {

struct CaseOutcome {
  std::shared_ptr<const store::CaseRecord> record;
  std::unique_ptr<SolvedCase> solved;  ///< converged and not_converged only
};

/// Memory of an answer's arrays.
std::uint64_t bytes_of(const SolvedCase& solved);

/// The outcome of a load case that is not run because the job's result is large enough.
CaseOutcome refuse_case(std::size_t index, std::uint64_t max_result_bytes);

/// Solves one load case on the calling thread: a sample event an iteration, stopped within one, or
/// soon while the load is integrated. What goes wrong is in the record ("load_cases[i]..." at
/// fault), nothing is thrown.
CaseOutcome run_case(LiveJob& job, std::size_t index, const store::Store& store,
                     std::atomic<std::uint64_t>& iterations);

}  // namespace anticrack::jobs
