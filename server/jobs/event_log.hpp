// SPDX-License-Identifier: GPL-3.0-or-later
//
// The events of one job, numbered without gaps, in a log of bounded size that any number of
// watchers read, each with its own cursor.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "jobs/memory_budget.hpp"
#include "jobs/sample_run.hpp"
#include "records/job_state.hpp"

namespace anticrack::contact {
struct GrowthRow;
struct SweepColumns;
}  // namespace anticrack::contact

namespace anticrack::records {
struct CaseRecord;
struct JobRecord;
struct StageRecord;
}  // namespace anticrack::records

namespace anticrack::jobs {

/// The job entered another state, or another phase of its state.
struct PhaseEvent {
  records::JobState state = records::JobState::queued;
  std::string detail;  ///< e.g. "meshing"
};

/// A load case ended.
struct CaseEvent {
  std::int32_t load_case = 0;
  std::shared_ptr<const records::CaseRecord> record;
};

/// Consecutive rows of a sweep ended; they are few enough for one message.
struct RowsEvent {
  std::uint64_t first_row = 0;
  std::shared_ptr<const contact::SweepColumns> rows;
};

/// A stage of a job with an accuracy ended; it comes after the ends of the stage's load cases.
struct StageEvent {
  std::shared_ptr<const records::StageRecord> stage;
};

/// Fronts that grow under a load case have been measured in a position, or again with bounds.
struct GrowthEvent {
  std::int32_t load_case = 0;
  std::int32_t number = 0;  ///< of the row
  std::shared_ptr<const contact::GrowthRow> row;
};

/// The job ended. This is always the last event.
struct EndEvent {
  std::shared_ptr<const records::JobRecord> job;
};

using Event =
    std::variant<SampleEvent, PhaseEvent, CaseEvent, RowsEvent, StageEvent, GrowthEvent, EndEvent>;

struct NumberedEvent {
  std::uint64_t sequence = 0;
  Event event;
};

/// Consecutive samples and ends of load cases. Each end comes after the samples of its own load
/// case; its order relative to other load cases is not kept.
struct ProgressEvents {
  std::vector<SampleRun> samples;
  std::vector<CaseEvent> ended;
};

/// The events that a watcher gets in one message: progress of load cases, or one other event.
using Batch =
    std::variant<ProgressEvents, PhaseEvent, RowsEvent, StageEvent, GrowthEvent, EndEvent>;

struct NumberedBatch {
  std::uint64_t last = 0;  ///< sequence of its last event
  Batch events;
};

/// Thread-safe; any number of writers and readers. Each append wakes every listener by one call.
class EventLog {
 public:
  static constexpr std::size_t batch_bytes = std::size_t{64} << 10;
  static constexpr std::size_t least_bytes = std::size_t{64} << 10;

  /// `byte_limit`: if the log is larger, the oldest events are dropped (never the end event). While
  /// `budget`, in which the log is counted, is exceeded, the log keeps only least_bytes. `base`:
  /// the first event gets the number base + 1.
  explicit EventLog(std::size_t byte_limit, std::uint64_t base = 0,
                    std::shared_ptr<MemoryBudget> budget = {});
  ~EventLog();

  /// Appends an event; events after the end event are dropped.
  void append(Event event);
  /// Appends the samples one after the other, with one lock and one wake. O(samples).
  void append(std::span<const SampleEvent> samples);
  /// The next event gets the number `sequence` + 1, if that is not used already. A log with a jump
  /// follows that of another server, so a reader may be ahead of it: he gets what comes after his
  /// number, and numbers that are left out are nobody's loss.
  void jump(std::uint64_t sequence);
  /// The events up to `sequence` that the log does not have will not come: readers of these are
  /// told as if they had been dropped, with all before them.
  void lose(std::uint64_t sequence);
  /// Events after `sequence` are not dropped for the budget, only for `byte_limit`.
  void hold(std::uint64_t sequence);

  std::uint64_t earliest() const;  ///< sequence of the oldest event kept; else latest()+1
  std::uint64_t latest() const;    ///< `base` before the first event
  /// The memory held now, at most about the limit. Data that an event shares (a case's record, the
  /// rows of a sweep) count in full, because the log may be the last holder.
  std::size_t bytes() const;
  bool complete() const;  ///< whether it has the end event, so that latest() no longer changes

  /// The events after `after` that go into one message: at most `count`, with ends of load cases of
  /// about `batch_bytes` at most. If there are none yet, the batch is empty and `last` is `after`.
  /// Copies no sample. O(count / page + ends + log n) in n events. Throws errors::Error
  /// (sequence_trimmed, metadata earliest_sequence and latest_sequence) when event after+1 is no
  /// longer kept, or `after` is larger than latest().
  NumberedBatch batch(std::uint64_t after, std::size_t count) const;
  /// Up to `count` events after `after`, one by one and in order; empty if there are none yet.
  /// Throws as batch() does.
  std::vector<NumberedEvent> read(std::uint64_t after, std::size_t count) const;

  class Listener;
  /// Calls `wake` after each append until the handle is destroyed, on a writer's thread and with no
  /// lock held. No two threads call it at once: the one that is in a call makes another call for
  /// those who append meanwhile. `wake` may append events itself; it must be quick and not throw.
  /// Destroying the handle waits for a running call, unless that call destroys it: so do not
  /// destroy it under a lock that `wake` takes.
  std::shared_ptr<Listener> listen(std::function<void()> wake);

 private:
  struct State;
  std::shared_ptr<State> _state;
};

}  // namespace anticrack::jobs
