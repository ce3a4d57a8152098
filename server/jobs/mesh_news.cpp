// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <utility>

#include "errors/errors.hpp"
#include "jobs/engine_core.hpp"
#include "jobs/stage_end.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using meshes::MeshNews;
using records::JobState;
using PhaseEvents = std::vector<std::pair<std::shared_ptr<EventLog>, PhaseEvent>>;

/// The least time between reports, as each is an event in the logs of jobs.
constexpr std::chrono::seconds between_reports{2};

const char* text_of(MeshNews::Phase phase) {
  using enum MeshNews::Phase;
  return phase == queued             ? "waiting for the mesher"
         : phase == meshing          ? "meshing"
         : phase == waits_for_memory ? "waiting for memory to factorise"
                                     : "factorising";
}

/// The progress as text, like "meshing: bisecting a mesh, 120000 triangles".
std::string text_of(const records::MeshProgress& progress) {
  std::string text = text_of(MeshNews::Phase::meshing);
  if (!progress.doing.empty()) text += ": " + progress.doing;
  if (progress.triangles > 0) text += fmt::format(", {} triangles", progress.triangles);
  if (progress.expected_triangles > 0)
    text += fmt::format(" of about {}", progress.expected_triangles);
  return text;
}

/// The events for the jobs of a mesh. With the lock held.
PhaseEvents events_of(MeshWork& mesh, const MeshNews& news) {
  const std::string text = news.progress ? text_of(*news.progress) : text_of(news.phase);
  if (!news.progress) mesh.phase = text;
  PhaseEvents events;
  for (const auto& [number, job] : mesh.jobs) {
    if (job->started) {  // a later stage, whose mesh the mesher does not make
      if (!news.progress)
        events.push_back({job->log, {JobState::running, stage_name(*job) + ": " + text}});
      continue;
    }
    if (!news.progress) {
      job->enter(Phase::waiting_for_mesh);
      add_step(job->timeline, JobState::waiting_for_mesh, text);
    }
    events.push_back({job->log, {JobState::waiting_for_mesh, text}});
  }
  return events;
}

/// Returns the jobs that fail with their mesh. With the lock held.
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
    } else if (const auto now = EngineCore::Clock::now();
               !news.progress || now - mesh->progress_told >= between_reports) {
      if (news.progress) mesh->progress_told = now;
      events = events_of(*mesh, news);
    }
  }
  for (auto& [log, event] : events) log->append(std::move(event));
  for (const JobPtr& job : failed)
    core.stop(job, Stop::failed, mesh_failed(news.mesh, *news.error));
}

}  // namespace anticrack::jobs
