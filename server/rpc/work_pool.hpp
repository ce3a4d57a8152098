// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where calls do what takes longer than gRPC's few threads may be held: the disk, and checks of
// large requests.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "access/turn_queue.hpp"

namespace anticrack::rpc {

/// A few threads that take clients' tasks in turns, those of one client in order: one that waits
/// for the disk holds up no other, and the store writes what several wait for in one go.
/// Thread-safe.
class WorkPool {
 public:
  /// Starts them; `threads`: at least 1.
  explicit WorkPool(int threads);
  /// Finishes what was posted.
  ~WorkPool();

  /// `task` must not throw.
  void post(const std::string& client, std::function<void()> task);
  /// Whether one more task of the client may wait where `limit` may in all (access/share.hpp).
  bool has_room(const std::string& client, std::size_t limit) const;
  /// Number of tasks that have not begun.
  std::size_t waiting() const;

 private:
  void run();
  void stop();

  mutable std::mutex _mutex;
  std::condition_variable _changed;
  access::TurnQueue<std::function<void()>> _tasks;
  bool _stopping = false;
  std::vector<std::thread> _threads;
};

}  // namespace anticrack::rpc
