// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/job_engine.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "errors/errors.hpp"
#include "jobs/check.hpp"
#include "jobs/claims.hpp"
#include "jobs/ending_thread.hpp"
#include "jobs/engine_core.hpp"
#include "jobs/event_rows.hpp"
#include "jobs/intake.hpp"
#include "jobs/solver_pool.hpp"
#include "jobs/upkeep.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;
using records::JobRecord;

}  // namespace

struct JobEngine::State {
  /// Starts the threads only after the jobs of the last run are queued.
  State(EngineOptions options, store::Store& store, meshes::MeshCatalogue& catalogue)
      : core(std::move(options), store, catalogue) {
    recover(core);
    pools.emplace(core);
  }

  /// The live job; null if it has ended or never existed.
  JobPtr live(const std::string& id) const {
    const std::lock_guard lock(core.mutex);
    return find(id);
  }
  JobPtr find(const std::string& id) const {  // with the lock held
    const auto found = core.jobs.find(id);
    return found == core.jobs.end() ? nullptr : found->second;
  }
  /// The record of a live job.
  std::optional<JobRecord> live_record(const std::string& id) const {
    std::optional<JobSnapshot> snapshot;
    {
      const std::lock_guard lock(core.mutex);
      if (const JobPtr job = find(id)) snapshot.emplace(*job);
    }
    return snapshot ? std::optional(snapshot->record()) : std::nullopt;
  }
  /// The record of a job that has ended.
  JobRecord stored(const std::string& id) const {
    std::optional<JobRecord> record = core.store.job(id);
    if (!record) throw Error(Reason::not_found, "there is no jobs/{}", id);
    return std::move(*record);
  }
  void interrupt(bool (*wanted)(const LiveJob&)) {
    std::vector<JobPtr> jobs;
    {
      const std::lock_guard lock(core.mutex);
      core.draining = true;
      for (const auto& [id, job] : core.jobs)
        if (wanted(*job)) jobs.push_back(job);
    }
    for (const JobPtr& job : jobs) core.stop(job, Stop::interrupted);
  }

  struct Pools {
    explicit Pools(EngineCore& core)
        : ending(core),
          retention(core.start([&core] { remove_what_is_too_old(core); })),
          limits(core.start([&core] { keep_time_limits(core); })),
          solvers(core) {
      if (core.queue != nullptr) claims.emplace(core);
    }
    EndingThread ending;
    std::jthread retention, limits;
    SolverPool solvers;
    std::optional<Claims> claims;  ///< of one of several servers
  };

  EngineCore core;
  std::optional<Pools> pools;
};

JobEngine::JobEngine(EngineOptions options, store::Store& store, meshes::MeshCatalogue& catalogue)
    : _state(std::make_unique<State>(std::move(options), store, catalogue)) {}

JobEngine::~JobEngine() {
  stop(std::chrono::milliseconds(0));
  EngineCore& core = _state->core;
  core.quit();
  _state->pools.reset();
}

JobRecord JobEngine::submit(const Submission& submission) {
  TakenIn taken = take_in(_state->core, submission);
  return taken.is_new ? std::move(taken.record) : get(taken.record.id);
}

std::optional<JobRecord> JobEngine::submitted(const std::string& owner,
                                              const std::string& request_id,
                                              const std::string& fingerprint) const {
  const std::optional<JobRecord> made =
      _state->core.store.created_before(owner, request_id, fingerprint);
  return made ? std::optional(get(made->id)) : std::nullopt;
}

JobRecord JobEngine::get(const std::string& id) const {
  std::optional<JobRecord> live = _state->live_record(id);
  return live ? std::move(*live) : _state->stored(id);
}

std::vector<JobRecord> JobEngine::list(const store::Page& page) const {
  std::vector<JobRecord> records = _state->core.store.jobs(page);
  for (JobRecord& record : records)
    if (!records::ended(record.state))
      if (std::optional<JobRecord> live = _state->live_record(record.id)) record = std::move(*live);
  return records;
}

JobRecord JobEngine::cancel(const std::string& id) {
  EngineCore& core = _state->core;
  if (const JobPtr job = _state->live(id)) {
    core.stop(job, Stop::cancelled);
    if (core.queue != nullptr) core.queue->cancel(id);  // another may have it, unheard of here
  } else if (core.queue != nullptr) {
    cancel_in_group(core, id);
  }
  return get(id);
}

