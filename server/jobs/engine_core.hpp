// SPDX-License-Identifier: GPL-3.0-or-later
//
// The data that the engine's threads share: the jobs, the state of each, and the one mutex.
//
// A job passes through the schedule (where its units wait: load cases, or chunks of its sweep), the
// solver threads (blocks, prepared cases) and `to_end`, the queue of the ending thread.
// LiveJob::active counts its units between the first and the last step. The threads are those of
// SolverPool, EndingThread, keep_time_limits and remove_what_is_too_old; each changes the shared
// data with the mutex held, and does long work without it. A thread of the catalogue tells the news
// of meshes (hear).
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "access/turn_queue.hpp"
#include "errors/errors.hpp"
#include "jobs/admission.hpp"
#include "jobs/case_outcome.hpp"
#include "jobs/deadlines.hpp"
#include "jobs/ended_logs.hpp"
#include "jobs/job_engine.hpp"
#include "jobs/live_job.hpp"
#include "jobs/memory_budget.hpp"
#include "jobs/retention.hpp"
#include "jobs/schedule.hpp"
#include "jobs/sweep_chunk.hpp"
#include "operators/mesh_operator.hpp"
#include "store/queue.hpp"

namespace anticrack::jobs {

class BlockRun;
class EventRows;

/// A load case that is condensed for the active set; any thread may solve it.
struct PreparedCase {
  Task task;
  operators::PreparedLoad load;
};

/// A mesh that jobs use.
struct MeshWork {
  explicit MeshWork(std::string mesh) : id(std::move(mesh)) {}

  const std::string id;
  std::map<std::uint64_t, JobPtr> jobs;  ///< jobs that wait or run, by number
  std::shared_ptr<const operators::MeshOperator> mesh_operator;
  /// The number of the wait for the operators, which ends with the first turn on the mesh. 0: none.
  std::uint64_t wait = 0;
  std::string phase;  ///< phase of its preparation, which jobs are told
  std::chrono::steady_clock::time_point progress_told{};
  int threads = 0;                                  ///< threads that have a turn on it
  std::array<std::uint64_t, lane_count> waiting{};  ///< units that no thread has taken
  std::vector<std::shared_ptr<BlockRun>> blocks;    ///< all blocks, including those put down
  std::array<std::deque<std::shared_ptr<BlockRun>>, lane_count> parked;  ///< blocks put down
  std::deque<PreparedCase> prepared;
};

class EngineCore;

/// Passes news of a mesh on to all jobs that wait for it: phases and progress become events,
/// operators give turns on solver threads, an error ends the jobs. The catalogue calls it, without
/// the lock (mesh_news.cpp).
void hear(EngineCore& core, const meshes::MeshNews& news);

/// The mutex guards everything but the constants and the atomics. It is never held over I/O, a
/// solve, an event (listeners may come back to the engine) or a stop request.
class EngineCore {
 public:
  using Lock = std::unique_lock<std::mutex>;
  using Clock = std::chrono::steady_clock;

  /// Keeps references to both. Starts no thread.
  EngineCore(EngineOptions engine_options, store::Store& records, meshes::MeshCatalogue& meshes);

  const EngineOptions options;
  store::Store& store;
  meshes::MeshCatalogue& catalogue;
  /// Of several servers on one store; null where this one is alone, and `rows` as well.
  store::Queue* const queue;
  const std::shared_ptr<EventRows> rows;
  std::atomic<std::uint64_t> iterations{0}, leases_lost{0};

  mutable std::mutex mutex;
  /// Signalled when there is work for the kind of thread.
  std::condition_variable solvers, ending, sweeping, limits;
  std::condition_variable claiming, telling, spreading;
  std::condition_variable positions;  ///< signalled when there is news for solve_portions()
  std::condition_variable settled;    ///< signalled when fewer jobs are live, ending or claimed
  bool queue_changed = false;         ///< whether there may be a job to claim, or room for one
  bool flags_changed = false;         ///< whether a job here may have been cancelled elsewhere
  bool spread_changed = false;        ///< whether there is news of a job that is spread
  int claims_under_way = 0;
  bool draining = false;      ///< whether no job may start any more
  bool interrupting = false;  ///< ends that the store refuses are left to the next start
  bool stop_noted = false;    ///< whether the store has a note of it
  bool quitting = false;
  bool ended_since_sweep = true;

