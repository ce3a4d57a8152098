// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where calls do what takes longer than gRPC's few threads may be held: files, and checks of large
// requests.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace anticrack::rpc {

/// One thread, tasks in order. Thread-safe.
class WorkThread {
 public:
  WorkThread();
  /// Finishes what was posted.
  ~WorkThread();

  /// `task` must not throw.
  void post(std::function<void()> task);
  /// Tasks that have not begun.
  std::size_t waiting() const;

 private:
  void run();

  mutable std::mutex _mutex;
  std::condition_variable _changed;
  std::deque<std::function<void()>> _tasks;
  bool _stopping = false;
  std::thread _thread;
};

}  // namespace anticrack::rpc
