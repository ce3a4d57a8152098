// SPDX-License-Identifier: GPL-3.0-or-later
//
// Jobs from submission to result: queue, workers, events, cancel.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "jobs/event_log.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "store/store.hpp"

namespace anticrack::jobs {

struct EngineOptions {
  int threads = 2;                 ///< load cases solved at once
  int max_load_cases = 10'000;     ///< a job
  int max_iterations = 1'000'000;  ///< a load case
  std::size_t max_expression_bytes = 4096;
  int max_queued_jobs = 1'000;              ///< then `busy` with a retry delay
  int max_kept_jobs = 10'000;               ///< ended ones; the oldest go first
  std::size_t event_log_bytes = 16u << 20;  ///< a job
  /// Traces, fields and history of one job; load cases that would come after it is reached fail.
  std::uint64_t max_result_bytes = std::uint64_t{2} << 30;
  /// Results and event logs of ended jobs together; the oldest jobs go first, never the newest.
  std::uint64_t max_kept_bytes = std::uint64_t{4} << 30;
};

struct EngineMetrics {
  std::uint64_t jobs_created = 0;
  std::uint64_t jobs_ended = 0;
  std::uint64_t load_cases_ended = 0;
  std::uint64_t iterations = 0;
  int jobs_queued = 0;   ///< now, those waiting for a mesh included
  int jobs_running = 0;  ///< now
};

/// Owns the worker threads. A job waits for its mesh on a thread of the (small) preparation pool,
/// never on a solver thread, so an expensive factorisation starves nobody. Load cases of one job
/// are independent and run on as many solver threads as are free, in order.
/// Thread-safe; no method but the destructor and `stop` blocks on a solve.
class JobEngine {
 public:
  JobEngine(EngineOptions options, store::Store& store, meshes::MeshCatalogue& catalogue);
  /// stop(0s).
  ~JobEngine();

  /// Checks the job (errors::Error with "load_cases[i]...." or "solver...." at fault: no load case,
  /// duplicate or empty name, bad expression or parameter; not_found for the mesh and for an
  /// uploaded array; busy; draining) and queues it. Same non-empty request id: the same job.
  store::JobRecord submit(const store::JobSpec& spec, const std::string& request_id);

  store::JobRecord get(const std::string& id) const;  ///< live state; throws not_found
  std::vector<store::JobRecord> list(const std::string& after, std::size_t count) const;

  /// Effective within one iteration, also while queued, meshing or factorising. Idempotent.
  store::JobRecord cancel(const std::string& id);
  void erase(const std::string& id);  ///< throws not_found, in_use (not ended)

  /// The job's event log, to read and listen to; throws not_found.
  std::shared_ptr<EventLog> events(const std::string& id) const;

  /// Throws not_found, not_ready (not ended, or no load case has an answer).
  std::shared_ptr<const store::Block> result(const std::string& id) const;

  /// Refuses new jobs, lets running load cases go on for at most `grace`, then cancels them;
  /// returns when all workers are idle. Idempotent.
  void stop(std::chrono::milliseconds grace);

  /// Every job has ended, and its end event is in its log.
  bool idle() const;
  EngineMetrics metrics() const;
  const EngineOptions& options() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::jobs
