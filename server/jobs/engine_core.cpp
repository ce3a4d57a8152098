// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/engine_core.hpp"

#include <algorithm>
#include <numeric>
#include <system_error>
#include <utility>

#include "fields/walk.hpp"
#include "jobs/accuracy.hpp"
#include "jobs/block_run.hpp"
#include "jobs/event_rows.hpp"
#include "jobs/spreading.hpp"
#include "operators/freed_memory.hpp"
#include "records/case_record.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using records::JobState;

/// Bytes of results between two returns of freed memory to the system: the records that stay lie
/// between the arrays that went, and would keep their pages.
constexpr std::uint64_t trim_every = std::uint64_t{16} << 20U;

/// Updates LiveStages::indicator by maxima, so the order in which load cases end does not matter.
void add_indicator(LiveStages& stages, const records::AccuracySpec& wanted,
                   const records::CaseRecord& record, std::vector<double>& indicator) {
  constexpr double most = 1e3;  // for a case that has no bounds of A yet
  const double factor = std::min(excess(stage_answer(record, wanted.largest), wanted), most);
  const double sum = std::accumulate(indicator.begin(), indicator.end(), 0.0);
  if (!(factor > 1) || !(sum > 0)) return;
  for (double& one : indicator) one *= factor / sum;
  const std::lock_guard lock(stages.indicator_mutex);
  if (stages.indicator.empty()) {
    stages.indicator = std::move(indicator);
    return;
  }
  for (std::size_t t = 0; t < indicator.size(); ++t)
    stages.indicator[t] = std::max(stages.indicator[t], indicator[t]);
}

}  // namespace

EngineCore::EngineCore(EngineOptions engine_options, store::Store& records,
                       meshes::MeshCatalogue& mesh_catalogue)
    : options(std::move(engine_options)),
      store(records),
      catalogue(mesh_catalogue),
      queue(records.queue()),
      rows(queue != nullptr ? std::make_shared<EventRows>(*this) : nullptr),
      admission({static_cast<std::size_t>(std::max(0, options.max_queued_jobs)),
                 static_cast<std::uint64_t>(std::max(0, options.max_queued_cases)),
                 options.max_job_memory}),
      retention({static_cast<std::size_t>(std::max(0, options.max_kept_jobs)), options.result_ttl,
                 options.result_budget}),
      memory(std::make_shared<MemoryBudget>(options.max_job_memory)),
      logs(memory),
      waits(catalogue, [this](const meshes::MeshNews& news) { hear(*this, news); }) {}

void EngineCore::quit() {
  const std::lock_guard lock(mutex);
  quitting = true;
  for (auto* changed : {&solvers, &ending, &sweeping, &limits, &claiming, &telling, &spreading})
    changed->notify_all();
}

std::jthread EngineCore::start(std::function<void()> work) {
  try {
    return std::jthread(std::move(work));
  } catch (const std::system_error&) {
    quit();
    throw;
  }
}

void EngineCore::add(const JobPtr& job) {
  if (!job->helps)
    jobs.insert_or_assign(job->id(), job);  // one that this server lost may still be winding down
  numbers.emplace(job->number, job);
  ++live;
  if (const auto mesh = enter_mesh(job); !mesh->phase.empty()) {
    job->enter(Phase::waiting_for_mesh);
    add_step(job->timeline, JobState::waiting_for_mesh, mesh->phase);
    // Appending with the lock held is safe here, as there are no watchers yet.
    job->log->append(PhaseEvent{JobState::waiting_for_mesh, mesh->phase});
  }
}

std::shared_ptr<MeshWork> EngineCore::enter_mesh(const JobPtr& job) {
  std::shared_ptr<MeshWork>& mesh = meshes[job->mesh];
  if (!mesh) mesh = std::make_shared<MeshWork>(job->mesh);
  mesh->jobs.emplace(job->number, job);
  mesh->waiting[index(job->lane)] += job->units;
  offer(job);
  return mesh;
}

void EngineCore::leave_mesh(const JobPtr& job) {
  const std::shared_ptr<MeshWork> mesh = meshes.at(job->mesh);
  mesh->jobs.erase(job->number);
  release(mesh);
}

