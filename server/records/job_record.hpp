// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the server remembers of jobs. The numbers of enums are those of the API. Who looks at the
// answers of a job includes records/case_record.hpp, which every new number of an answer changes.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "errors/errors.hpp"
#include "fields/fields.hpp"
#include "records/clock.hpp"
#include "records/job_spec.hpp"
#include "records/job_state.hpp"

namespace anticrack::records {

struct CaseRecord;

/// The summary of a sweep; its columns are in the result block.
struct SweepRecord {
  std::uint64_t converged = 0;
  std::uint64_t not_converged = 0;
  std::uint64_t failed = 0;
  int most_steps = 0;
  double worst_kkt = 0;                    ///< largest relative residual of the rows that converged
  std::chrono::nanoseconds solve_time{0};  ///< on solver threads, added up
  std::vector<std::string> warnings{};     ///< from the loads that are combined, and from bounds
};
ANTICRACK_FIELDS(SweepRecord, converged, not_converged, failed, most_steps, worst_kkt, solve_time,
                 warnings)

/// A load case at the end of a stage; members are empty if it has no bounds.
struct StageAnswer {
  double energy = 0;
  std::optional<double> energy_lower{};
  std::optional<double> energy_upper{};
  std::optional<double> error_bound_relative{};
  std::optional<double> displacement_error{};  ///< largest of all inclusions, as in AccuracySpec
  std::optional<double> displacement_error_probable{};  ///< the same by estimate
  /// What curves in place of chords may change, by estimate: over |energy|, and as
  /// displacement_error. Empty: there are no chords.
  std::optional<double> energy_geometry_error{}, displacement_geometry_error{};
};
ANTICRACK_FIELDS(StageAnswer, energy, energy_lower, energy_upper, error_bound_relative,
                 displacement_error, displacement_error_probable, energy_geometry_error,
                 displacement_geometry_error)

struct StageRecord {
  std::string mesh;  ///< id
  std::uint64_t triangles = 0;
  double seconds = 0;                  ///< from the start of the first stage to the end of this one
  std::vector<StageAnswer> answers{};  ///< (loads); empty if the stage has not ended
  std::string forecast{};              ///< what cannot be proved within the limits; empty: unknown
};
ANTICRACK_FIELDS(StageRecord, mesh, triangles, seconds, answers, forecast)

/// A step of a job: it entered `state`, or another phase of it.
struct Step {
  Clock::time_point time;
  JobState state = JobState::queued;
  std::string detail;  ///< e.g. "meshing"
};
ANTICRACK_FIELDS(Step, time, state, detail)

struct JobRecord {
  JobRecord();
  JobRecord(const JobRecord& other);
  JobRecord(JobRecord&& other) noexcept;
  JobRecord& operator=(const JobRecord& other);
  JobRecord& operator=(JobRecord&& other) noexcept;
  ~JobRecord();

  std::string id;
  std::string owner;       ///< as MeshRecord::owner
  std::string request_id;  ///< empty: none
  JobSpec spec;
  JobState state = JobState::queued;
  std::optional<errors::Error> error;
  Clock::time_point created;
  std::optional<Clock::time_point> started;
  std::optional<Clock::time_point> ended;
  std::optional<Clock::time_point> expired;  ///< when the result was removed, by age or budget
  std::vector<CaseRecord> cases;             ///< one per load; empty for a sweep
  SweepRecord sweep;                         ///< of a sweep
  std::vector<StageRecord> stages;           ///< stages begun so far; `cases` are those of the last
  std::string not_reached;                   ///< accuracy not reached, why, and the cure
  std::uint64_t result_bytes = 0;
  int attempt = 1;             ///< counts restarts of the server while it ran
  int crashes = 0;             ///< attempts that ended because the server's process died
  std::vector<Step> timeline;  ///< of all attempts so far, at most a few dozen
};
ANTICRACK_FIELDS(JobRecord, id, owner, request_id, spec, state, error, created, started, ended,
                 expired, cases, sweep, stages, not_reached, result_bytes, attempt, crashes,
                 timeline)

}  // namespace anticrack::records
