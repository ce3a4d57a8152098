// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/stage_end.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <numeric>
#include <utility>
#include <variant>

#include "estimate/marking.hpp"
#include "jobs/accuracy.hpp"
#include "jobs/case_outcome.hpp"
#include "jobs/result_block.hpp"
#include "records/mesh_record.hpp"
#include "stop/stop.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;

/// The next stage aims at this fraction of the accuracy: bounds fall a little less than predicted.
constexpr double aim = 0.85;

/// Of the indicators in a stage.
constexpr double least_reduction = 1.2;

/// Growth of the number of triangles by bisections that only make the mesh conform.
constexpr double conforming = 1.25;

std::uint64_t most_triangles(const EngineCore& core, const LiveJob& job) {
  const std::uint64_t asked = job.spec->accuracy->max_triangles;
  const std::uint64_t server = core.catalogue.max_triangles();
  return asked > 0 ? std::min(asked, server) : server;
}

/// The chord angle of the job's meshes; the default if the first of them was deleted.
double chord_angle(const EngineCore& core, const LiveJob& job) {
  double angle = 0;
  try {
    const records::MeshRecord mesh = core.catalogue.get(job.spec->mesh);
    if (const auto* source = std::get_if<records::GeometrySource>(&mesh.definition))
      angle = source->options.chord_angle;
  } catch (const Error&) {
  }
  return angle > 0 ? angle : mesh::default_chord_angle;
}

/// Makes the mesh of the next stage, as fine as the accuracy asks for and the limit allows; errors
/// fall as triangles^-rate. Throws errors::Error.
records::MeshRecord next_mesh(EngineCore& core, const LiveJob& job,
                              const std::vector<double>& indicator, double rate,
                              std::uint64_t most) {
  const double sum = std::accumulate(indicator.begin(), indicator.end(), 0.0);
  for (double reduction = std::min(std::pow(sum / aim, 1 / rate), estimate::most_reduction);;
       reduction = 1 + (reduction - 1) / 2) {
    const std::vector<std::uint8_t> levels =
        estimate::levels(indicator, std::max(reduction, least_reduction));
    const bool last_try = reduction <= least_reduction;
    if (!last_try && estimate::expected_triangles(levels) * conforming > static_cast<double>(most))
      continue;
    try {
      return core.catalogue.refine({job.mesh, job.id(), job.created.owner}, levels, most);
    } catch (const Error& error) {
      if (error.reason() != Reason::limit_exceeded || last_try) throw;
    }
  }
}

/// Forgets the operators of a mesh that no other stage needs.
void evict(EngineCore& core, const std::string& mesh) {
  try {
    core.catalogue.evict(mesh);
  } catch (const Error&) {
    // Somebody uses them; they will be evicted when memory is needed.
  }
}

/// Stores the progress for the next start of the server, which otherwise solves the stage again.
void store_progress(EngineCore& core, const JobSnapshot& snapshot,
                    const std::vector<records::StageRecord>& stages) {
  try {
    records::JobRecord record = snapshot.record();
    record.stages = stages;
    core.store.put(record);
  } catch (const std::exception&) {
    // If the disk refuses now, the next stage tries again.
  }
}

}  // namespace

void end_stage(EngineCore& core, const JobPtr& job) {
  EngineCore::Lock lock(core.mutex);
  LiveStages& stages = *job->stages;
  std::vector<records::StageRecord> records = stages.records;
  std::vector<const records::CaseRecord*> cases;
  for (const LiveCase& live : job->cases) cases.push_back(live.record.get());
  const std::vector<double> indicator = std::exchange(stages.indicator, {});
  const JobSnapshot snapshot(*job);
  const auto now = EngineCore::Clock::now();
  lock.unlock();

  records::StageRecord& ended = records.back();
  ended.seconds =
      stages.seconds_before + std::chrono::duration<double>(now - *stages.begun).count();
  const bool largest = job->spec->accuracy->largest;
  for (const records::CaseRecord* one : cases) ended.answers.push_back(stage_answer(*one, largest));
  const std::uint64_t most = most_triangles(core, *job);
  ended.forecast = forecast(records, *job->spec, most);
  const auto event = std::make_shared<const records::StageRecord>(ended);
  const double rate = rate_of(records, *job->spec->accuracy);
  Verdict verdict = judge(records, cases, *job->spec, most, ended.seconds, chord_angle(core, *job));
  LiveStages::Complete complete;
  std::shared_ptr<void> use;
  std::string finer;   // id of the mesh that was made
  bool begun = false;  // whether the next stage has begun
  if (!verdict.over && !stages.no_finer.empty())
    verdict = {true, not_reached(*event, cases, *job->spec, stages.no_finer)};
  if (!verdict.over) {
    const stop::Scope scope(job->stop.get_token());
    try {
      const records::MeshRecord mesh = next_mesh(core, *job, indicator, rate, most);
      finer = mesh.id;
      use = core.catalogue.use(mesh.id);
      complete = {job->cases, result_block(*job), job->answer_bytes + job->spool->memory()};
      records.push_back({mesh.id, mesh.triangle_count});
      begun = true;
      store_progress(core, snapshot, records);
    } catch (...) {
      const Error error = error_of(std::current_exception());
      const bool stopped = error.reason() == Reason::cancelled && job->stop.stop_requested();
      const bool triangles = error.reason() == Reason::limit_exceeded && error.fields().empty();
      const std::string why = triangles ? limit_reached(*job->spec, most) : error.what();
      if (!stopped) verdict = {true, not_reached(*event, cases, *job->spec, why)};
    }
  }
  job->log->append(StageEvent{event});

  lock.lock();
  --job->active;
  if (!finer.empty()) stages.made.push_back(finer);
  if (verdict.over || job->why != Stop::none) {
    // After a restart of the server, the answers of the stage before are gone.
    const bool fall_back = verdict.fall_back && !stages.last.cases.empty();
    if (begun || fall_back) records.pop_back();
    if (fall_back)
      job->cases = std::exchange(stages.last.cases, {});
    else
      stages.last = {};
    stages.records = std::move(records);
    stages.over = verdict.over;
    stages.not_reached = std::move(verdict.not_reached);
    core.settle(job);
    return;
  }
  stages.records = std::move(records);
  stages.last = std::move(complete);
  stages.mesh_use = std::move(use);
  const std::string before = job->mesh;
  core.move_on(job);
  lock.unlock();
  if (before != job->spec->mesh) evict(core, before);
}

bool fall_back_a_stage(EngineCore& core, const JobPtr& job, const Error& error) {
  if (!job->stages || job->stages->records.size() < 2 || job->why != Stop::none ||
      job->is_ending() || error.reason() != Reason::limit_exceeded)
    return false;
  LiveStages& stages = *job->stages;
  core.withdraw(job);
  stages.records.pop_back();
  if (stages.last.cases.empty()) {
    stages.no_finer = error.what();
    stages.records.back() = {stages.records.back().mesh, stages.records.back().triangles};
    core.move_back(job);
    return true;
  }
  stages.over = true;
  stages.not_reached = not_reached(stages.records.back(), {}, *job->spec, error.what());
  job->cases = std::exchange(stages.last.cases, {});
  core.settle(job);
  return true;
}

}  // namespace anticrack::jobs
