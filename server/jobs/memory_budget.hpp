// SPDX-License-Identifier: GPL-3.0-or-later
//
// One budget for the memory that grows with requests: definitions, events and answers of jobs.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

namespace anticrack::jobs {

/// Thread-safe. Its users ask before they take more: when it is exceeded, jobs are refused, starts
/// wait, event logs keep less, and logs of ended jobs are dropped.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t limit) : _limit(limit) {}
  std::uint64_t limit() const noexcept { return _limit; }
  std::uint64_t used() const noexcept { return _used; }
  /// Whether `more` bytes would exceed the budget.
  bool exceeded_by(std::uint64_t more) const noexcept { return used() + more > _limit; }
  bool exceeded() const noexcept { return exceeded_by(0); }

 private:
  friend class MemoryShare;
  const std::uint64_t _limit;
  std::atomic<std::uint64_t> _used{0};
};

/// The part that one user has; the destructor gives it back. Counts nothing without a budget.
class MemoryShare {
 public:
  explicit MemoryShare(std::shared_ptr<MemoryBudget> budget = {}, std::uint64_t bytes = 0)
      : _budget(std::move(budget)) {
    set(bytes);
  }
  ~MemoryShare() { set(0); }
  MemoryShare(const MemoryShare&) = delete;
  MemoryShare& operator=(const MemoryShare&) = delete;

  void set(std::uint64_t bytes) noexcept {
    if (_budget) _budget->_used += bytes - std::exchange(_bytes, bytes);
  }
  bool budget_exceeded() const noexcept { return _budget && _budget->exceeded(); }

 private:
  std::shared_ptr<MemoryBudget> _budget;
  std::uint64_t _bytes = 0;
};

}  // namespace anticrack::jobs
