// SPDX-License-Identifier: GPL-3.0-or-later
//
// The thread that removes what is too old.
#pragma once

#include <thread>

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// After ends and once a minute results expire and records go as jobs/retention.hpp says; uploads
/// once a minute. Not on the ending thread: each removal waits for the disk, and ends would wait
/// with it.
class RetentionThread {
 public:
  /// Starts the thread; the core must outlive it.
  explicit RetentionThread(EngineCore& core);
  /// Joins the thread; EngineCore::quitting must be set.
  ~RetentionThread();
  RetentionThread(const RetentionThread&) = delete;
  RetentionThread& operator=(const RetentionThread&) = delete;

 private:
  using Lock = EngineCore::Lock;
  using Clock = EngineCore::Clock;

  void work();
  void sweep();

  EngineCore& _core;
  Clock::time_point _next_sweep{};  ///< of uploads
  std::thread _thread;
};

}  // namespace anticrack::jobs
