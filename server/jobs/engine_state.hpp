// SPDX-License-Identifier: GPL-3.0-or-later
//
// The inside of the job engine: its jobs, and the threads that work on them.
//
// A job is at each moment in one place only: in the queue, with a preparation thread, runnable or
// with solver threads, or in the hands of the one thread that ends it (LiveJob::ending).
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "errors/errors.hpp"
#include "jobs/job_engine.hpp"
#include "jobs/job_queue.hpp"
#include "jobs/live_job.hpp"

namespace anticrack::jobs {

struct JobEngine::State {
  using JobPtr = std::shared_ptr<LiveJob>;
  using Lock = std::unique_lock<std::mutex>;

  State(EngineOptions engine_options, store::Store& records, meshes::MeshCatalogue& meshes);
  /// Joins the threads; all jobs must have ended.
  ~State();

  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void prepare_jobs();  ///< a preparation thread
  void solve_cases();   ///< a solver thread

  void prepare(const JobPtr& job);
  void start(Lock& lock, const JobPtr& job);
  void solve_next_case(Lock& lock);
  /// To be called whenever a running job has lost a thread or is to be stopped: makes it ready to
  /// be ended when nothing is left to do. With the lock held.
  void settle(const JobPtr& job);
  /// Ends a job in `ending` for good: cases that never ran fail with `failure` where there is one
  /// (the mesh's), else they are cancelled. Without the lock.
  void end(const JobPtr& job, const std::optional<errors::Error>& failure);
  void cancel(const JobPtr& job);  ///< without the lock

  std::vector<std::string> forget_oldest();  ///< with the lock held; returns their ids

  const EngineOptions options;
  store::Store& store;
  meshes::MeshCatalogue& catalogue;
  std::atomic<std::uint64_t> iterations{0};

  mutable std::mutex mutex;
  std::condition_variable changed;
  bool draining = false;
  bool quitting = false;
  std::unordered_map<std::string, JobPtr> jobs;  ///< those that are kept after their end as well
  JobQueue queue;
  std::deque<JobPtr> runnable;  ///< running, with cases that no thread has taken; oldest first
  std::deque<JobPtr> finished;  ///< running no more, to be ended by a solver thread
  int running = 0;
  std::uint64_t created = 0;  ///< jobs so far
  std::uint64_t ended = 0;
  std::uint64_t announced = 0;  ///< ended, and the end event is in the log
  std::uint64_t cases_ended = 0;
  struct Kept {
    std::string id;
    std::uint64_t bytes = 0;
  };
  std::deque<Kept> kept;  ///< ended jobs, oldest first

  std::vector<std::thread> threads;
};

}  // namespace anticrack::jobs
