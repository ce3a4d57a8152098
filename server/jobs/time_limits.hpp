// SPDX-License-Identifier: GPL-3.0-or-later
//
// The thread that looks at the clock.
#pragma once

#include <thread>

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// Stops jobs that wait or run longer than they may, and offers again those whose start failed.
/// Sleeps until the next of these is due.
class TimeLimits {
 public:
  /// Starts the thread; the core must outlive it.
  explicit TimeLimits(EngineCore& core);
  /// Joins the thread; EngineCore::quitting must be set.
  ~TimeLimits();
  TimeLimits(const TimeLimits&) = delete;
  TimeLimits& operator=(const TimeLimits&) = delete;

 private:
  void work();

  EngineCore& _core;
  std::thread _thread;
};

}  // namespace anticrack::jobs
