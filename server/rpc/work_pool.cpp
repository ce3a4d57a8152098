// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/work_pool.hpp"

#include <utility>

namespace anticrack::rpc {

WorkPool::WorkPool(int threads) {
  for (int i = 0; i < threads; ++i) _threads.emplace_back([this] { run(); });
}

WorkPool::~WorkPool() {
  {
    const std::lock_guard lock(_mutex);
    _stopping = true;
  }
  _changed.notify_all();
  for (std::thread& thread : _threads) thread.join();
}

void WorkPool::post(std::function<void()> task) {
  {
    const std::lock_guard lock(_mutex);
    _tasks.push_back(std::move(task));
  }
  _changed.notify_one();
}

std::size_t WorkPool::waiting() const {
  const std::lock_guard lock(_mutex);
  return _tasks.size();
}

void WorkPool::run() {
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
