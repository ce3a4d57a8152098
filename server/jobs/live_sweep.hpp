// SPDX-License-Identifier: GPL-3.0-or-later
//
// A sweep while the server works on it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "jobs/result_part.hpp"
#include "jobs/sweep_plan.hpp"
#include "records/job_record.hpp"

namespace anticrack::operators {
class LoadBasis;
}  // namespace anticrack::operators

namespace anticrack::jobs {

/// The places of a chunk's answers in the job's spool.
struct SweepChunk {
  std::optional<store::Spool::Run> columns;  ///< of chunk_arrays(); empty: not solved
  std::optional<ResultPart> traces;          ///< of the rows that keep traces
};

/// What one of several servers does of a sweep (jobs/spreading.hpp). Portions are named by number.
struct SpreadSweep {
  bool ready = false;    ///< the job has started, so its chunks can be solved
  bool offered = false;  ///< the store has the portions; only of the server that runs the job
  std::vector<std::size_t> units{};                    ///< chunks to solve here, in this order
  std::map<std::uint64_t, std::size_t> open{};         ///< portions here: chunks that are left
  std::map<std::size_t, records::SweepRecord> sums{};  ///< of chunks that are not in the store yet
  std::set<std::uint64_t> unwritten{};                 ///< portions solved here, not in the store
  std::set<std::uint64_t> known{};                     ///< portions whose rows are in the result
  std::chrono::steady_clock::time_point begun{};       ///< when it was made ready
  std::chrono::steady_clock::time_point looked{};      ///< when the store was last asked for news
  std::chrono::steady_clock::time_point served{};      ///< when a thread was last seen on a chunk
};

/// Made when the job starts. Plan and basis do not change once chunks are taken. The engine's mutex
/// guards the chunks until the job ends; then they belong to the thread that ends it.
struct LiveSweep {
  explicit LiveSweep(SweepPlan its_plan) : plan(std::move(its_plan)), chunks(plan.chunks()) {}

  const SweepPlan plan;
  std::shared_ptr<const operators::LoadBasis> basis;  ///< null for nodal forces
  std::vector<SweepChunk> chunks;
  std::unique_ptr<SpreadSweep> spread;  ///< null: this server solves all of it
};

}  // namespace anticrack::jobs
