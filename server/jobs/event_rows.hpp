// SPDX-License-Identifier: GPL-3.0-or-later
//
// Events on their way through a store that several servers share: what jobs here do is written as
// rows, and logs of jobs that run elsewhere are made from rows.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "jobs/live_job.hpp"

namespace anticrack::jobs {

class EngineCore;

/// Thread-safe. No method may be called with EngineCore::mutex held, but follow(id, log).
class EventRows {
 public:
  explicit EventRows(EngineCore& core) : _core(core) {}

  /// Writes what the logs of these jobs have and the store has not, in one statement. Throws
  /// errors::Error.
  void publish(const std::vector<JobPtr>& jobs);

  /// The log of a job that is not live here: one that is followed, or a new one with all rows so
  /// far. `record`: as it is in the store.
  std::shared_ptr<EventLog> follow(const records::JobRecord& record);
  /// Goes on with the log of a job that this server has lost.
  void follow(const std::string& job, const std::shared_ptr<EventLog>& log);

  /// The work of a thread, until EngineCore::quitting: some ten times a second it publishes all
  /// live jobs and catches up with those that are followed.
  void work();

 private:
  struct Followed {
    std::weak_ptr<EventLog> log;
    std::uint64_t after = 0;
  };
  using Logs = std::unordered_map<std::string, std::shared_ptr<EventLog>>;

  void catch_up();
  void catch_up(const Logs& logs);

  EngineCore& _core;
  std::mutex _publishing;  ///< held during the statement
  std::mutex _reading;     ///< held while rows are read and appended
  std::mutex _mutex;       ///< of the map alone
  std::unordered_map<std::string, Followed> _followed;
};

}  // namespace anticrack::jobs
