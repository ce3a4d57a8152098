// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/work_pool.hpp"

#include <utility>

#include "access/share.hpp"

namespace anticrack::rpc {

WorkPool::WorkPool(int threads) {
  try {
    for (int i = 0; i < threads; ++i) _threads.emplace_back([this] { run(); });
  } catch (...) {
    stop();
    throw;
  }
}

WorkPool::~WorkPool() { stop(); }

void WorkPool::stop() {
  {
    const std::lock_guard lock(_mutex);
    _stopping = true;
  }
  _changed.notify_all();
  for (std::thread& thread : _threads) thread.join();
}

void WorkPool::post(const std::string& client, std::function<void()> task) {
  {
    const std::lock_guard lock(_mutex);
    _tasks.push(client, std::move(task));
  }
  _changed.notify_one();
}

bool WorkPool::has_room(const std::string& client, std::size_t limit) const {
  const std::lock_guard lock(_mutex);
  return access::may_have(_tasks.size_of(client), 1, _tasks.size(), limit);
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
      const std::function<void()> task = _tasks.pop();
      lock.unlock();
      task();
    }
    lock.lock();
  }
}

}  // namespace anticrack::rpc
