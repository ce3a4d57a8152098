// SPDX-License-Identifier: GPL-3.0-or-later
//
// Jobs that have not started, and who is next: the scheduling policy, without threads or locks.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "jobs/live_job.hpp"

namespace anticrack::jobs {

/// Contract:
/// 1. First come, first served, but a job that would wait for its mesh does not hold up one that
///    would not.
/// 2. One preparation at a time per mesh: the other jobs on it find it ready afterwards, so that
///    they do not occupy the preparation threads.
/// 3. At most `prepared_limit` jobs are prepared, or being prepared, and not started: each pins
///    memory.
class JobQueue {
 public:
  using JobPtr = std::shared_ptr<LiveJob>;
  using Time = std::chrono::steady_clock::time_point;
  using Operator = std::shared_ptr<const operators::MeshOperator>;

  explicit JobQueue(std::size_t prepared_limit) : _prepared_limit(prepared_limit) {}

  void add(JobPtr job);
  /// Takes a job out that nobody is preparing; false where it is not here or being prepared.
  bool remove(const LiveJob& job);

  /// The next job to prepare, null when there is none now. Ends with `prepared`, `prepare_again` or
  /// `drop`.
  JobPtr next_to_prepare(Time now);
  void prepared(JobPtr job);
  /// Back to its place; its mesh is not tried before `not_before`.
  void prepare_again(JobPtr job, Time not_before);
  void drop(const LiveJob& job);
  /// When the next job that was put back may be tried; empty when none is held back at `now`.
  std::optional<Time> next_retry(Time now) const;

  /// The next job that can start, its operator in it; null when there is none now. `find` gives the
  /// operator of a mesh when it is in memory; it is asked once a mesh.
  JobPtr next_to_start(const std::function<Operator(const std::string& mesh)>& find);

  /// Jobs that have not started, those being prepared included.
  std::size_t size() const { return _waiting.size() + _preparing.size() + _prepared.size(); }
  /// Jobs that nobody prepares and that have no operator.
  std::size_t waiting() const { return _waiting.size(); }

 private:
  using ByNumber = std::map<std::uint64_t, JobPtr>;

  std::size_t _prepared_limit;
  ByNumber _waiting;
  ByNumber _prepared;
  std::set<std::string> _preparing;  ///< meshes; one job each
};

}  // namespace anticrack::jobs
