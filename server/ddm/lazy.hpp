// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <mutex>
#include <optional>

namespace anticrack::ddm {

/// A value computed once, at the first get(); concurrent callers wait. Thread-safe; not movable.
template <class Value>
class Lazy {
 public:
  /// If compute() throws, the next call tries again.
  template <class Compute>
  const Value& get(const Compute& compute) const {
    if (const Value* value = known()) return *value;
    const std::lock_guard lock(_mutex);
    if (!_value) {
      _value.emplace(compute());
      _known.store(&*_value, std::memory_order_release);
    }
    return *_value;
  }

  /// Null until it is there. Does not wait.
  const Value* known() const noexcept { return _known.load(std::memory_order_acquire); }

 private:
  mutable std::mutex _mutex;
  mutable std::optional<Value> _value;
  mutable std::atomic<const Value*> _known{nullptr};
};

}  // namespace anticrack::ddm
