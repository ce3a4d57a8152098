// SPDX-License-Identifier: GPL-3.0-or-later
//
// A sweep while the server works on it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "jobs/result_part.hpp"
#include "jobs/sweep_plan.hpp"

namespace anticrack::operators {
class LoadBasis;
}  // namespace anticrack::operators

namespace anticrack::jobs {

/// The places of a chunk's answers in the job's spool.
struct SweepChunk {
  std::optional<store::Spool::Run> columns;  ///< of chunk_arrays(); empty: not solved
  std::optional<ResultPart> traces;          ///< of the rows that keep traces
};

/// Made when the job starts. Plan and basis do not change once chunks are taken. The engine's mutex
/// guards the chunks until the job ends; then they belong to the thread that ends it.
struct LiveSweep {
  explicit LiveSweep(SweepPlan its_plan) : plan(std::move(its_plan)), chunks(plan.chunks()) {}

  const SweepPlan plan;
  std::shared_ptr<const operators::LoadBasis> basis;  ///< null for nodal forces
  std::vector<SweepChunk> chunks;
};

}  // namespace anticrack::jobs