void JobEngine::erase(const std::string& id) {
  if (_state->live(id)) throw Error(Reason::in_use, "jobs/{} has not ended: cancel it first", id);
  EngineCore& core = _state->core;
  if (core.queue != nullptr && !records::ended(_state->stored(id).state))
    throw Error(Reason::in_use, "jobs/{} has not ended: cancel it first", id);
  core.store.erase_job(id);
  const std::lock_guard lock(core.mutex);
  core.retention.remove(id);
  core.logs.remove(id);
}

std::shared_ptr<EventLog> JobEngine::events(const std::string& id) const {
  const EngineCore& core = _state->core;
  {
    const std::lock_guard lock(core.mutex);
    if (const JobPtr job = _state->find(id)) return job->log;
    if (std::shared_ptr<EventLog> log = core.logs.find(id)) return log;
  }
  const JobRecord record = _state->stored(id);
  return core.rows ? core.rows->follow(record) : end_alone(record);
}

std::shared_ptr<const records::BlockSource> JobEngine::result(const std::string& id) const {
  const JobRecord record = _state->stored(id);
  if (_state->live(id) || !records::ended(record.state))
    throw Error(Reason::not_ready, "jobs/{} has not ended: wait for it", id);
  if (record.expired) {
    throw Error(Reason::result_expired,
                "the result of jobs/{} was removed, by its age or to make room for others: submit "
                "the job again",
                id);
  }
  std::shared_ptr<const records::BlockSource> block = _state->core.store.result(id);
  if (!block) throw Error(Reason::not_ready, "jobs/{} ended and no load case has an answer", id);
  return block;
}

void JobEngine::stop(std::chrono::milliseconds grace) {
  EngineCore& core = _state->core;
  _state->interrupt([](const LiveJob& job) { return !job.started; });
  std::optional<Claims>& claims = _state->pools->claims;
  if (claims) claims->give_back();
  const auto all_ended = [&] { return core.live == 0 && core.not_announced == 0; };
  EngineCore::Lock lock(core.mutex);
  core.settled.wait_for(lock, grace, all_ended);
  lock.unlock();
  _state->interrupt([](const LiveJob& job) { return !job.is_ending(); });
  lock.lock();
  core.interrupting = true;
  core.ending.notify_one();
  core.settled.wait(lock, all_ended);
  if (std::exchange(core.stop_noted, true)) return;
  lock.unlock();
  if (claims) return claims->leave();
  try {
    core.store.set_running(false);
  } catch (const Error&) {
    // If the disk refuses, the jobs that ran will count a crash.
  }
}

bool JobEngine::idle() const {
  const std::lock_guard lock(_state->core.mutex);
  return _state->core.running == 0 && _state->core.not_announced == 0;
}

EngineMetrics JobEngine::metrics() const {
  const EngineCore& core = _state->core;
  const std::lock_guard lock(core.mutex);
  EngineMetrics metrics;
  metrics.jobs_created = core.created;
  metrics.jobs_ended = core.ended;
  metrics.load_cases_ended = core.cases_ended;
  metrics.iterations = core.iterations;
  metrics.results_expired = core.results_expired;
  metrics.leases_lost = core.leases_lost;
  metrics.jobs_queued = static_cast<int>(core.admission.waiting());
  metrics.jobs_running = core.running;
  metrics.columns = core.columns;
  metrics.queued_bytes = core.admission.bytes();
  metrics.job_memory = core.memory->used();
  metrics.jobs_limit = static_cast<std::uint64_t>(core.options.max_queued_jobs);
  metrics.kept_jobs_limit = static_cast<std::uint64_t>(core.options.max_kept_jobs);
  metrics.job_memory_limit = core.options.max_job_memory;
  const auto now = EngineCore::Clock::now();
  for (const auto& [number, job] : core.numbers) {
    if (!job->started) {
      metrics.oldest_wait =
          std::max<std::chrono::duration<double>>(metrics.oldest_wait, now - job->since);
    }
  }
  return metrics;
}

const EngineOptions& JobEngine::options() const noexcept { return _state->core.options; }

}  // namespace anticrack::jobs
