// SPDX-License-Identifier: GPL-3.0-or-later
//
// Events as rows of the store, from which other servers serve their watchers. A body is a
// v1::WatchJobResponse with what a watcher gets; its `sequence` is the number of the row's first
// event.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "jobs/event_log.hpp"
#include "store/queue.hpp"

namespace anticrack::v1 {
class WatchJobResponse;
}  // namespace anticrack::v1

namespace anticrack::jobs {

/// An event as a watcher gets it; `to` is empty.
void write(const PhaseEvent& phase, v1::WatchJobResponse& to);
void write(const RowsEvent& event, v1::WatchJobResponse& to);
void write(const StageEvent& event, v1::WatchJobResponse& to);
void write(const GrowthEvent& event, v1::WatchJobResponse& to);

/// Most samples of a load case in a row; of more, every n-th and the last are kept.
constexpr std::size_t samples_a_row = 64;

/// The events, consecutive and without the end event, as rows: one for each run of samples, thinned
/// (samples_a_row), and one for each other event. Events keep their numbers; thinned samples have
/// the last numbers of their run, so whoever was within the run misses none. O(events).
std::vector<store::EventRow> pack(const std::string& job, int attempt,
                                  std::span<const NumberedEvent> events);

/// Appends the events of a row with their numbers. Those between the log's last event and a row of
/// the same attempt that does not follow it are lost (EventLog::lose), as is what is damaged.
void unpack(const store::EventRow& row, EventLog& log);

}  // namespace anticrack::jobs
