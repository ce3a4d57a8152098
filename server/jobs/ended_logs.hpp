// SPDX-License-Identifier: GPL-3.0-or-later
//
// The event logs of jobs that have ended, for watchers who come late.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <unordered_map>

#include "jobs/event_log.hpp"

namespace anticrack::jobs {

/// The first number of attempt n is one above this: there are never 2^40 events.
constexpr std::uint64_t sequence_base(int attempt) {
  return static_cast<std::uint64_t>(attempt - 1) << 40U;
}

/// The log of a job that ended in the past: its end event alone, above all others it had.
std::shared_ptr<EventLog> end_alone(const store::JobRecord& record);

/// Keeps logs under a byte limit: the oldest go first, the newest never. Not thread-safe.
class EndedLogs {
 public:
  explicit EndedLogs(std::uint64_t max_bytes) : _max_bytes(max_bytes) {}

  /// The log has its end event, or nothing but that to come.
  void add(const std::string& job, std::shared_ptr<EventLog> log);
  void remove(const std::string& job);
  std::shared_ptr<EventLog> find(const std::string& job) const;  ///< null: not kept
  std::uint64_t bytes() const noexcept { return _bytes; }

 private:
  struct Kept {
    std::shared_ptr<EventLog> log;
    std::uint64_t bytes = 0;
  };

  std::uint64_t _max_bytes;
  std::uint64_t _bytes = 0;
  std::deque<std::string> _order;  ///< oldest first
  std::unordered_map<std::string, Kept> _logs;
};

}  // namespace anticrack::jobs