void EngineCore::move_on(const JobPtr& job) {
  leave_mesh(job);
  job->mesh = job->stages->records.back().mesh;
  job->mesh_operator.reset();
  job->spool.reset();
  job->stages->before.clear();
  for (const LiveCase& one : job->cases) job->stages->before.push_back(one.record);
  job->cases.assign(job->cases.size(), {});
  job->next_unit = 0;
  job->result_bytes = 0;
  job->answer_bytes = 0;
  enter_mesh(job);
}

void EngineCore::move_back(const JobPtr& job) {
  leave_mesh(job);
  job->mesh = job->stages->records.back().mesh;
  job->next_unit = 0;
  enter_mesh(job);
}

void EngineCore::withdraw(const JobPtr& job) {
  schedule.remove(job->number);
  meshes.at(job->mesh)->waiting[index(job->lane)] -= job->units - job->next_unit;
  job->next_unit = job->units;
}

void EngineCore::offer(const JobPtr& job) {
  schedule.add(
      {job->number, job->mesh, job->lane, job->spec->priority, job->since, job->created.owner});
  MeshWork& mesh = *meshes.at(job->mesh);
  if (mesh.mesh_operator)
    solvers.notify_all();
  else if (mesh.wait > 0)
    waits.join(mesh.wait, job->spec->priority, job->since);
  else
    mesh.wait = waits.begin(mesh.id, job->spec->priority, job->since);
}

void EngineCore::begin_units(const JobPtr& job, std::optional<SweepPlan> plan) {
  if (plan) job->sweep = std::make_unique<LiveSweep>(std::move(*plan));
  std::uint64_t& waiting = meshes.at(job->mesh)->waiting[index(job->lane)];
  waiting -= job->units;
  if (queue != nullptr && (!job->sweep || job->sweep->plan.portion_chunks > 0)) begin_spread(job);
  job->units = job->spread ? 0 : job->sweep->chunks.size();
  waiting += job->units;
}

void EngineCore::settle(const JobPtr& job) {
  if (job->is_ending() || job->active > 0 || job->next_unit < job->units) return;
  if (job->stages && !job->stages->over && job->why == Stop::none) {
    ++job->active;
    to_refine.push(job->created.owner, job);
    solvers.notify_one();
    return;
  }
  const bool interrupted = job->why == Stop::interrupted || job->helps;
  job->enter(interrupted ? Phase::over : Phase::ending);
  leave(job);
  --live;
  if (job->helps && job->why == Stop::failed) not_helped.insert(job->id());
  if (interrupted) {
    admission.ended(job->created.owner, job->spec_bytes);
    running -= job->started ? 1 : 0;
    job->mesh_operator.reset();
    job->spool.reset();
    job->sweep.reset();
    job->sweep_record = {};
    job->stages.reset();
    give_up(job);
  } else {
    ++not_announced;
    to_end.push(job->created.owner, job);
    ending.notify_one();
  }
  settled.notify_all();
  queue_changed = true;
  claiming.notify_all();
}

void EngineCore::give_up(const JobPtr& job) {
  if (queue == nullptr || job->helps) return;
  if (const auto found = jobs.find(job->id()); found != jobs.end() && found->second == job)
    jobs.erase(found);
  rows->follow(job->id(), job->log);
}

void EngineCore::leave(const JobPtr& job) {
  admission.cases_ended(job->spec->mesh, std::exchange(job->queued_cases, 0));
  if (!job->started) admission.started();
  deadlines.clear(job->number);
  numbers.erase(job->number);
  leave_mesh(job);
}

void EngineCore::end_wait(MeshWork& mesh) {
  if (mesh.wait > 0) waits.end(std::exchange(mesh.wait, 0));
}

void EngineCore::release(const std::shared_ptr<MeshWork>& mesh) {
  if (!mesh->jobs.empty() || mesh->threads > 0 || !mesh->blocks.empty() ||
      !meshes.contains(mesh->id) || meshes.at(mesh->id) != mesh)
    return;
  end_wait(*mesh);
  schedule.let_go(mesh->id);
  meshes.erase(mesh->id);
}

