// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>

#include "base/at.hpp"
#include "base/helpers.hpp"
#include "stop/stop.hpp"

namespace anticrack::base {

/// While it lives, loops of this thread may run on so many threads, itself included; else on one.
/// Threads that help have no helpers. Results must not depend on it.
class Threads {
 public:
  explicit Threads(int allowed) noexcept : _before(_allowed) { _allowed = allowed; }
  ~Threads() { _allowed = _before; }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  static int allowed() noexcept { return _allowed; }

 private:
  static inline thread_local int _allowed = 1;
  const int _before;
};

/// Calls worker(i) for i = 0, ..., count - 1 from a shared counter on at most `threads` threads,
/// including that of the caller; each thread has a worker from `make_worker()`. After an exception
/// no index is begun, and when all threads have stopped the first exception is rethrown. Looks
/// (stop/stop.hpp) on all threads ask what those of the caller's thread ask; there is a look before
/// each index.
template <class MakeWorker>
void at_once(std::size_t count, int threads, const MakeWorker& make_worker) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const stop::Asked asked = stop::asked();
  const auto run = [&] {
    try {
      auto worker = make_worker();
      for (std::size_t i = next++; i < count; i = next++) {
        stop::look("working on parts of a mesh");
        worker(i);
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = failure ? failure : std::current_exception();
      next = count;
    }
  };
  if (count > 0) {
    const auto wanted = std::min(at(std::max(threads, 1)), count);
    const std::function<void()> help = [&] {
      const stop::Scope scope(asked);
      run();
    };
    const Helpers helpers(static_cast<int>(wanted) - 1, help);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace anticrack::base
