// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the engine's threads share: its jobs, where each stands, and the one mutex.
//
// A job goes this way: the schedule (its units wait: load cases, or chunks of its sweep) -> solver
// threads (blocks, prepared cases) -> `to_end`, the ending thread's. LiveJob::active counts its
// units between the first and the last step. Threads are those of SolverPool,
// EndingThread, keep_time_limits and remove_what_is_too_old; each works on this with the mutex, and
// does what takes long without it. What becomes of meshes is heard on a thread of the catalogue
// (hear).
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
#include <stop_token>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "access/turn_queue.hpp"
#include "errors/errors.hpp"
#include "jobs/admission.hpp"
#include "jobs/block_run.hpp"
#include "jobs/deadlines.hpp"
#include "jobs/ended_logs.hpp"
#include "jobs/job_engine.hpp"
#include "jobs/live_job.hpp"
#include "jobs/memory_budget.hpp"
#include "jobs/retention.hpp"
#include "jobs/schedule.hpp"
#include "jobs/sweep_chunk.hpp"

namespace anticrack::jobs {

/// A load case condensed for the active set, which any thread may solve.
struct PreparedCase {
  Task task;
  operators::PreparedLoad load;
};

/// A mesh that jobs use.
struct MeshWork {
  explicit MeshWork(std::string mesh) : id(std::move(mesh)) {}

  const std::string id;
  std::map<std::uint64_t, JobPtr> jobs;  ///< that wait or run, by number
  std::shared_ptr<const operators::MeshOperator> mesh_operator;
  /// For the operators; ends with the first turn on the mesh. 0: none.
  std::uint64_t wait = 0;
  std::string phase;  ///< of its preparation, told to the jobs
  std::chrono::steady_clock::time_point progress_told{};
  int threads = 0;                                  ///< that have a turn on it
  std::array<std::uint64_t, lane_count> waiting{};  ///< units that no thread has taken
  std::vector<std::shared_ptr<BlockRun>> blocks;    ///< all, those put down included
  std::array<std::deque<std::shared_ptr<BlockRun>>, lane_count> parked;  ///< put down
  std::deque<PreparedCase> prepared;
};

class EngineCore;

/// All jobs that wait for the mesh hear it: phases and progress as events, operators as turns on
/// solver threads, an error as their end. Called by the catalogue, without the lock
/// (mesh_news.cpp).
void hear(EngineCore& core, const meshes::MeshNews& news);

/// The mutex guards everything but the constants and `iterations`. It is never held over I/O, a
/// solve, an event (listeners may come back to the engine) or a stop request.
class EngineCore {
 public:
  using Lock = std::unique_lock<std::mutex>;
  using Clock = std::chrono::steady_clock;

  /// Keeps references to both. Nothing runs yet.
  EngineCore(EngineOptions engine_options, store::Store& records, meshes::MeshCatalogue& meshes);

  const EngineOptions options;
  store::Store& store;
  meshes::MeshCatalogue& catalogue;
  std::atomic<std::uint64_t> iterations{0};

  mutable std::mutex mutex;
  /// Work for each kind of thread.
  std::condition_variable solvers, ending, sweeping, limits;
  std::condition_variable settled;  ///< fewer jobs live or end
  bool draining = false;            ///< no job starts any more
  bool interrupting = false;  ///< what the store does not take at once is left to the next start
  bool stop_noted = false;    ///< noted in the store
  bool quitting = false;
  bool ended_since_sweep = true;

  Schedule schedule;
  Admission admission;
  Deadlines deadlines;
  Retention retention;
  const std::shared_ptr<MemoryBudget> memory;
  EndedLogs logs;
  std::unordered_map<std::string, JobPtr> jobs;  ///< that have not ended, by id
  std::unordered_map<std::uint64_t, JobPtr> numbers;
  std::unordered_map<std::string, std::shared_ptr<MeshWork>> meshes;
  access::TurnQueue<JobPtr> to_end;     ///< owners take turns
  access::TurnQueue<JobPtr> to_refine;  ///< a stage ended; counted in LiveJob::active

  std::uint64_t last_number = 0;
  std::uint64_t created = 0;
  std::uint64_t ended = 0;
  std::uint64_t cases_ended = 0;  ///< rows of sweeps included
  std::uint64_t results_expired = 0;
  int live = 0;           ///< jobs that are not in the ending thread's hands
  int not_announced = 0;  ///< jobs in its hands
  int running = 0;        ///< jobs that started and have not ended
  int columns = 0;        ///< load cases on solver threads, one for a chunk

  /// For meshes. The last member: nothing is heard once the others go.
  meshes::MeshWaits waits;

  // With the lock held:

  /// Takes in a new job that is in the store and counted by `admission`.
  void add(const JobPtr& job);
  /// Puts a job's waiting units into the schedule.
  void offer(const JobPtr& job);
  /// The job's next stage begins: it waits for the last of its meshes.
  void move_on(const JobPtr& job);
  /// The job waits for the stage before instead.
  void move_back(const JobPtr& job);
  /// Takes a job's waiting units out of the schedule.
  void withdraw(const JobPtr& job);
  /// The chunks of a sweep that starts are known: they are its units from now on.
  void begin_sweep(const JobPtr& job, SweepPlan plan);
  /// Call it when a case of the job ended or the job must stop: passes on a job that has nothing
  /// left.
  void settle(const JobPtr& job);
  /// The operators of the mesh, if it waits for them, have been taken up or are not wanted.
  void end_wait(MeshWork& mesh);
  /// Releases the mesh's operator if nothing needs it.
  void release(const std::shared_ptr<MeshWork>& mesh);

  // Without the lock:

  /// Tells all threads to end.
  void quit();
  /// A thread that does `work`. Where there can be none (std::system_error) the others are told to
  /// end, so that whoever owns them can join them.
  std::jthread start(std::function<void()> work);

  /// Reports the cases and counts them as ended.
  void deliver(std::vector<EndedCase> cases);
  /// Reports the rows of a chunk and counts it as ended.
  void deliver(EndedChunk chunk);
  /// Stops a job wherever it is. The first reason counts; one that only waits for the disk can be
  /// cancelled.
  void stop(const JobPtr& job, Stop why, const std::optional<errors::Error>& failure = {});

 private:
  /// Load cases of stopped jobs that no thread iterates: put down, or prepared.
  std::vector<EndedCase> take_stopped(MeshWork& mesh);
  /// Among the jobs of its mesh, and out of them.
  std::shared_ptr<MeshWork> enter_mesh(const JobPtr& job);
  void leave_mesh(const JobPtr& job);
  void leave(const JobPtr& job);
};

}  // namespace anticrack::jobs
