// SPDX-License-Identifier: GPL-3.0-or-later
//
// The engine of one of several servers on a store: it claims jobs from their queue as it has room,
// shows that it lives, and drops what it has lost.
#pragma once

#include <string>
#include <thread>

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

class Claims {
 public:
  /// Starts the threads. The core must outlive this object and have a queue; EngineCore::quitting
  /// must be set when it is destroyed.
  explicit Claims(EngineCore& core);
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  /// Gives back the jobs of this server that are no longer live here. EngineCore::draining must be
  /// set. Without the lock.
  void give_back();
  /// Gives back the rest and leaves the group.
  void leave();

 private:
  void claim();
  void beat();

  EngineCore& _core;
  std::jthread _claiming, _beating, _telling, _spreading;
};

/// Stops a job that is live here or waits in the queue; otherwise asks its runner to. Without the
/// lock; throws errors::Error.
void cancel_in_group(EngineCore& core, const std::string& id);

}  // namespace anticrack::jobs