void EngineCore::deliver(std::vector<EndedCase> cases) {
  if (cases.empty()) return;
  bool trim = false;
  Lock lock(mutex);
  for (EndedCase& ended_case : cases) {
    LiveJob& job = *ended_case.task.job;
    if (job.stages && ended_case.task.index < job.stages->before.size()) {
      auto record = std::make_shared<records::CaseRecord>(*ended_case.outcome.record);
      tighten(*record, *job.stages->before[ended_case.task.index]);
      ended_case.outcome.record = std::move(record);
    }
    if (ended_case.outcome.result && job.result_bytes > options.max_result_bytes)
      ended_case.outcome = refused_case(ended_case.task, options.max_result_bytes);
    const std::uint64_t before = job.result_bytes;
    job.result_bytes += ended_case.outcome.result ? ended_case.outcome.result->run.bytes : 0;
    trim = trim || job.result_bytes / trim_every > before / trim_every;
  }
  lock.unlock();
  if (trim) operators::return_freed_memory();
  for (EndedCase& ended_case : cases) {
    LiveJob& job = *ended_case.task.job;
    job.log->append(
        CaseEvent{static_cast<std::int32_t>(ended_case.task.index), ended_case.outcome.record});
    if (job.stages)
      add_indicator(*job.stages, *job.spec->accuracy, *ended_case.outcome.record,
                    ended_case.outcome.indicator);
  }
  lock.lock();
  for (EndedCase& ended_case : cases) {
    const JobPtr& job = ended_case.task.job;
    LiveCase& live_case = job->cases[ended_case.task.index];
    live_case.running = false;
    live_case.record = std::move(ended_case.outcome.record);
    live_case.result = std::move(ended_case.outcome.result);
    job->answer_bytes += fields::bytes_of(*live_case.record);
    --job->active;
    ++cases_ended;
    std::uint64_t of_stages = 0;
    if (job->stages) {
      const std::lock_guard of_indicator(job->stages->indicator_mutex);
      of_stages = job->stages->last.bytes + fields::bytes_of(job->stages->indicator);
    } else {
      --job->queued_cases;
      admission.cases_ended(job->spec->mesh, 1);
    }
    job->memory.set(job->spec_bytes + job->answer_bytes + of_stages +
                    (job->spool ? job->spool->memory() : 0));
    settle(job);
  }
}

void EngineCore::deliver(EndedChunk chunk) {
  const JobPtr job = chunk.task.job;
  const std::size_t place = chunk.task.index;
  if (chunk.failure) stop(job, Stop::failed, chunk.failure);
  Lock lock(mutex);
  if (chunk.columns && !job->sweep->chunks[place].columns) {  // else it is here from two sides
    job->sweep->chunks[place] = std::move(chunk.solved);
    jobs::add(job->sweep_record, chunk.record);
    lock.unlock();
    if (!job->helps) job->log->append(RowsEvent{job->sweep->plan.first_row(place), chunk.columns});
    lock.lock();
  }
  if (!chunk.fetched) {
    cases_ended += chunk.record.converged + chunk.record.not_converged;
    note_solved(*this, chunk);
  }
  --job->active;
  settle(job);
}

std::vector<EndedCase> EngineCore::take_stopped(MeshWork& mesh) {
  std::vector<EndedCase> stopped;
  for (const std::shared_ptr<BlockRun>& block : mesh.blocks) {
    if (!block->iterating)
      for (const Task& task : block->abandon_stopped())
        stopped.push_back({task, cancelled_case(task)});
  }
  std::erase_if(mesh.prepared, [&](const PreparedCase& prepared) {
    const LiveJob& job = *prepared.task.job;
    if (job.why == Stop::none) return false;
    schedule.unpark(mesh.id, Lane::active_set, job.spec->priority);
    stopped.push_back({prepared.task, cancelled_case(prepared.task)});
    return true;
  });
  return stopped;
}

void EngineCore::stop(const JobPtr& job, Stop why, const std::optional<Error>& failure) {
  std::vector<EndedCase> stopped;
  Lock lock(mutex);
  if (job->is_ending()) {
    if (why != Stop::cancelled) return;
    if (job->phase == Phase::refused) {
      job->why = why;
      ending.notify_one();
    }
    lock.unlock();
    job->writing.request_stop();
    return;
  }
  if (job->why != Stop::none) return;
  job->why = why;
  job->failure = failure;
  withdraw(job);
  const std::shared_ptr<MeshWork> mesh = meshes.at(job->mesh);
  stopped = take_stopped(*mesh);
  settle(job);
  lock.unlock();
  job->stop.request_stop();
  deliver(std::move(stopped));
}

}  // namespace anticrack::jobs
