// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <thread>

#include "stop/stop.hpp"

namespace anticrack::base {

/// A value that is computed once, at the first get(). Concurrent callers wait and look at their
/// stop tokens (stop/stop.hpp). Thread-safe; not movable.
template <class Value>
class Lazy {
 public:
  /// If compute() throws, as when its caller's work is stopped, the next call of get() tries again.
  template <class Compute>
  const Value& get(const Compute& compute) const {
    if (const Value* value = known()) return *value;
    std::unique_lock lock(_mutex, std::defer_lock);
    while (!lock.try_lock()) {
      stop::look("waiting for what another needs as well");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (!_value) {
      _value.emplace(compute());
      _known.store(&*_value, std::memory_order_release);
    }
    return *_value;
  }

  /// The value; null if it is not computed yet. Does not wait.
  const Value* known() const noexcept { return _known.load(std::memory_order_acquire); }

 private:
  mutable std::mutex _mutex;
  mutable std::optional<Value> _value;
  mutable std::atomic<const Value*> _known{nullptr};
};

}  // namespace anticrack::base
