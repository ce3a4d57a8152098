// SPDX-License-Identifier: GPL-3.0-or-later
//
// The policy of which results expire and which records are erased, without threads or locks.
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
  std::vector<std::string> expire;  ///< jobs whose results are deleted
  std::vector<std::string> erase;   ///< jobs whose records are deleted, with their results
};

/// The ended jobs of the store, in the order of their ends. Not thread-safe.
class Retention {
 public:
  explicit Retention(const RetentionLimits& limits) : _limits(limits) {}

  /// Adds a job that has ended; removes one that was erased.
  void add(store::EndedJob job);
  void remove(const std::string& id);
  /// Replaces all of them; `jobs`: the oldest end first.
  void replace(std::vector<store::EndedJob> jobs) { _jobs = {jobs.begin(), jobs.end()}; }
  void expired(const std::string& id);  ///< the job's result has been deleted

  /// What has to be deleted at `now`, each job in one of the two lists: all that is too old; then,
  /// while there is too much, the oldest of the owner who has most, so that one owner's jobs do not
  /// push out another's. The newest record stays. So does the newest result, whatever its size,
  /// unless it is too old: otherwise nobody could read it. O(n + k owners) for k jobs deleted.
  Expiry due(records::Clock::time_point now) const;

 private:
  RetentionLimits _limits;
  std::deque<store::EndedJob> _jobs;
};

}  // namespace anticrack::jobs
