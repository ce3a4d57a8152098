// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job while the server works on it.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "contact/answer.hpp"
#include "jobs/event_log.hpp"
#include "jobs/force_arrays.hpp"
#include "operators/mesh_operator.hpp"
#include "store/records.hpp"

namespace anticrack::jobs {

/// What the result block is made of, for one load case.
struct SolvedCase {
  contact::Answer answer;
  std::vector<contact::Sample> history;
};

struct LiveCase {
  bool running = false;
  std::shared_ptr<const store::CaseRecord> record;  ///< once it has ended
  /// When it has an answer. Belongs to the thread that solves the case, then to the one that ends
  /// the job.
  std::unique_ptr<SolvedCase> solved;
};

/// The first part does not change; the engine's mutex guards the second, but for what is said
/// there.
struct LiveJob {
  LiveJob(std::uint64_t submission, const store::JobRecord& record, std::size_t event_log_bytes);

  const std::uint64_t number;  ///< in the order of submission
  const std::string id;
  const std::shared_ptr<const store::JobSpec> spec;
  const store::Clock::time_point created;
  const std::shared_ptr<EventLog> log;
  ForceArrays arrays;
  std::stop_source stop;

  store::JobState state = store::JobState::queued;
  std::optional<store::Clock::time_point> started;
  /// Set before the job runs, reset by the thread that ends it.
  std::shared_ptr<const operators::MeshOperator> mesh_operator;
  std::vector<LiveCase> cases;
  std::size_t next_case = 0;       ///< first one that no thread has taken
  int active = 0;                  ///< threads at work on it
  std::uint64_t result_bytes = 0;  ///< of the answers so far
  bool ending = false;
  std::shared_ptr<const store::JobRecord> final_record;  ///< once it has ended
  std::chrono::steady_clock::time_point not_before;      ///< its mesh is not to be tried earlier
};

/// A job's record at one moment, cheap to take under a lock.
struct JobSnapshot {
  explicit JobSnapshot(const LiveJob& job);
  store::JobRecord record() const;

  std::string id;
  std::shared_ptr<const store::JobSpec> spec;
  store::Clock::time_point created;
  store::JobState state;
  std::optional<store::Clock::time_point> started;
  std::vector<bool> running;
  std::vector<std::shared_ptr<const store::CaseRecord>> cases;
  std::shared_ptr<const store::JobRecord> final_record;
};

struct Outcome {
  store::JobState state = store::JobState::succeeded;
  std::optional<errors::Error> error;
};

/// How a job ended whose cases ended like this: cancelled where one was cancelled, failed where one
/// failed, with the error of the first (by index) and the path of its field, else succeeded.
Outcome outcome(const store::JobSpec& spec, const std::vector<LiveCase>& cases);

/// A mesh's error as a job's, at field "mesh".
errors::Error mesh_failed(const std::string& mesh, const errors::Error& error);

}  // namespace anticrack::jobs
