// SPDX-License-Identifier: GPL-3.0-or-later
//
// A sweep while the server works on it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "contact/answer.hpp"
#include "jobs/sweep_plan.hpp"
#include "operators/mesh_operator.hpp"
#include "store/records.hpp"

namespace anticrack::jobs {

struct RowTraces {
  std::uint64_t row = 0;
  std::vector<contact::Trace> traces;
};

/// The answers of a chunk.
struct SweepChunk {
  std::shared_ptr<const contact::SweepColumns> columns;  ///< null: not solved
  std::vector<RowTraces> traces;                         ///< of the rows that keep them
};

/// Made when the job starts. Plan and basis do not change once its chunks are taken; the chunks are
/// guarded by the engine's mutex until the job ends, and belong to the thread that ends it then.
struct LiveSweep {
  explicit LiveSweep(SweepPlan its_plan) : plan(std::move(its_plan)), chunks(plan.chunks()) {}

  const SweepPlan plan;
  std::shared_ptr<const operators::LoadBasis> basis;  ///< null: nodal forces
  std::vector<SweepChunk> chunks;
};

}  // namespace anticrack::jobs
