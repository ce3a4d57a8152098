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
/// the watchers. If the store cannot take an end, it is kept and tried again every second, without
/// holding up other jobs, until it is written, the job is cancelled (then it ends without a result,
/// as when it is cancelled while the result is written) or the engine stops (then the next start
/// runs the job again).
class EndingThread {
 public:
  /// Starts the thread. The destructor joins it; EngineCore::quitting must be set by then. The core
  /// must outlive this object.
  explicit EndingThread(EngineCore& core);
  EndingThread(const EndingThread&) = delete;
  EndingThread& operator=(const EndingThread&) = delete;

 private:
  using Lock = EngineCore::Lock;
  using Clock = EngineCore::Clock;

  /// The end of a job that is to be written to the disk.
  struct End {
    JobPtr job;
    records::JobRecord record;
    std::shared_ptr<const records::BlockSource> result;
    std::stop_token stop = {};  ///< stops the writing
    bool taken = false;         ///< another server has the job
    Clock::time_point next_try{};

    /// Makes the job fail, as its result can never be written.
    void fail(const std::exception& why);
    void without_result(records::JobState state, const std::optional<errors::Error>& error = {});
  };

  void work();

  // Without the lock:
  End conclude_job(const JobPtr& job);
  void write(End end);
  /// Writes the end; returns false if the store could not take it now.
  bool finish(End& end);
  /// Deletes the meshes that a job with an accuracy made, except the one of its answers.
  void forget_meshes(const LiveJob& job);
  void announce(const End& end);

  // With the lock held:
  void leave_to_next_start(const End& end);
  /// Takes an end that waits for the store and is due now, or must not wait any longer.
  std::optional<End> next_waiting();

  EngineCore& _core;
  std::deque<End> _waiting;  ///< ends that wait for the store; used by this thread alone
  std::jthread _thread;
};

}  // namespace anticrack::jobs
