// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/work_thread.hpp"

#include <utility>

namespace anticrack::rpc {

WorkThread::WorkThread() : _thread([this] { run(); }) {}

WorkThread::~WorkThread() {
  {
    const std::lock_guard lock(_mutex);
    _stopping = true;
  }
  _changed.notify_one();
  _thread.join();
}

void WorkThread::post(std::function<void()> task) {
  {
    const std::lock_guard lock(_mutex);
    _tasks.push_back(std::move(task));
  }
  _changed.notify_one();
}

std::size_t WorkThread::waiting() const {
  const std::lock_guard lock(_mutex);
  return _tasks.size();
}

void WorkThread::run() {
  std::unique_lock lock(_mutex);
  for (;;) {
    _changed.wait(lock, [this] { return _stopping || !_tasks.empty(); });
    if (_tasks.empty()) return;
    {
      const std::function<void()> task = std::move(_tasks.front());
      _tasks.pop_front();
      lock.unlock();
      task();
    }
    lock.lock();
  }
}

}  // namespace anticrack::rpc
