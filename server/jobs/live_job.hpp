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

#include "jobs/event_log.hpp"
#include "jobs/force_arrays.hpp"
#include "jobs/live_spread.hpp"
#include "jobs/live_sweep.hpp"
#include "jobs/result_part.hpp"
#include "jobs/schedule.hpp"
#include "records/job_record.hpp"

namespace anticrack::operators {
class MeshOperator;
}  // namespace anticrack::operators

namespace anticrack::jobs {

struct LiveCase {
  bool running = false;
  std::shared_ptr<const records::CaseRecord> record;  ///< set once the case has ended
  std::optional<ResultPart> result;                   ///< set if the case has an answer
};

/// The stages of a job with an accuracy. `last` is the last stage of which all load cases have
/// ended; the present stage has a spool and cases of its own.
struct LiveStages {
  std::vector<records::StageRecord> records;  ///< the last of them is the present stage
  /// Answers of the stage before, whose bounds still hold; empty in the first stage.
  std::vector<std::shared_ptr<const records::CaseRecord>> before;
  std::string not_reached;
  std::string no_finer;  ///< why there can be no finer mesh than the last one; empty if there can
  bool over = false;     ///< the stage that has ended was the last
  double seconds_before = 0;                                   ///< before this start of the server
  std::optional<std::chrono::steady_clock::time_point> begun;  ///< when this server began it
  /// (triangles) The maximum, over the load cases that are not accurate enough, of the indicator
  /// divided by its sum and multiplied by the excess (accuracy.hpp); empty: no such case.
  std::vector<double> indicator;
  std::mutex indicator_mutex;  ///< guards it instead of the engine's mutex, as it may be long
  struct Complete {
    std::vector<LiveCase> cases;  ///< empty: no stage has ended
    std::shared_ptr<const records::BlockSource> result;
    std::uint64_t bytes = 0;  ///< memory of the answers
  } last;
  std::shared_ptr<void> mesh_use;  ///< keeps the stage's mesh
  std::vector<std::string> made;   ///< ids of the meshes that the job made
};

/// The phase of a job. It only moves forward: to the next phase, or past phases that it does not
/// need.
enum class Phase {
  queued,
  waiting_for_mesh,  ///< it has been told a phase of the mesh
  running,
  ending,   ///< nothing is left to solve: its end is made and written
  refused,  ///< as `ending`, but the store could not take the end yet
  over,     ///< its end is on the disk, or it is left to the next start
};

/// The reason why a job must not go on.
enum class Stop {
  none,
  cancelled,
  failed,       ///< LiveJob::failure has the error: of its mesh, or a time limit
  interrupted,  ///< the server stops: the job stays in the store for the next start
};

/// A job is solved in units: its load cases, or the chunks of its sweep (one chunk until the job
/// starts and they are known). Of a sweep that is spread, and where this server helps, they are
/// those that it has taken; positions of growth that its own server solves are parts of units. The
/// first part of the members does not change; the engine's mutex guards the second, with the
/// exceptions named there.
struct PlacedProbes;

struct LiveJob {
  /// `cases_in_queue`: the load cases that `admission` counted for it; `shared`: other servers may
  /// have run it before, whose watchers come here.
  LiveJob(std::uint64_t submission, records::JobRecord record, std::uint64_t cases_in_queue,
          std::size_t event_log_bytes, std::shared_ptr<void> mesh_in_use,
          const std::shared_ptr<MemoryBudget>& budget = {}, bool shared = false);

  const std::uint64_t number;        ///< in the order of submission
  const records::JobRecord created;  ///< as it was submitted or recovered, without its lists
  const std::shared_ptr<const records::JobSpec> spec;
  const std::uint64_t spec_bytes;
  Lane lane;                                          ///< as `helps`
  const std::chrono::steady_clock::time_point since;  ///< when this server got it
  const std::shared_ptr<EventLog> log;
  /// Another server runs it and this one solves portions of it; set before it is added.
  bool helps = false;
  ForceArrays arrays;
  std::stop_source stop;
  std::stop_source writing;  ///< stops the writing of its end, if it is cancelled then

