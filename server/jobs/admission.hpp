// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whether a job is taken in: the policy, without threads or locks.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>

namespace anticrack::jobs {

struct AdmissionLimits {
  std::size_t jobs = 1'000;             ///< that have not ended
  std::uint64_t cases = 100'000;        ///< of one mesh, of jobs started or not, not ended
  std::uint64_t memory = 512ULL << 20;  ///< bytes of definitions, events and answers of all jobs
};

/// Counts what is admitted and not ended. Of jobs and of memory, for their definitions, an owner
/// has a share (access/share.hpp); without a name, on a server without authentication, everything.
/// Not thread-safe.
class Admission {
 public:
  explicit Admission(const AdmissionLimits& limits) : _limits(limits) {}

  /// Throws errors::Error: limit_exceeded where the job alone is over a bound, else busy with a
  /// retry delay that grows with the queue. A job that passes is counted with `add`. `bytes`: of
  /// its definition; `memory`: what all jobs use.
  void check(const std::string& owner, const std::string& mesh, std::uint64_t cases,
             std::uint64_t bytes, std::uint64_t memory) const;
  void add(const std::string& owner, const std::string& mesh, std::uint64_t cases,
           std::uint64_t bytes);

  /// A job that was counted has started, or ends without a start.
  void started() noexcept { --_waiting; }
  void cases_ended(const std::string& mesh, std::uint64_t count);
  /// A job is known to the store as ended, or left to the next start.
  void ended(const std::string& owner, std::uint64_t bytes);

  std::size_t waiting() const noexcept { return _waiting; }  ///< jobs that have not started
  std::uint64_t bytes() const noexcept { return _bytes; }
  /// The delay in a refusal; grows with the number of jobs that have not ended.
  std::chrono::milliseconds retry_delay() const noexcept;

 private:
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
