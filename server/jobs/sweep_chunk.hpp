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

/// A chunk, or a position of growth, that has ended; a thread reports it after its work without the
/// lock.
struct EndedChunk {
  Task task;
  SweepChunk solved{};  ///< empty if the job was stopped or the chunk failed
  std::shared_ptr<const contact::SweepColumns> columns{};  ///< the spooled rows, for watchers
  records::SweepRecord record{};                           ///< sums over these rows
  std::optional<errors::Error> failure{};  ///< ends the whole job, e.g. a bad value in the matrix
  bool fetched = false;                    ///< another server solved it
  std::optional<std::string> position{};   ///< the answer to a position, packed
};

/// Condenses the loads that a job combines. Throws errors::Error with the path in the job
/// ("load_cases[j]..."), cancelled if the job is stopped meanwhile. Without the lock.
std::shared_ptr<const operators::LoadBasis> condense_basis(
    LiveJob& job, const operators::MeshOperator& mesh_operator, const store::Store& store);

/// Reads and solves the rows of chunk `task.index`, and the traces of rows that keep them. A stop
/// of the job takes effect between two rows, and the whole chunk is dropped. Throws nothing.
/// Without the lock.
EndedChunk solve_chunk(const Task& task, std::atomic<std::uint64_t>& iterations);

/// Adds the sums over some rows to others.
void add(records::SweepRecord& sum, const records::SweepRecord& rows);

}  // namespace anticrack::jobs
