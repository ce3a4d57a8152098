// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which results expire and which records go: the policy, without threads or locks.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "store/store.hpp"

namespace anticrack::jobs {

struct RetentionLimits {
  std::size_t jobs = 10'000;         ///< records
  std::chrono::milliseconds ttl{0};  ///< of results; 0: for ever
  std::uint64_t bytes = 4ULL << 30;  ///< of results
};

struct Expiry {
  std::vector<std::string> expire;  ///< jobs whose results go
  std::vector<std::string> erase;   ///< jobs whose records go, and their results
};

/// The ended jobs the store has, oldest end first. Not thread-safe.
class Retention {
 public:
  explicit Retention(const RetentionLimits& limits) : _limits(limits) {}

  /// A job ended; one was erased.
  void add(store::EndedJob job);
  void remove(const std::string& id);
  void expired(const std::string& id);  ///< has no result any more

  /// What has to go at `now`, each job in one of the two lists: what is too old; then, while there
  /// is too much, the oldest of the owner who has most, so that nobody's jobs push out another's.
  /// The newest record stays, and the newest result whatever its size unless it is too old, or
  /// nobody could read it. O(n + k owners) for k jobs that go.
  Expiry due(records::Clock::time_point now) const;

 private:
  RetentionLimits _limits;
  std::deque<store::EndedJob> _jobs;
};

}  // namespace anticrack::jobs
