// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/helpers.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <iterator>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>

#include "base/at.hpp"

namespace anticrack::base {

class Helpers::Thread {
 public:
  explicit Thread(int niceness) : _niceness(niceness), _thread([this] { run(); }) {}
  ~Thread() {
    {
      const std::lock_guard lock(_mutex);
      _ending = true;
    }
    _begin.notify_one();
  }
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  int niceness() const noexcept { return _niceness; }

  void begin(const std::function<void()>& work) {
    {
      const std::lock_guard lock(_mutex);
      _work = &work;
    }
    _begin.notify_one();
  }

  /// Returns when the work is done, or will not begin.
  void wait() {
    std::unique_lock lock(_mutex);
    _work = nullptr;
    _done.wait(lock, [this] { return !_working; });
  }

 private:
  void run() {
    std::unique_lock lock(_mutex);
    for (;;) {
      _begin.wait(lock, [this] { return _work != nullptr || _ending; });
      if (_ending) return;
      const std::function<void()>& work = *std::exchange(_work, nullptr);
      _working = true;
      lock.unlock();
      work();
      lock.lock();
      _working = false;
      _done.notify_one();
    }
  }

  const int _niceness;
  std::mutex _mutex;
  std::condition_variable _begin, _done;
  const std::function<void()>* _work = nullptr;  ///< that has not begun
  bool _working = false, _ending = false;
  std::jthread _thread;  ///< declared last: it uses the others
};

/// The threads without work, the last used at the end.
class Helpers::Waiting {
 public:
  /// Null if there is none of this priority.
  std::unique_ptr<Thread> take(int niceness) {
    const std::lock_guard lock(_mutex);
    for (auto one = _threads.rbegin(); one != _threads.rend(); ++one) {
      if ((*one)->niceness() != niceness) continue;
      std::unique_ptr<Thread> taken = std::move(*one);
      _threads.erase(std::next(one).base());
      return taken;
    }
    return nullptr;
  }

  /// Ends those that waited longest, beyond what the processors can use.
  void put(std::vector<std::unique_ptr<Thread>> threads) {
    static const std::size_t most = std::max(2U, 2 * std::thread::hardware_concurrency());
    std::vector<std::unique_ptr<Thread>> ended;  // without the lock
    const std::lock_guard lock(_mutex);
    for (std::unique_ptr<Thread>& one : threads) _threads.push_back(std::move(one));
    for (; _threads.size() > most; _threads.pop_front())
      ended.push_back(std::move(_threads.front()));
  }

  /// Never destroyed: threads may still work when the process ends.
  static Waiting& all() {
    static Waiting& waiting = *new Waiting;
    return waiting;
  }

 private:
  std::mutex _mutex;
  std::deque<std::unique_ptr<Thread>> _threads;
};

Helpers::Helpers(int count, const std::function<void()>& work) {
  if (count <= 0) return;
  const int niceness = ::getpriority(PRIO_PROCESS, 0);  // of this thread
  _threads.reserve(at(count));
  try {
    while (std::ssize(_threads) < count) {
      std::unique_ptr<Thread> one = Waiting::all().take(niceness);
      if (!one) one = std::make_unique<Thread>(niceness);
      _threads.push_back(std::move(one));
      _threads.back()->begin(work);
    }
  } catch (const std::system_error&) {
    // If there are no more threads, the present ones do the rest.
  }
}

Helpers::~Helpers() {
  for (const std::unique_ptr<Thread>& one : _threads) one->wait();
  try {
    Waiting::all().put(std::move(_threads));
  } catch (const std::bad_alloc&) {
    // Threads for which there is no memory to keep them have ended.
  }
}

}  // namespace anticrack::base
