// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/mesh_news.hpp"

#include <fmt/format.h>

#include <utility>

#include "errors/errors.hpp"
#include "jobs/stage_end.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using meshes::MeshNews;
using store::JobState;
using PhaseEvents = std::vector<std::pair<std::shared_ptr<EventLog>, PhaseEvent>>;

/// Each is an event in the logs of jobs.
constexpr std::chrono::seconds between_reports{2};

std::string text_of(MeshNews::Phase phase) {
  switch (phase) {
    case MeshNews::Phase::queued:
      return "waiting for the mesher";
    case MeshNews::Phase::meshing:
      return "meshing";
    case MeshNews::Phase::waits_for_memory:
      return "waiting for memory to factorise";
    default:
      return "factorising";
  }
}

/// "meshing: bisecting a mesh, 120000 triangles".
std::string text_of(const store::MeshProgress& progress) {
  std::string text = text_of(MeshNews::Phase::meshing);
  if (!progress.doing.empty()) text += ": " + progress.doing;
  if (progress.triangles > 0) text += fmt::format(", {} triangles", progress.triangles);
  if (progress.expected_triangles > 0)
    text += fmt::format(" of about {}", progress.expected_triangles);
  return text;
}

/// How far the mesher is, to those who watch the jobs. With the lock held.
PhaseEvents events_of(MeshWork& mesh, const store::MeshProgress& progress) {
  const auto now = EngineCore::Clock::now();
  if (now - mesh.progress_told < between_reports) return {};
  mesh.progress_told = now;
  PhaseEvents events;
  for (const auto& [number, job] : mesh.jobs)
    if (job->phase == Phase::waiting_for_mesh)
      events.push_back({job->log, {JobState::waiting_for_mesh, text_of(progress)}});
  return events;
}

/// With the lock held.
PhaseEvents begin_phase(MeshWork& mesh, const std::string& phase) {
  mesh.phase = phase;
  PhaseEvents events;
  for (const auto& [number, job] : mesh.jobs) {
    if (job->started) {  // a stage of it
      events.push_back({job->log, {JobState::running, stage_name(*job) + ": " + phase}});
      continue;
    }
    job->enter(Phase::waiting_for_mesh);
    add_step(job->timeline, JobState::waiting_for_mesh, phase);
    events.push_back({job->log, {JobState::waiting_for_mesh, phase}});
  }
  return events;
}

/// The jobs that fail with their mesh. With the lock held.
std::vector<JobPtr> fail(EngineCore& core, MeshWork& mesh, const Error& why) {
  core.end_wait(mesh);
  mesh.phase.clear();
  std::vector<JobPtr> failed;
  for (const auto& [number, job] : std::map(mesh.jobs))
    if (!fall_back_a_stage(core, job, why)) failed.push_back(job);
  return failed;
}

}  // namespace

void hear(EngineCore& core, const MeshNews& news) {
  PhaseEvents events;
  std::vector<JobPtr> failed;
  {
    const std::lock_guard lock(core.mutex);
    const auto found = core.meshes.find(news.mesh);
    if (found == core.meshes.end() || found->second->wait != news.wait) return;
    const std::shared_ptr<MeshWork> mesh = found->second;
    if (news.mesh_operator) {
      mesh->mesh_operator = news.mesh_operator;
      mesh->phase.clear();
      core.schedule.prepared(mesh->id);
      core.solvers.notify_all();
    } else if (news.error) {
      failed = fail(core, *mesh, *news.error);
    } else {
      events = news.progress ? events_of(*mesh, *news.progress)
                             : begin_phase(*mesh, text_of(news.phase));
    }
  }
  for (auto& [log, event] : events) log->append(std::move(event));
  for (const JobPtr& job : failed)
    core.stop(job, Stop::failed, mesh_failed(news.mesh, *news.error));
}

}  // namespace anticrack::jobs