  Schedule schedule;
  Admission admission;
  Deadlines deadlines;
  Retention retention;
  const std::shared_ptr<MemoryBudget> memory;
  EndedLogs logs;
  std::unordered_map<std::string, JobPtr> jobs;  ///< jobs that have not ended, by id
  std::unordered_map<std::uint64_t, JobPtr> numbers;
  std::unordered_map<std::string, std::shared_ptr<MeshWork>> meshes;
  access::TurnQueue<JobPtr> to_end;     ///< jobs to end; owners take turns
  access::TurnQueue<JobPtr> to_refine;  ///< jobs of which a stage ended; counted in LiveJob::active

  std::set<std::string> not_helped;  ///< jobs elsewhere that this server could not solve

  std::uint64_t last_number = 0;
  std::uint64_t created = 0;
  std::uint64_t ended = 0;
  std::uint64_t cases_ended = 0;  ///< rows of sweeps included
  std::uint64_t results_expired = 0;
  int live = 0;           ///< jobs that the ending thread does not have yet
  int not_announced = 0;  ///< jobs that the ending thread has and whose end was not told
  int running = 0;        ///< jobs that started and have not ended
  int columns = 0;        ///< load cases on solver threads; a chunk counts as one

  /// Waits for meshes. It is the last member, so that no news comes when the others are destroyed.
  meshes::MeshWaits waits;

  // With the lock held:

  /// Adds a new job, which is in the store and counted by `admission`.
  void add(const JobPtr& job);
  /// Puts a job's waiting units into the schedule.
  void offer(const JobPtr& job);
  /// Begins the job's next stage: it waits for the last of its meshes.
  void move_on(const JobPtr& job);
  /// Makes the job wait for the mesh of the stage before instead.
  void move_back(const JobPtr& job);
  /// Takes a job's waiting units out of the schedule.
  void withdraw(const JobPtr& job);
  /// Sets the units of a sweep that starts, or of a job with which this server helps. One that is
  /// spread has none yet.
  void begin_units(const JobPtr& job, std::optional<SweepPlan> plan);
  /// Call it when a case of the job ended or the job must stop: a job that has nothing left goes to
  /// the next step.
  void settle(const JobPtr& job);
  /// Ends the wait for the operators, if there is one: they are in use now, or not wanted.
  void end_wait(MeshWork& mesh);
  /// A job here was left to another server or to the next start: it is not live here any more.
  void give_up(const JobPtr& job);
  /// Releases the mesh's operator if nothing needs it.
  void release(const std::shared_ptr<MeshWork>& mesh);

  // Without the lock:

  /// Makes all threads end.
  void quit();
  /// Starts a thread that does `work`. If that is impossible (std::system_error), it makes the
  /// other threads end, so that their owners can join them.
  std::jthread start(std::function<void()> work);

  /// Reports the cases and counts them as ended.
  void deliver(std::vector<EndedCase> cases);
  /// Reports the rows of a chunk and counts it, or a position for another server, as ended.
  void deliver(EndedChunk chunk);
  /// Stops a job, whatever its phase. The first reason counts; a job that only waits for the disk
  /// can still be cancelled.
  void stop(const JobPtr& job, Stop why, const std::optional<errors::Error>& failure = {});

 private:
  /// Takes the load cases of stopped jobs on which no thread works: put down, or prepared.
  std::vector<EndedCase> take_stopped(MeshWork& mesh);
  /// Adds a job to the jobs of its mesh; removes it from them.
  std::shared_ptr<MeshWork> enter_mesh(const JobPtr& job);
  void leave_mesh(const JobPtr& job);
  void leave(const JobPtr& job);
};

}  // namespace anticrack::jobs
