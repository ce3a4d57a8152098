// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/preparation_pool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <system_error>
#include <utility>

#include "errors/errors.hpp"
#include "jobs/stage_end.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;
using store::JobState;
using store::MeshState;

constexpr std::chrono::milliseconds shortest_retry{100};
/// Each is an event in the logs of jobs.
constexpr std::chrono::seconds between_reports{2};
constexpr const char* waiting_for_memory = "waiting for memory to factorise";

std::string phase_of(MeshState state) {
  switch (state) {
    case MeshState::pending:
      return "waiting for the mesher";
    case MeshState::meshing:
      return "meshing";
    default:
      return "factorising";
  }
}

/// "meshing: bisecting a mesh, 120000 triangles".
std::string text_of(const store::MeshProgress& progress) {
  std::string text = phase_of(MeshState::meshing);
  if (!progress.doing.empty()) text += ": " + progress.doing;
  if (progress.triangles > 0) text += fmt::format(", {} triangles", progress.triangles);
  if (progress.expected_triangles > 0)
    text += fmt::format(" of about {}", progress.expected_triangles);
  return text;
}

}  // namespace

PreparationPool::PreparationPool(EngineCore& core) : _core(core) {
  const Lock lock(core.mutex);
  _threads.push_back(core.start(lock, [this] { work(); }));
}

PreparationPool::~PreparationPool() {
  for (std::thread& thread : _threads) thread.join();
}

void PreparationPool::work() {
  Lock lock(_core.mutex);
  while (!_core.quitting) {
    const auto now = EngineCore::Clock::now();
    if (!_core.to_refine.empty()) {
      make_others_look();
      end_stage(_core, lock, _core.to_refine.pop());
      continue;
    }
    if (const auto mesh = _core.schedule.next_to_prepare(now)) {
      make_others_look();
      prepare(lock, Mesh(_core.meshes.at(*mesh)));
      continue;
    }
    ++_idle;
    if (const auto retry = _core.schedule.next_retry(now))
      _core.preparers.wait_until(lock, *retry);
    else
      _core.preparers.wait(lock);
    --_idle;
  }
}

void PreparationPool::make_others_look() {
  if (_idle > 0) {
    _core.preparers.notify_one();
    return;
  }
  try {
    _threads.emplace_back([this] { work(); });
  } catch (const std::system_error&) {
    // The threads there are take what waits one after the other.
  }
}

void PreparationPool::tell(MeshWork& mesh, const std::string& phase) {
  std::vector<std::pair<std::shared_ptr<EventLog>, PhaseEvent>> events;
  {
    const std::lock_guard lock(_core.mutex);
    if (mesh.phase == phase) return;
    mesh.phase = phase;
    for (const auto& [number, job] : mesh.jobs) {
      if (job->state == JobState::running) {  // a stage of it
        events.push_back({job->log, {job->state, stage_name(*job) + ": " + phase}});
        continue;
      }
      job->state = JobState::waiting_for_mesh;
      add_step(job->timeline, job->state, phase);
      events.push_back({job->log, {job->state, phase}});
    }
  }
  for (auto& [log, event] : events) log->append(std::move(event));
}

void PreparationPool::tell(MeshWork& mesh, const store::MeshProgress& progress) {
  const std::string text = text_of(progress);
  std::vector<std::pair<std::shared_ptr<EventLog>, PhaseEvent>> events;
  {
    const std::lock_guard lock(_core.mutex);
    for (const auto& [number, job] : mesh.jobs)
      if (job->state == JobState::waiting_for_mesh)
        events.push_back({job->log, {job->state, text}});
  }
  for (auto& [log, event] : events) log->append(std::move(event));
}

void PreparationPool::prepare(Lock& lock, const Mesh& mesh) {
  mesh->preparing.emplace();
  const std::stop_token stop = mesh->preparing->get_token();
  // A mesh that waits for memory is tried every second, perhaps for hours: one event says so.
  const bool retry = mesh->phase == waiting_for_memory;
  lock.unlock();
  std::shared_ptr<const operators::MeshOperator> mesh_operator;
  std::optional<Error> failure;
  try {
    mesh_operator = _core.catalogue.prepare(
        mesh->id,
        [&](MeshState state) {
          if (!retry) tell(*mesh, phase_of(state));
        },
        stop,
        [&, told = EngineCore::Clock::time_point()](const store::MeshProgress& progress) mutable {
          const auto now = EngineCore::Clock::now();
          if (now - told < between_reports) return;
          told = now;
          tell(*mesh, progress);
        });
  } catch (const Error& error) {
    failure = error;
  } catch (const std::exception& error) {
    failure = Error(Reason::internal, error.what());
  }
  const bool busy = failure && failure->reason() == Reason::busy;
  const bool stopped = failure && failure->reason() == Reason::cancelled;
  if (busy) tell(*mesh, waiting_for_memory);

  lock.lock();
  mesh->preparing.reset();
  std::vector<JobPtr> failed;
  if (busy) {
    const auto delay = std::max(shortest_retry, failure->retry_delay());
    _core.schedule.again(mesh->id, EngineCore::Clock::now() + delay);
  } else {
    mesh->phase.clear();
    if (mesh_operator) {
      mesh->mesh_operator = std::move(mesh_operator);
      _core.schedule.prepared(mesh->id);
      _core.solvers.notify_all();
    } else if (stopped) {
      _core.schedule.let_go(mesh->id);
    } else {
      // Not at once, for jobs that come while the others are being failed.
      _core.schedule.again(mesh->id, EngineCore::Clock::now() + shortest_retry);
      for (const auto& [number, job] : std::map(mesh->jobs))
        if (!fall_back_a_stage(_core, lock, job, *failure)) failed.push_back(job);
    }
  }
  _core.release(mesh);
  _core.preparers.notify_all();
  if (!failed.empty()) {
    lock.unlock();
    for (const JobPtr& job : failed) _core.stop(job, Stop::failed, mesh_failed(mesh->id, *failure));
    lock.lock();
  }
}

}  // namespace anticrack::jobs
