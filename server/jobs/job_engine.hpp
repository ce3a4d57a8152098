// SPDX-License-Identifier: GPL-3.0-or-later
//
// Jobs from submission to result: queue, workers, events, cancel.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "jobs/event_log.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "records/job_spec.hpp"
#include "store/store.hpp"

namespace anticrack::records {
struct JobRecord;
}  // namespace anticrack::records

namespace anticrack::jobs {

struct EngineOptions {
  int threads = 2;              ///< threads that solve
  int columns = 32;             ///< load cases of one mesh that iterate or are condensed together
  int max_load_cases = 10'000;  ///< a job
  int max_iterations = 1'000'000;             ///< a load case
  std::uint64_t max_sweep_rows = 10'000'000;  ///< a job
  int max_sweep_basis = 256;                  ///< loads that are combined
  std::size_t max_expression_bytes = 4096;
  // Admission: above one of these limits jobs are refused as `busy`, with a retry delay.
  int max_queued_jobs = 1'000;  ///< jobs that have not ended, including those that run
  /// Load cases of one mesh that have not ended. 256 rows of a sweep, or a megabyte of nodal
  /// forces, count as one until the whole sweep has ended.
  int max_queued_cases = 100'000;
  /// Memory of definitions, events and answers of all jobs. Above it jobs are refused, and not
  /// started beside one that runs; logs of running jobs keep EventLog::least_bytes, and those of
  /// ended jobs are dropped.
  std::uint64_t max_job_memory = std::uint64_t{512} << 20;
  std::chrono::milliseconds queue_time{24 * 3600'000};  ///< how long a job may wait before it fails
  std::chrono::milliseconds run_time{24 * 3600'000};    ///< how long a job may run
  int max_crashes = 3;  ///< a job fails if the server crashed this often while it ran; 0: never
  /// How long a solver thread serves one mesh before it looks at the others.
  std::chrono::milliseconds turn{20};
  /// If every solver thread has been in one step for this long (integrating slow expressions,
  /// bounds on a large mesh), another thread serves owners who have none.
  std::chrono::milliseconds long_step{10};
  std::size_t event_log_bytes = 16u << 20;  ///< a job
  /// Bytes of traces, fields and history of one job. Once they are reached, further load cases
  /// fail. A sweep whose answers would be larger fails at its start.
  std::uint64_t max_result_bytes = std::uint64_t{2} << 30;
  /// Arrays of one job's result, so that their layout fits into a file's header. A job that would
  /// have more is refused, or fails at its start if its mesh was not meshed before.
  std::uint64_t max_result_arrays = 1'000'000;
  // Retention of ended jobs:
  int max_kept_jobs = 10'000;                               ///< records; then the oldest are erased
  std::chrono::milliseconds result_ttl{7 * 24 * 3600'000};  ///< age when a result expires; 0: never
  std::uint64_t result_budget = std::uint64_t{4} << 30;     ///< bytes; then the oldest expire
  std::chrono::milliseconds upload_ttl{7 * 24 * 3600'000};  ///< for uploads to which nothing refers
  /// Called for each job that ended, without a lock, before its watchers hear of it.
  std::function<void(const records::JobRecord&)> ended = {};
};

struct EngineMetrics {
  std::uint64_t jobs_created = 0;
  std::uint64_t jobs_ended = 0;
  std::uint64_t load_cases_ended = 0;  ///< rows of sweeps included
  std::uint64_t iterations = 0;
  std::uint64_t results_expired = 0;
  std::uint64_t leases_lost = 0;                 ///< of this server, in a group
  int jobs_queued = 0;                           ///< now, including those that wait for a mesh
  int jobs_running = 0;                          ///< now
  int columns = 0;                               ///< load cases on solver threads now
  std::uint64_t queued_bytes = 0;                ///< definitions of jobs that have not ended
  std::uint64_t job_memory = 0;                  ///< bytes used of max_job_memory
  std::chrono::duration<double> oldest_wait{0};  ///< of the jobs that have not started
  std::uint64_t jobs_limit = 0;                  ///< of jobs that have not ended
  std::uint64_t kept_jobs_limit = 0;             ///< of ended jobs
  std::uint64_t job_memory_limit = 0;            ///< bytes
};

/// A request for a job.
struct Submission {
  records::JobSpec spec;
  std::string owner;
  std::string request_id;        ///< empty: not idempotent
  std::string fingerprint = {};  ///< of the request: the same for a retry, at most 64 bytes
};

/// Owns the worker threads. A job that waits for its mesh uses no thread, since the catalogue tells
/// the news, so an expensive factorisation starves nobody. Solver threads take turns over the
/// meshes that have work, the most urgent first (schedule.hpp); in a turn the load cases of one
/// mesh, of whatever job, run together: as columns of a UzawaBlock that join and leave at iteration
/// boundaries, or condensed in one block and solved by the active set. A sweep is solved in chunks
/// of consecutive rows, by all threads that have nothing more urgent to do; its numbers do not
/// depend on which thread solves what. Cancel and time limits take effect within one iteration,
/// step or row, also while a job is queued, meshing or factorising; chunks of a sweep that have
/// ended keep their answers. A sweep fails when it reaches a row with a value that is not finite.
/// If the store cannot take the end of a job (a full disk), it is kept and tried again: the job
/// stays RUNNING, phase "writing the result", until it is written or cancelled, or the server
/// stops. Thread-safe; no method but the destructor and `stop` blocks on a solve.
class JobEngine {
 public:
  /// Queues the unfinished jobs of the store; those that had started get attempt + 1. Writes
  /// nothing for them until they start, so that this takes no longer than reading the records.
  JobEngine(EngineOptions options, store::Store& store, meshes::MeshCatalogue& catalogue);
  /// Calls stop(0s).
  ~JobEngine();

  /// Checks the job (errors::Error with "load_cases[i]...." or "solver...." at fault: no load case,
  /// duplicate or empty name, bad expression or parameter; "sweep...." for a matrix that does not
  /// fit, where the job must not wait for its mesh to see that; not_found for the mesh and for an
  /// uploaded array; busy; disk_full; draining) and queues it. The rows of a sweep are counted from
  /// its matrix; for nodal forces when the job starts, which then fails if they do not fit the
  /// mesh. When submit() returns, the job is on the disk. The same owner and non-empty request id
  /// give the same job.
  records::JobRecord submit(const Submission& submission);

  /// The job that the owner made by this request before, as it is now; empty where there is none.
  /// Throws request_id_reused. Ask this before submit(), whose conditions may have changed since.
  std::optional<records::JobRecord> submitted(const std::string& owner,
                                              const std::string& request_id,
                                              const std::string& fingerprint) const;

  records::JobRecord get(const std::string& id) const;  ///< live state; throws not_found
  std::vector<records::JobRecord> list(
      const store::Page& page) const;  ///< live states, newest first

  /// Takes effect within one iteration, also while queued, meshing or factorising. Idempotent.
  records::JobRecord cancel(const std::string& id);
  void erase(const std::string& id);  ///< throws not_found, in_use (not ended)

  /// The job's event log, to read and listen to; throws not_found. The events of attempt n have
  /// sequence numbers above (n-1) 2^40, so that they grow over restarts. If the job ended before
  /// this start of the server, or its log was dropped, there is only the end event, numbered above
  /// all others.
  std::shared_ptr<EventLog> events(const std::string& id) const;

  /// Throws not_found, not_ready (not ended, or no load case has an answer), result_expired.
  std::shared_ptr<const records::BlockSource> result(const std::string& id) const;

  /// Refuses new jobs, starts none, and lets running jobs go on for at most `grace`. Jobs that have
  /// not ended by then stay in the store as queued, for the next start, without an end event.
  /// Returns when all workers are idle. Idempotent.
  void stop(std::chrono::milliseconds grace);

  /// Whether no job runs, and the logs of those that ran have their end events.
  bool idle() const;
  EngineMetrics metrics() const;
  const EngineOptions& options() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::jobs
