// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/live_job.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <utility>
#include <variant>

#include "fields/walk.hpp"
#include "jobs/ended_logs.hpp"
#include "records/case_record.hpp"

namespace anticrack::jobs {

namespace {

using contact::Status;
using errors::Error;
using records::CaseRecord;
using records::JobRecord;
using records::JobState;

constexpr std::size_t max_steps = 48;

/// The error with another message and other fields, but the same metadata.
Error retold(const Error& error, const std::string& message,
             const std::vector<std::string>& fields) {
  Error result(error.reason(), message);
  for (const std::string& field : fields) result.at(field);
  for (const auto& [key, value] : error.metadata()) result.with(key, value);
  return result;
}

Error case_failed(const records::JobSpec& spec, std::size_t index, const Error& error) {
  std::vector<std::string> fields;
  for (const errors::FieldViolation& violation : error.fields()) fields.push_back(violation.field);
  return retold(error, "load case \"" + spec.loads[index].name + "\": " + error.what(), fields);
}

Lane lane_of(const records::JobSpec& spec) {
  if (spec.sweep) return Lane::sweep;
  const auto* uzawa = std::get_if<contact::UzawaOptions>(&spec.solver);
  if (uzawa == nullptr) return Lane::active_set;
  return uzawa->mass == contact::Mass::lumped ? Lane::lumped : Lane::consistent;
}

JobRecord without_lists(JobRecord record) {
  record.spec = {};
  record.cases.clear();
  record.stages.clear();
  return record;
}

Outcome conclude_sweep(LiveJob& job) {
  records::SweepRecord& record = job.sweep_record;
  const std::uint64_t rows = job.sweep ? job.sweep->plan.rows : job.spec->sweep->rows;
  const std::uint64_t solved = record.converged + record.not_converged;
  if (job.why == Stop::none || (job.sweep && solved == rows)) {
    return {record.converged == rows ? JobState::succeeded : JobState::not_converged, std::nullopt};
  }
  if (job.why == Stop::failed) {
    record.failed = rows - solved;
    return {JobState::failed, job.failure};
  }
  return {JobState::cancelled, std::nullopt};
}

/// Returns to the answers of the stage before, if there is one, after a stage was cut short.
void fall_back(LiveJob& job) {
  if (job.stages->last.cases.empty()) return;
  job.cases = std::move(job.stages->last.cases);
  job.stages->records.pop_back();
}

}  // namespace

LiveJob::LiveJob(std::uint64_t submission, JobRecord record, std::uint64_t cases_in_queue,
                 std::size_t event_log_bytes, std::shared_ptr<void> mesh_in_use,
                 const std::shared_ptr<MemoryBudget>& budget, bool shared)
    : number(submission),
      created(without_lists(record)),
      spec(std::make_shared<const records::JobSpec>(std::move(record.spec))),
      spec_bytes(fields::bytes_of(*spec)),
      lane(lane_of(*spec)),
      since(std::chrono::steady_clock::now()),
      log(std::make_shared<EventLog>(event_log_bytes, shared ? 0 : sequence_base(created.attempt),
                                     budget)),
      arrays(spec->loads, created.owner),
      timeline(created.timeline),
      mesh(spec->mesh),
      mesh_use(std::move(mesh_in_use)),
      cases(case_count(*spec)),
      units(spec->sweep ? 1 : cases.size()),
      queued_cases(cases_in_queue),
      memory(budget, spec_bytes),
      published(sequence_base(created.attempt)) {
  if (shared) log->jump(published);
  if (!spec->accuracy) return;
  stages = std::make_unique<LiveStages>();
  stages->records = std::move(record.stages);
  if (stages->records.empty()) return;
  mesh = stages->records.back().mesh;
  for (std::size_t i = 1; i < stages->records.size(); ++i)
    stages->made.push_back(stages->records[i].mesh);
  if (stages->records.size() > 1)
    for (records::CaseRecord& one : record.cases)
      stages->before.push_back(std::make_shared<const records::CaseRecord>(std::move(one)));
  if (stages->records.size() > 1)
    stages->seconds_before = stages->records[stages->records.size() - 2].seconds;
}

void LiveJob::enter(Phase next) {
  assert(next > phase || (next == phase && phase == Phase::waiting_for_mesh));
  assert(next != Phase::refused || phase == Phase::ending);
  phase = next;
  if (phase == Phase::running) started = records::Clock::now();
}

JobState LiveJob::state() const noexcept {
  if (phase == Phase::over) return JobState::queued;  // the next start will queue it
  return started ? JobState::running : timeline.back().state;
}

Task take_unit(const JobPtr& job) {
  Task task{job, job->next_unit++, std::chrono::steady_clock::now()};
  if (job->spread && (job->sweep || job->helps)) {
    task.index = job->spread->units[task.index];
    if (!job->sweep) task.request = job->spread->requests.at(task.index);
  }
  ++job->active;
  if (task.index < job->cases.size()) job->cases[task.index].running = true;
  return task;
}

std::size_t case_count(const records::JobSpec& spec) { return spec.sweep ? 0 : spec.loads.size(); }

void add_step(std::vector<records::Step>& timeline, JobState state, std::string detail) {
  if (timeline.size() >= max_steps)
    timeline.erase(timeline.begin() + 1);  // keeps the first, which says when it was queued
  timeline.push_back({records::Clock::now(), state, std::move(detail)});
}

JobSnapshot::JobSnapshot(const LiveJob& job) : _head(job.created), _spec(job.spec) {
  _head.state = job.state();
  _head.started = job.started;
  _head.timeline = job.timeline;
  _head.sweep = job.sweep_record;
  _rows = job.sweep ? job.sweep->plan.rows : 0;
  if (job.stages) {
    _head.stages = job.stages->records;
    _head.not_reached = job.stages->not_reached;
  }
  for (const LiveCase& live : job.cases) {
    _running.push_back(live.running);
    _cases.push_back(live.record);
  }
}

JobRecord JobSnapshot::record() const {
  JobRecord result = _head;
  result.spec = *_spec;
  if (_rows > 0) result.spec.sweep->rows = _rows;
  result.cases.resize(_cases.size());
  for (std::size_t i = 0; i < _cases.size(); ++i)
    if (_cases[i])
      result.cases[i] = *_cases[i];
    else if (_running[i])
      result.cases[i].status = Status::running;
  return result;
}

Outcome conclude(LiveJob& job) {
  if (job.spec->sweep) return conclude_sweep(job);
  const bool between_stages = job.stages && job.why != Stop::none && !job.stages->over;
  if (between_stages) fall_back(job);
  const bool failed = job.why == Stop::failed;
  const auto unsolved = std::make_shared<CaseRecord>();
  unsolved->status = failed ? Status::failed : Status::cancelled;
  unsolved->error = job.failure;
  bool complete = true;
  for (LiveCase& live : job.cases) {
    if (!live.record || (failed && live.record->status == Status::cancelled)) {
      live.record = unsolved;
      complete = false;
    }
  }
  if (failed && (between_stages || !complete)) return {JobState::failed, job.failure};
  if (between_stages) return {JobState::cancelled, std::nullopt};
  Outcome result;
  std::size_t converged_cases = 0;
  std::size_t failed_cases = 0;
  for (std::size_t i = 0; i < job.cases.size(); ++i) {
    const CaseRecord& record = *job.cases[i].record;
    if (record.status == Status::cancelled) return {JobState::cancelled, std::nullopt};
    converged_cases += record.status == Status::converged ? 1 : 0;
    if (record.status == Status::failed && ++failed_cases == 1)
      result.error = case_failed(*job.spec, i, *record.error);
  }
  if (converged_cases < job.cases.size())
    result.state = failed_cases == job.cases.size() ? JobState::failed : JobState::not_converged;
  else if (job.stages && !job.stages->not_reached.empty())
    result.state = JobState::not_converged;
  return result;
}

std::string stage_name(const LiveJob& job) {
  return fmt::format("stage {}", job.stages->records.size());
}

Error mesh_failed(const std::string& mesh, const Error& error) {
  std::vector<std::string> fields;
  for (const errors::FieldViolation& violation : error.fields())
    if (violation.field.starts_with("options.") || violation.field.starts_with("geometry."))
      fields.push_back("mesh." + violation.field);
  if (fields.empty()) fields.emplace_back("mesh");
  return retold(error, "meshes/" + mesh + ": " + error.what(), fields);
}

}  // namespace anticrack::jobs
