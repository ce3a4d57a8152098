// SPDX-License-Identifier: GPL-3.0-or-later
//
// Load cases that iterate Algorithm 2 together, and their jobs.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "jobs/case_outcome.hpp"
#include "operators/uzawa_block.hpp"
#include "records/priority.hpp"

namespace anticrack::jobs {

/// A block of columns. While it is `iterating` it belongs to the thread that works on it. At other
/// times (put down, or while its thread condenses loads for it) any thread that holds the engine's
/// mutex can abandon columns, so that their jobs need not wait for the next iteration.
class BlockRun {
 public:
  /// Throws errors::Error (not_implemented, at "uzawa") if Algorithm 2 does not apply to the mesh.
  BlockRun(const std::shared_ptr<const operators::MeshOperator>& mesh_operator, contact::Mass mass,
           int capacity, std::atomic<std::uint64_t>& iterations);

  // For the thread that works on the block, without the lock:

  /// Adds a load case; there must be a free place. Throws what UzawaBlock::add throws; the task
  /// then stays the caller's.
  void add(const Task& task, operators::PreparedLoad load);
  /// Does one iteration and returns the cases that ended in it. Never throws: a block that breaks
  /// down ends all its columns.
  std::vector<EndedCase> step();

  // With the engine's mutex held, or for the thread that works on the block:

  bool iterating = false;
  records::Priority parked_as =
      records::Priority::normal;  ///< in the schedule, while it is put down
  /// The number of columns that iterate, and of free places.
  int columns() const noexcept { return _columns; }
  int free() const noexcept { return _broken ? 0 : _capacity - _columns; }
  records::Priority priority() const noexcept;  ///< of its most urgent column
  /// Marks the columns of jobs that must stop, so that they end in the next step, and returns their
  /// tasks. Only while the block is not iterating.
  std::vector<Task> abandon_stopped();

 private:
  struct Column {
    Task task;
    History history;
    bool abandoned = false;
  };

  /// Appends the iteration to the logs of the jobs; adjacent columns of one job go in one call.
  void tell();
  static CaseOutcome outcome_of(const Column& column, contact::Answer& answer);
  std::vector<EndedCase> end_all(const std::exception_ptr& failure);

  const int _capacity;
  std::atomic<std::uint64_t>& _iterations;
  std::vector<std::unique_ptr<Column>> _places;  ///< by the block's places
  int _columns = 0;
  bool _broken = false;  ///< the block takes no more columns
  std::vector<SampleEvent> _untold;
  operators::UzawaBlock _block;
};

}  // namespace anticrack::jobs
