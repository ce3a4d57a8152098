// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rows of a sweep that one thread solves at a time.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "errors/errors.hpp"
#include "jobs/live_job.hpp"
#include "store/store.hpp"

namespace anticrack::jobs {

/// What a thread hands in after work without the lock.
struct EndedChunk {
  Task task;
  SweepChunk solved;  ///< empty where the job was stopped, or it failed
  std::shared_ptr<const contact::SweepColumns> columns;  ///< what was spooled, for the watchers
  records::SweepRecord record;                           ///< of these rows
  std::optional<errors::Error> failure;  ///< of the whole job, e.g. a bad value in the matrix
};

/// Condenses the loads that a job combines. Throws errors::Error with the path in the job
/// ("load_cases[j]..."), cancelled where the job was stopped meanwhile. Without the lock.
std::shared_ptr<const operators::LoadBasis> condense_basis(
    LiveJob& job, const operators::MeshOperator& mesh_operator, const store::Store& store);

/// Reads and solves the rows of chunk `task.index`, and the traces of those that keep them. A stop
/// of the job takes effect between two rows and leaves nothing of the chunk. Throws nothing.
/// Without the lock.
EndedChunk solve_chunk(const Task& task, std::atomic<std::uint64_t>& iterations);

/// Adds the record of some rows to that of others.
void add(records::SweepRecord& sum, const records::SweepRecord& rows);

}  // namespace anticrack::jobs