  /// The id of the job.
  const std::string& id() const noexcept { return created.id; }

  /// Moves the job to another phase; `running` sets `started`. Asserts that the move is allowed.
  void enter(Phase next);
  bool is_ending() const noexcept { return phase >= Phase::ending; }
  /// The state that others see: a job whose end is being written is still RUNNING if it ran.
  records::JobState state() const noexcept;

  Phase phase = Phase::queued;                        ///< only enter() changes it
  std::optional<records::Clock::time_point> started;  ///< set once it runs
  std::vector<records::Step> timeline;
  std::string mesh;                ///< id: spec's, or that of its stage
  std::shared_ptr<void> mesh_use;  ///< keeps spec's mesh; released when the job has ended
  /// Set when the job, or a stage of it, starts; reset by the thread that ends it.
  std::shared_ptr<const operators::MeshOperator> mesh_operator;
  std::shared_ptr<const PlacedProbes> probes;  ///< on its mesh; set with the operator
  std::shared_ptr<store::Spool> spool;         ///< for the result; set with the operator
  std::vector<LiveCase> cases;                 ///< empty for a sweep
  std::unique_ptr<LiveSweep> sweep;            ///< set once it has started
  std::shared_ptr<LiveSpread> spread;          ///< null: this server solves all there is
  std::unique_ptr<LiveStages> stages;          ///< of a job with an accuracy
  records::SweepRecord sweep_record;           ///< sums over the rows that have ended
  std::size_t units = 0;
  std::size_t next_unit = 0;  ///< first one that no thread has taken
  int active = 0;  ///< units taken and not ended, plus one during a start and while it is spread
  std::uint64_t queued_cases = 0;  ///< load cases that admission still counts
  std::uint64_t result_bytes = 0;  ///< of the answers so far
  std::uint64_t answer_bytes = 0;  ///< of the records of `cases`
  MemoryShare memory;
  Stop why = Stop::none;
  std::optional<errors::Error> failure;
  std::uint64_t published;  ///< number of the last event in the store; EventRows guards it
};

using JobPtr = std::shared_ptr<LiveJob>;

/// A unit that a thread has taken.
struct Task {
  JobPtr job;
  std::size_t index = 0;
  std::chrono::steady_clock::time_point taken;
  std::string request{};  ///< of a position
};

/// Takes the next unit; one must be left. Call it with the engine's mutex held.
Task take_unit(const JobPtr& job);

/// The number of entries of JobRecord::cases.
std::size_t case_count(const records::JobSpec& spec);

/// Appends a step with the current time, and drops old ones if there are many.
void add_step(std::vector<records::Step>& timeline, records::JobState state, std::string detail);

/// A snapshot of a job's record, cheap to take under a lock.
class JobSnapshot {
 public:
  /// Takes the snapshot, with the engine's mutex held.
  explicit JobSnapshot(const LiveJob& job);
  /// The whole record. Call it without a lock, as it copies much.
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

/// Determines how a job ends. Cases without an answer get a record that says why: they are
/// cancelled or fail with the job. The job is cancelled if a case was, failed if all failed, not
/// converged if some failed or did not converge, else succeeded; its error is that of the first
/// case that failed (by index), with the path of its field. A sweep is cancelled or fails if some
/// of its rows were not solved. With the engine's mutex held.
Outcome conclude(LiveJob& job);

/// The name of the present stage, like "stage 3".
std::string stage_name(const LiveJob& job);

/// The error of a mesh as an error of the job, at field "mesh", or below it if the definition is at
/// fault: "mesh.options.tension[top]".
errors::Error mesh_failed(const std::string& mesh, const errors::Error& error);

}  // namespace anticrack::jobs
