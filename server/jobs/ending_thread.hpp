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
  /// Starts the thread; the core must outlive it.
  explicit EndingThread(EngineCore& core);
  /// Joins the thread; EngineCore::quitting must be set.
  ~EndingThread();
  EndingThread(const EndingThread&) = delete;
  EndingThread& operator=(const EndingThread&) = delete;

 private:
  using Lock = EngineCore::Lock;
  using Clock = EngineCore::Clock;

  /// A job's end on its way to the disk.
  struct End {
    JobPtr job;
    store::JobRecord record;
    std::shared_ptr<const store::BlockSource> result;
    std::stop_token stop = {};  ///< of the writing
    Clock::time_point next_try{};

    /// Of a result that will never be written.
    void fail(const std::exception& why);
    void without_result(store::JobState state, const std::optional<errors::Error>& error = {});
  };

  void work();
  End conclude_job(Lock& lock, const JobPtr& job);
  void write(Lock& lock, End end);
  /// False where the store could not take it now. Without the lock.
  bool finish(End& end);
  /// Deletes the meshes that a job with an accuracy made, but that of its answers. Without the
  /// lock.
  void forget_meshes(const LiveJob& job);
  void announce(Lock& lock, const End& end);
  void keep(Lock& lock, End end);
  void leave_to_next_start(Lock& lock, const End& end);
  bool next_waiting(Lock& lock);

  EngineCore& _core;
  std::deque<End> _waiting;  ///< for the store; of this thread alone
  std::thread _thread;
};

}  // namespace anticrack::jobs
