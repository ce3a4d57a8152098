// SPDX-License-Identifier: GPL-3.0-or-later
//
// The event logs of jobs that have ended, for watchers who come late.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>

#include "jobs/event_log.hpp"

namespace anticrack::jobs {

/// The first event of attempt n has a number one above this; no attempt has 2^40 events.
constexpr std::uint64_t sequence_base(int attempt) {
  return static_cast<std::uint64_t>(attempt - 1) << 40U;
}

/// The log of a job that ended in the past: only its end event, with a number above all others.
std::shared_ptr<EventLog> end_alone(const records::JobRecord& record);

/// Keeps logs within half of the budget. When the budget is exceeded they make room for new jobs;
/// the oldest go first. Not thread-safe.
class EndedLogs {
 public:
  explicit EndedLogs(std::shared_ptr<const MemoryBudget> budget) : _budget(std::move(budget)) {}

  /// `bytes`: of the log with its end event, which may not have been appended yet.
  void add(const std::string& job, std::shared_ptr<EventLog> log, std::uint64_t bytes);
  void remove(const std::string& job);
  /// Drops logs until `bytes` more fit into the budget, or none is left.
  void make_room(std::uint64_t bytes);
  std::shared_ptr<EventLog> find(const std::string& job) const;  ///< null if it is not kept
  std::uint64_t bytes() const noexcept { return _bytes; }

 private:
  struct Kept {
    std::shared_ptr<EventLog> log;
    std::uint64_t bytes = 0;
  };

  std::shared_ptr<const MemoryBudget> _budget;
  std::uint64_t _bytes = 0;
  std::deque<std::string> _order;  ///< oldest first
  std::unordered_map<std::string, Kept> _logs;
};

}  // namespace anticrack::jobs
