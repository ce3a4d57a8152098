// SPDX-License-Identifier: GPL-3.0-or-later
//
// The thread that writes the ends of jobs.
#pragma once

#include <chrono>
#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <stop_token>
#include <thread>

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// Takes the jobs that have nothing left to solve, writes record and result to the store and tells
/// the watchers. What the store cannot take is kept and tried again every second, without holding
/// up other jobs, until it is written, the job is cancelled (then it ends without a result, as it
/// does where it is cancelled while a result is written) or the engine stops (then the next start
/// runs it again).
class EndingThread {
 public:
  /// Starts the thread, which is joined at the end: EngineCore::quitting must be set then. The core
  /// must outlive it.
  explicit EndingThread(EngineCore& core);
  EndingThread(const EndingThread&) = delete;
  EndingThread& operator=(const EndingThread&) = delete;

 private:
  using Lock = EngineCore::Lock;
  using Clock = EngineCore::Clock;

  /// A job's end on its way to the disk.
  struct End {
    JobPtr job;
    records::JobRecord record;
    std::shared_ptr<const records::BlockSource> result;
    std::stop_token stop = {};  ///< of the writing
    Clock::time_point next_try{};

    /// Of a result that will never be written.
    void fail(const std::exception& why);
    void without_result(records::JobState state, const std::optional<errors::Error>& error = {});
  };

  void work();

  // Without the lock:
  End conclude_job(const JobPtr& job);
  void write(End end);
  /// False where the store could not take it now.
  bool finish(End& end);
  /// Deletes the meshes that a job with an accuracy made, but that of its answers.
  void forget_meshes(const LiveJob& job);
  void announce(const End& end);

  // With it:
  void leave_to_next_start(const End& end);
  /// One of those that wait for the store which is due, or can wait no more.
  std::optional<End> next_waiting();

  EngineCore& _core;
  std::deque<End> _waiting;  ///< for the store; of this thread alone
  std::jthread _thread;
};

}  // namespace anticrack::jobs
