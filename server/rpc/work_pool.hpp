// SPDX-License-Identifier: GPL-3.0-or-later
//
// Threads for work that would block gRPC's few threads too long: waits for the disk, and checks of
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

/// A few threads that take tasks of clients in turns, those of one client in order. So a client
/// that waits for the disk does not delay others, and the store writes the changes of several in
/// one go. Thread-safe.
class WorkPool {
 public:
  /// Starts the threads. `threads`: at least 1.
  explicit WorkPool(int threads);
  /// Finishes all posted tasks.
  ~WorkPool();

  /// Queues a task, which must not throw.
  void post(const std::string& client, std::function<void()> task);
  /// Whether one more task of the client may wait, if `limit` tasks may wait in all
  /// (access/share.hpp).
  bool has_room(const std::string& client, std::size_t limit) const;
  /// The number of tasks that have not begun.
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
