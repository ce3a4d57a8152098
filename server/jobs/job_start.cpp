// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/job_start.hpp"

#include <exception>
#include <optional>
#include <utility>

#include "errors/placed.hpp"
#include "jobs/case_outcome.hpp"
#include "jobs/probes.hpp"
#include "jobs/result_block.hpp"
#include "jobs/spreading.hpp"
#include "jobs/sweep_check.hpp"
#include "jobs/sweep_chunk.hpp"
#include "jobs/sweep_plan.hpp"
#include "operators/mesh_operator.hpp"
#include "records/case_record.hpp"
#include "stop/stop.hpp"
#include "store/files.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using records::JobState;

constexpr std::chrono::milliseconds retry_start{1'000};

std::chrono::milliseconds limit(std::chrono::milliseconds own, std::chrono::milliseconds server) {
  return own.count() > 0 ? own : server;
}

/// The plan of the job's sweep, from its mesh and matrix; empty if it has no sweep.
std::optional<SweepPlan> plan_of(const EngineCore& core, const LiveJob& job,
                                 const operators::MeshOperator& mesh_operator) {
  const std::optional<records::SweepSpec>& sweep = job.spec->sweep;
  if (!sweep) return std::nullopt;
  MatrixFile matrix = find_matrix(*sweep, core.store, job.created.owner);
  errors::at(matrix_field(*sweep),
             [&] { store::require_intact_upload(matrix.path, sweep->upload); });
  return plan_sweep(*job.spec, std::move(matrix), mesh_operator, core.options);
}

/// Writes the start; returns false if the store could not take it.
bool store_start(EngineCore& core, const JobSnapshot& snapshot,
                 const std::optional<SweepPlan>& plan, const LiveStages* stages) {
  try {
    records::JobRecord record = snapshot.record();
    for (std::size_t i = 0; stages != nullptr && i < stages->before.size(); ++i)
      record.cases[i] = *stages->before[i];
    record.state = JobState::running;
    record.started = records::Clock::now();
    if (plan) record.spec.sweep->rows = plan->rows;
    add_step(record.timeline, JobState::running, {});
    core.store.put(record);
    return true;
  } catch (const store::JobTaken&) {
    throw;
  } catch (const std::exception&) {
    return false;
  }
}

void try_again_later(EngineCore& core, const LiveJob& job) {
  core.deadlines.set(job.number, Due::start, EngineCore::Clock::now() + retry_start);
  core.limits.notify_one();
}

/// Fills in the record of the first stage when the job starts, or of a recovered one; the other
/// stages have theirs since their meshes were made.
void begin_stage(LiveStages& stages, const std::string& id, const mesh::Mesh& mesh) {
  if (!stages.begun) stages.begun = EngineCore::Clock::now();
  if (stages.records.empty()) stages.records.push_back({id, mesh.triangle_count()});
}

/// Condenses the loads that a sweep combines, before any thread takes a chunk, so that no thread
/// waits for another here. Without the lock.
void condense(EngineCore& core, const JobPtr& job) {
  try {
    job->sweep->basis = condense_basis(*job, *job->mesh_operator, core.store);
  } catch (...) {
    const Error error = error_of(std::current_exception());
    if (error.reason() != errors::Reason::cancelled) core.stop(job, Stop::failed, error);
  }
}

}  // namespace

std::chrono::milliseconds queue_limit(const LiveJob& job, const EngineOptions& options) {
  return limit(job.spec->queue_time_limit, options.queue_time);
}

std::chrono::milliseconds run_limit(const LiveJob& job, const EngineOptions& options) {
  return limit(job.spec->run_time_limit, options.run_time);
}

bool may_start(EngineCore& core, const JobPtr& job) {
  core.schedule.remove(job->number);
  if (!job->started && core.memory->exceeded() && core.running > 0) {
    try_again_later(core, *job);
    return false;
  }
  ++job->active;  // so that it cannot end before its first event is in the log
  return true;
}

void start_job(EngineCore& core, std::shared_ptr<const operators::MeshOperator> mesh_operator,
               const JobPtr& job) {
  EngineCore::Lock lock(core.mutex);
  const bool another_stage = job->started.has_value();
  if (job->stages) begin_stage(*job->stages, job->mesh, mesh_operator->mesh());
  const JobSnapshot snapshot(*job);
  lock.unlock();
  std::optional<SweepPlan> plan;
  std::shared_ptr<const PlacedProbes> probes;
  bool stored = false;
  try {
    const stop::Scope scope(job->stop.get_token());
    require_result_arrays(*job->spec, mesh_operator->mesh().interfaces.size(),
                          mesh_operator->mesh().subdomains.size(), core.options.max_result_arrays);
    require_answers(*job->spec, mesh_operator->mesh().inclusions);
    probes = std::make_shared<const PlacedProbes>(place_probes(job->spec->probes, *mesh_operator));
    plan = plan_of(core, *job, *mesh_operator);
    stored = another_stage || job->helps || store_start(core, snapshot, plan, job->stages.get());
  } catch (const store::JobTaken&) {
    core.stop(job, Stop::interrupted);
  } catch (...) {
    const Error error = error_of(std::current_exception());
    const bool out_of_reach =
        error.reason() == errors::Reason::storage && error.retry_delay().count() > 0;
    if (!out_of_reach) core.stop(job, Stop::failed, error);
  }
  lock.lock();
  if (!stored) {
    --job->active;
    if (job->why == Stop::none) try_again_later(core, *job);
    core.settle(job);
    return;
  }
  job->mesh_operator = std::move(mesh_operator);
  job->probes = std::move(probes);
  job->spool = core.store.new_spool();
  if (!another_stage) {
    core.admission.started();
    ++core.running;
    job->enter(Phase::running);
    if ((plan || job->helps) && job->why == Stop::none) core.begin_units(job, std::move(plan));
    core.deadlines.clear(job->number, Due::queue_time);
    core.deadlines.set(job->number, Due::run_time,
                       EngineCore::Clock::now() + run_limit(*job, core.options));
    core.limits.notify_one();
  }
  const auto tell = [&](const std::string& phase) {  // tells that the job runs, in this phase
    add_step(job->timeline, JobState::running, phase);
    lock.unlock();
    job->log->append(PhaseEvent{JobState::running, phase});
  };
  if (job->sweep && !job->spec->loads.empty()) {
    tell("condensing the load cases");
    condense(core, job);
    lock.lock();
    if (job->sweep->basis) job->sweep_record.warnings = job->sweep->basis->warnings();
  }
  tell(job->stages ? stage_name(*job) : "");
  lock.lock();
  --job->active;
  if (job->spread) {
    make_ready(core, *job->spread);
  } else if (job->why == Stop::none) {
    core.offer(job);
  }
  core.settle(job);
}

}  // namespace anticrack::jobs
