// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/events.hpp"

#include <exception>
#include <string>

#include "errors/errors.hpp"
#include "log/log.hpp"
#include "metrics/phases.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"

namespace anticrack::app {
namespace {

using metrics::Phase;

std::string reason(const std::optional<errors::Error>& error) {
  return error ? std::string(errors::name(error->reason())) : std::string();
}

std::string message(const std::optional<errors::Error>& error) {
  return error ? std::string(error->what()) : std::string();
}

/// Ignores errors of `action`: a log line that cannot be written must not make anything fail.
template <class Action>
void quietly(const Action& action) noexcept {
  try {
    action();
  } catch (const std::exception&) {
  }
}

void log_job(const records::JobRecord& job) {
  const metrics::PhaseTimes times = metrics::phase_times(job);
  const auto in = [&](Phase phase) { return times[static_cast<std::size_t>(phase)].count(); };
  log::info("job ended", {{"job", "jobs/" + job.id},
                          {"mesh", "meshes/" + job.spec.mesh},
                          {"request_id", job.request_id},
                          {"owner", job.owner},
                          {"state", std::string(metrics::name(job.state))},
                          {"reason", reason(job.error)},
                          {"message", message(job.error)},
                          {"attempt", job.attempt},
                          {"load_cases", job.spec.sweep ? 0 : job.spec.loads.size()},
                          {"result_bytes", job.result_bytes},
                          {"queued_seconds", in(Phase::queued)},
                          {"waiting_seconds", in(Phase::waiting)},
                          {"meshing_seconds", in(Phase::meshing)},
                          {"factorizing_seconds", in(Phase::factorizing)},
                          {"solving_seconds", in(Phase::solving)},
                          {"writing_seconds", in(Phase::writing)}});
}

void log_mesh(const records::MeshRecord& mesh) {
  if (mesh.error) {
    log::warn("mesh failed", {{"mesh", "meshes/" + mesh.id},
                              {"owner", mesh.owner},
                              {"reason", reason(mesh.error)},
                              {"message", message(mesh.error)}});
  } else {
    log::info("mesh made", {{"mesh", "meshes/" + mesh.id},
                            {"owner", mesh.owner},
                            {"triangles", mesh.triangle_count},
                            {"seconds", mesh.mesh_seconds}});
  }
}

}  // namespace

void job_ended(metrics::Metrics& metrics, const records::JobRecord& job) noexcept {
  metrics.job_ended(job);
  quietly([&] { log_job(job); });
}

void meshed(metrics::Metrics& metrics, const records::MeshRecord& mesh) noexcept {
  metrics.meshed(mesh);
  quietly([&] { log_mesh(mesh); });
}

void factorised(metrics::Metrics& metrics, std::chrono::duration<double> time) noexcept {
  metrics.factorised(time);
  quietly([&] { log::info("factorised", {{"seconds", time.count()}}); });
}

}  // namespace anticrack::app
