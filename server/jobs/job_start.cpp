// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/job_start.hpp"

#include <exception>
#include <utility>

namespace anticrack::jobs {

namespace {

using store::JobState;

constexpr std::chrono::milliseconds retry_start{1'000};

std::chrono::milliseconds limit(std::chrono::milliseconds own, std::chrono::milliseconds server) {
  return own.count() > 0 ? own : server;
}

}  // namespace

std::chrono::milliseconds queue_limit(const LiveJob& job, const EngineOptions& options) {
  return limit(job.spec->queue_time_limit, options.queue_time);
}

std::chrono::milliseconds run_limit(const LiveJob& job, const EngineOptions& options) {
  return limit(job.spec->run_time_limit, options.run_time);
}

void start_job(EngineCore& core, EngineCore::Lock& lock,
               std::shared_ptr<const operators::MeshOperator> mesh_operator, const JobPtr& job) {
  core.schedule.remove(job->number);
  ++job->active;  // nobody ends it before its first event is out
  const JobSnapshot snapshot(*job);
  lock.unlock();
  bool stored = true;
  try {
    store::JobRecord record = snapshot.record();
    record.state = JobState::running;
    record.started = store::Clock::now();
    add_step(record.timeline, JobState::running, {});
    core.store.put(record);
  } catch (const std::exception&) {
    stored = false;
  }
  lock.lock();
  if (!stored) {
    --job->active;
    if (job->why == Stop::none) {
      core.deadlines.set(job->number, Due::start, EngineCore::Clock::now() + retry_start);
      core.limits.notify_one();
    }
    core.settle(job);
    return;
  }
  core.admission.started();
  ++core.running;
  job->state = JobState::running;
  job->started = store::Clock::now();
  job->mesh_operator = std::move(mesh_operator);
  add_step(job->timeline, JobState::running, {});
  core.deadlines.clear(job->number, Due::queue_time);
  core.deadlines.set(job->number, Due::run_time,
                     EngineCore::Clock::now() + run_limit(*job, core.options));
  core.limits.notify_one();
  lock.unlock();
  job->log->append(PhaseEvent{JobState::running, {}});
  lock.lock();
  --job->active;
  if (job->why == Stop::none) {
    core.offer(job);
  }
  core.settle(job);
}

}  // namespace anticrack::jobs
