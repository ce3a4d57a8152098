// SPDX-License-Identifier: GPL-3.0-or-later
//
// Load cases that iterate Algorithm 2 together, with the jobs they belong to.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "jobs/case_outcome.hpp"
#include "operators/mesh_operator.hpp"

namespace anticrack::jobs {

/// What a thread hands in after work without the lock.
struct EndedCase {
  Task task;
  CaseOutcome outcome;
};

/// A block of columns. While it is `iterating` it belongs to the thread that works on it; at other
/// times (put down, or while its thread condenses loads for it) its columns can be abandoned by
/// any thread that holds the engine's mutex: their jobs need not wait for the next iteration.
class BlockRun {
 public:
  /// Throws errors::Error (not_implemented, at "uzawa") where Algorithm 2 does not apply.
  BlockRun(const std::shared_ptr<const operators::MeshOperator>& mesh_operator, contact::Mass mass,
           int capacity, std::atomic<std::uint64_t>& iterations);

  // For the thread that works on it, without the lock:

  /// There must be a free place. Throws what UzawaBlock::add throws; the task is the caller's then.
  void add(const Task& task, operators::PreparedLoad load);
  /// One iteration; what ended in it. Never throws: a block that breaks down ends all its columns.
  std::vector<EndedCase> step();

  // With the engine's mutex held, or by the thread that works on it:

  bool iterating = false;
  records::Priority parked_as =
      records::Priority::normal;  ///< in the schedule, while it is put down
  /// Columns under way, and places for more.
  int columns() const noexcept { return _columns; }
  int free() const noexcept { return _broken ? 0 : _capacity - _columns; }
  records::Priority priority() const noexcept;  ///< of its most urgent column
  /// Marks the columns of jobs that must stop, which end in the next step; returns their
  /// tasks. Only while it is not iterating.
  std::vector<Task> abandon_stopped();

 private:
  struct Column {
    Task task;
    History history;
    bool abandoned = false;
  };

  /// Tells the jobs' logs of the iteration, at once for columns of one job that lie together.
  void tell();
  static CaseOutcome outcome_of(const Column& column, const contact::Answer& answer);
  std::vector<EndedCase> end_all(const std::exception_ptr& failure);

  const int _capacity;
  std::atomic<std::uint64_t>& _iterations;
  std::vector<std::unique_ptr<Column>> _places;  ///< by the block's places
  int _columns = 0;
  bool _broken = false;  ///< takes no more columns
  std::vector<SampleEvent> _untold;
  operators::UzawaBlock _block;
};

}  // namespace anticrack::jobs
