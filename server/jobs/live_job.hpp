// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job while the server works on it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "contact/answer.hpp"
#include "jobs/event_log.hpp"
#include "jobs/force_arrays.hpp"
#include "jobs/live_sweep.hpp"
#include "jobs/result_part.hpp"
#include "jobs/schedule.hpp"
#include "operators/mesh_operator.hpp"
#include "records/records.hpp"

namespace anticrack::jobs {

struct LiveCase {
  bool running = false;
  std::shared_ptr<const records::CaseRecord> record;  ///< once it has ended
  std::optional<ResultPart> result;                   ///< where it has an answer
};

/// Of a job with an accuracy. `last` is the last stage of which all load cases ended; the one under
/// way begins anew with a spool and cases of its own.
struct LiveStages {
  std::vector<records::StageRecord> records;  ///< the last one has begun
  /// Answers of the stage before, whose bounds hold still; none in the first.
  std::vector<std::shared_ptr<const records::CaseRecord>> before;
  std::string not_reached;
  std::string no_finer;  ///< why there can be no finer mesh than that of the last one; empty: yes
  bool over = false;     ///< no stage comes after the one that has ended
  double seconds_before = 0;                                   ///< until this server had it
  std::optional<std::chrono::steady_clock::time_point> begun;  ///< here
  /// (triangles) of the load cases that are not accurate enough, each over its sum and times its
  /// excess (accuracy.hpp), the largest; empty: none.
  std::vector<double> indicator;
  std::mutex indicator_mutex;  ///< guards it in place of the engine's: many triangles
  struct Complete {
    std::vector<LiveCase> cases;  ///< empty: no stage has ended
    std::shared_ptr<const records::BlockSource> result;
    std::uint64_t bytes = 0;  ///< in memory
  } last;
  std::shared_ptr<void> mesh_use;  ///< of the stage's mesh
  std::vector<std::string> made;   ///< ids of the meshes that the job made
};

/// How far a job is on its way, which has no way back: to the next phase, or past those that it
/// does not need.
enum class Phase {
  queued,
  waiting_for_mesh,  ///< it has heard of it
  running,
  ending,   ///< nothing of it is left to solve: its end is made and written
  refused,  ///< the same, and the store could not take it yet
  over,     ///< its end is on the disk, or it is left to the next start
};

/// Why a job is not to go on.
enum class Stop {
  none,
  cancelled,
  failed,       ///< LiveJob::failure says of what: its mesh, a time limit
  interrupted,  ///< the server stops: the job is left to the store for the next start
};

/// A job is solved in units: its load cases, or the chunks of its sweep, of which there is one
/// until the job starts and they are known. The first part does not change; the engine's mutex
/// guards the second, with the exceptions named there.
struct LiveJob {
  /// `cases_in_queue`: what `admission` counted for it.
  LiveJob(std::uint64_t submission, records::JobRecord record, std::uint64_t cases_in_queue,
          std::size_t event_log_bytes, std::shared_ptr<void> mesh_in_use,
          const std::shared_ptr<MemoryBudget>& budget = {});

  const std::uint64_t number;        ///< in the order of submission
  const records::JobRecord created;  ///< as it was submitted or recovered, without its lists
  const std::shared_ptr<const records::JobSpec> spec;
  const std::uint64_t spec_bytes;
  const Lane lane;
  const std::chrono::steady_clock::time_point since;  ///< when this server had it
  const std::shared_ptr<EventLog> log;
  ForceArrays arrays;
  std::stop_source stop;
  std::stop_source writing;  ///< of its end: cancelled when nothing was left to solve

  /// Of the job, as in its name.
  const std::string& id() const noexcept { return created.id; }

  /// Moves it on, to running now. It asserts that there is such a way.
  void enter(Phase next);
  bool is_ending() const noexcept { return phase >= Phase::ending; }
  /// As others see it: a job that ends is RUNNING still if it ran.
  records::JobState state() const noexcept;

  Phase phase = Phase::queued;                        ///< changed by enter() alone
  std::optional<records::Clock::time_point> started;  ///< once it runs
  std::vector<records::Step> timeline;
  std::string mesh;                ///< id: spec's, or that of its stage
  std::shared_ptr<void> mesh_use;  ///< of spec's mesh; released when the job has ended
  /// Set when the job, or a stage of it, starts; reset by the thread that ends it.
  std::shared_ptr<const operators::MeshOperator> mesh_operator;
  std::shared_ptr<store::Spool> spool;  ///< of the result; set with the operator
  std::vector<LiveCase> cases;          ///< empty for a sweep
  std::unique_ptr<LiveSweep> sweep;     ///< once it has started
  std::unique_ptr<LiveStages> stages;   ///< of a job with an accuracy
  records::SweepRecord sweep_record;    ///< of the rows that ended so far
  std::size_t units = 0;
  std::size_t next_unit = 0;       ///< first one that no thread has taken
  int active = 0;                  ///< units taken and not ended, and one for a start under way
  std::uint64_t queued_cases = 0;  ///< that admission counts still
  std::uint64_t result_bytes = 0;  ///< of the answers so far
  std::uint64_t answer_bytes = 0;  ///< of the records of `cases`
  MemoryShare memory;
  Stop why = Stop::none;
  std::optional<errors::Error> failure;
};

using JobPtr = std::shared_ptr<LiveJob>;

/// A unit on its way.
struct Task {
  JobPtr job;
  std::size_t index = 0;
  std::chrono::steady_clock::time_point taken;
};

/// The next unit; one must be left. Call it with the engine's mutex held.
Task take_unit(const JobPtr& job);

/// The entries of JobRecord::cases.
std::size_t case_count(const records::JobSpec& spec);

/// Appends a step with the current time, and drops old ones if there are many.
void add_step(std::vector<records::Step>& timeline, records::JobState state, std::string detail);

/// A job's record at one moment, cheap to take under a lock.
class JobSnapshot {
 public:
  /// With the engine's mutex held.
  explicit JobSnapshot(const LiveJob& job);
  /// The whole record; copies much, without a lock.
  records::JobRecord record() const;

 private:
  records::JobRecord _head;
  std::shared_ptr<const records::JobSpec> _spec;
  std::vector<bool> _running;
  std::vector<std::shared_ptr<const records::CaseRecord>> _cases;
  std::uint64_t _rows = 0;  ///< of a sweep that has started
};

struct Outcome {
  records::JobState state = records::JobState::succeeded;
  std::optional<errors::Error> error;
};

/// How a job ends; gives the cases that have no answer the record that says why: they are cancelled
/// or fail with the job. Cancelled if a case was cancelled, failed if all failed, not converged if
/// some failed or did not converge, else succeeded; the error is that of the first case that failed
/// (by index), with the path of its field. A sweep is cancelled or fails if rows of it were not
/// solved. With the engine's mutex held.
Outcome conclude(LiveJob& job);

/// "stage 3", of the one that has begun.
std::string stage_name(const LiveJob& job);

/// A mesh's error as a job's, at field "mesh", or below it where its definition is at fault:
/// "mesh.options.tension[top]".
errors::Error mesh_failed(const std::string& mesh, const errors::Error& error);

}  // namespace anticrack::jobs
