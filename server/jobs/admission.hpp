// SPDX-License-Identifier: GPL-3.0-or-later
//
// The policy of which jobs are taken in, without threads or locks.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>

#include "store/queue.hpp"

namespace anticrack::jobs {

struct AdmissionLimits {
  std::size_t jobs = 1'000;             ///< jobs that have not ended
  std::uint64_t cases = 100'000;        ///< load cases of one mesh, of all jobs that have not ended
  std::uint64_t memory = 512ULL << 20;  ///< bytes, for definitions, events and answers of all jobs
};

/// Counts the jobs that are admitted and have not ended. An owner has a share (access/share.hpp) of
/// the jobs and of the memory for their definitions; the empty owner, of a server without
/// authentication, may have everything. Not thread-safe.
class Admission {
 public:
  explicit Admission(const AdmissionLimits& limits) : _limits(limits) {}

  /// Throws errors::Error: limit_exceeded if the job alone is over a bound, else busy with a retry
  /// delay that grows with the queue. Count a job that passes by `add`. `bytes`: of its definition;
  /// `memory`: the bytes that all jobs use.
  void check(const std::string& owner, const std::string& mesh, std::uint64_t cases,
             std::uint64_t bytes, std::uint64_t memory) const;
  /// The same where not this object but the queue of several servers counts.
  void check(const std::string& owner, const std::string& mesh, std::uint64_t cases,
             std::uint64_t bytes, const store::QueueTotals& held) const;
  void add(const std::string& owner, const std::string& mesh, std::uint64_t cases,
           std::uint64_t bytes);

  /// To be called when a counted job starts, or ends without a start.
  void started() noexcept { --_waiting; }
  void cases_ended(const std::string& mesh, std::uint64_t count);
  /// To be called when the store has a job as ended, or the job is left to the next start.
  void ended(const std::string& owner, std::uint64_t bytes);

  std::size_t waiting() const noexcept { return _waiting; }  ///< jobs that have not started
  std::uint64_t bytes() const noexcept { return _bytes; }
  /// The delay in a refusal; grows with the number of jobs that have not ended.
  std::chrono::milliseconds retry_delay() const noexcept { return retry_delay(_jobs); }

 private:
  static std::chrono::milliseconds retry_delay(std::uint64_t jobs) noexcept;

  AdmissionLimits _limits;
  std::size_t _jobs = 0;
  std::size_t _waiting = 0;
  std::uint64_t _bytes = 0;
  std::unordered_map<std::string, std::uint64_t> _cases;  ///< by mesh
  struct Held {
    std::uint64_t jobs = 0;
    std::uint64_t bytes = 0;
  };
  std::unordered_map<std::string, Held> _owners;
};

}  // namespace anticrack::jobs
