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

#include "contact/answer.hpp"
#include "jobs/memory_budget.hpp"
#include "jobs/sample_run.hpp"
#include "records/records.hpp"

namespace anticrack::jobs {

/// The job passed into another state, or another phase of it.
struct PhaseEvent {
  records::JobState state = records::JobState::queued;
  std::string detail;  ///< e.g. "meshing"
};

/// A load case ended.
struct CaseEvent {
  std::int32_t load_case = 0;
  std::shared_ptr<const records::CaseRecord> record;
};

/// Consecutive rows of a sweep have ended; few enough to travel in one message.
struct RowsEvent {
  std::uint64_t first_row = 0;
  std::shared_ptr<const contact::SweepColumns> rows;
};

/// A stage of a job with an accuracy ended, after its load cases.
struct StageEvent {
  std::shared_ptr<const records::StageRecord> stage;
};

/// The job ended: always the last event.
struct EndEvent {
  std::shared_ptr<const records::JobRecord> job;
};

using Event = std::variant<SampleEvent, PhaseEvent, CaseEvent, RowsEvent, StageEvent, EndEvent>;

struct NumberedEvent {
  std::uint64_t sequence = 0;
  Event event;
};

/// Samples and ends of load cases that follow each other. Each end belongs after the samples of its
/// load case, wherever it stood among those of others.
struct ProgressEvents {
  std::vector<SampleRun> samples;
  std::vector<CaseEvent> ended;
};

/// What goes to a watcher in one message: the progress of load cases, or one other event.
using Batch = std::variant<ProgressEvents, PhaseEvent, RowsEvent, StageEvent, EndEvent>;

struct NumberedBatch {
  std::uint64_t last = 0;  ///< sequence of its last event
  Batch events;
};

/// Thread-safe; any number of writers and readers. A listener costs a writer one wake call an
/// append.
class EventLog {
 public:
  static constexpr std::size_t batch_bytes = std::size_t{64} << 10;
  static constexpr std::size_t least_bytes = std::size_t{64} << 10;

  /// `byte_limit`: the oldest events go when the log is larger (the end event never). While
  /// `budget`, which counts the log, is exceeded, the log keeps least_bytes.
  /// `base`: the first event has the number after it.
  explicit EventLog(std::size_t byte_limit, std::uint64_t base = 0,
                    std::shared_ptr<MemoryBudget> budget = {});
  ~EventLog();

  /// Nothing comes after the end event: what is appended then is dropped.
  void append(Event event);
  /// The same as each of them after the other, for one lock and one wake. O(samples).
  void append(std::span<const SampleEvent> samples);

  std::uint64_t earliest() const;  ///< sequence of the oldest event kept; latest()+1 when none is
  std::uint64_t latest() const;    ///< the base before the first
  /// Held now, at most about the limit. What an event shares with others (a case's record,
  /// the rows of a sweep) counts in full, because the log may be the last to hold it.
  std::size_t bytes() const;
  bool complete() const;  ///< the end event is in it: latest() stays what it is

  /// The events after `after` that go together, at most `count` of them, and not many more ends of
  /// load cases than take `batch_bytes`; no samples, and `last` is `after`, when there is none yet.
  /// Copies no sample. O(count / page + ends + log n) in n events.
  /// Throws errors::Error (sequence_trimmed, metadata earliest_sequence and latest_sequence) when
  /// event after+1 is no longer kept, or `after` is larger than latest().
  NumberedBatch batch(std::uint64_t after, std::size_t count) const;
  /// Up to `count` events after `after` one by one, in order. Empty when there is none yet. Throws
  /// like batch().
  std::vector<NumberedEvent> read(std::uint64_t after, std::size_t count) const;

  class Listener;
  /// `wake` is called after each append until the handle is destroyed, on a writer's thread and
  /// with no lock held; never by two at once: one call under way goes on for all who append
  /// meanwhile. It may append itself; it must be quick and not throw. Destroying the handle waits
  /// for a call under way, unless it is destroyed by that call: do not destroy it under a lock that
  /// `wake` takes.
  std::shared_ptr<Listener> listen(std::function<void()> wake);

 private:
  struct State;
  std::shared_ptr<State> _state;
};

}  // namespace anticrack::jobs
