// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/families.hpp"

#include <prometheus/gauge.h>

#include <array>

#include "metrics/phases.hpp"

namespace anticrack::metrics {
namespace {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;
using Buckets = prometheus::Histogram::BucketBoundaries;

/// More than the API has: only a bug, or somebody who makes names up, gets beyond it.
constexpr std::size_t most_methods = 64;

/// Seconds of a call: unary ones end in milliseconds, watches last as long as their job.
Buckets call_buckets() {
  return {0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 60, 600, 3600};
}

/// Seconds of work: a small mesh takes hundredths, a large queue a day.
Buckets work_buckets() {
  return {0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100, 300, 1000, 3600, 10'000, 86'400};
}

std::string text(std::string_view view) {
  return std::string(view);
}

}  // namespace

std::string code_name(int code) {
  constexpr std::array names{"OK",
                             "CANCELLED",
                             "UNKNOWN",
                             "INVALID_ARGUMENT",
                             "DEADLINE_EXCEEDED",
                             "NOT_FOUND",
                             "ALREADY_EXISTS",
                             "PERMISSION_DENIED",
                             "RESOURCE_EXHAUSTED",
                             "FAILED_PRECONDITION",
                             "ABORTED",
                             "OUT_OF_RANGE",
                             "UNIMPLEMENTED",
                             "INTERNAL",
                             "UNAVAILABLE",
                             "DATA_LOSS",
                             "UNAUTHENTICATED"};
  const auto index = static_cast<std::size_t>(code);
  return code >= 0 && index < names.size() ? names[index] : "UNKNOWN";
}

Families::Families(const std::string& version, const std::string& build)
    : _registry(std::make_shared<prometheus::Registry>()),
      _handled(BuildCounter()
                   .Name("anticrack_rpc_handled_total")
                   .Help("Calls that ended, by method and code.")
                   .Register(*_registry)),
      _call_time(BuildHistogram()
                     .Name("anticrack_rpc_duration_seconds")
                     .Help("Time of a call from its start to its end, by method.")
                     .Register(*_registry)),
      _jobs_ended(BuildCounter()
                      .Name("anticrack_jobs_ended_total")
                      .Help("Jobs that ended, by state.")
                      .Register(*_registry)),
      _job_failures(BuildCounter()
                        .Name("anticrack_job_failures_total")
                        .Help("Jobs that failed, by reason.")
                        .Register(*_registry)),
      _queue_wait(BuildHistogram()
                      .Name("anticrack_queue_wait_seconds")
                      .Help("Time from a job's creation to its start, by priority.")
                      .Register(*_registry)),
      _phase_time(BuildHistogram()
                      .Name("anticrack_job_phase_seconds")
                      .Help("Time an ended job spent in a phase, by phase.")
                      .Register(*_registry)),
      _mesh_time(BuildHistogram()
                     .Name("anticrack_meshing_seconds")
                     .Help("Time the mesher took for a mesh.")
                     .Register(*_registry)
                     .Add({}, work_buckets())),
      _mesh_failures(BuildCounter()
                         .Name("anticrack_mesh_failures_total")
                         .Help("Meshes that could not be made, by reason.")
                         .Register(*_registry)),
      _factorization_time(BuildHistogram()
                              .Name("anticrack_factorization_seconds")
                              .Help("Time of a factorisation that succeeded.")
                              .Register(*_registry)
                              .Add({}, work_buckets())) {
  BuildGauge()
      .Name("anticrack_build_info")
      .Help("1, with the version and the build as labels.")
      .Register(*_registry)
      .Add({{"version", version}, {"build", build}})
      .Set(1);
  // From zero: a rate over a counter that appears with its first event misses that event.
  for (const auto state :
       {store::JobState::succeeded, store::JobState::failed, store::JobState::cancelled}) {
    _jobs_ended.Add({{"state", text(name(state))}});
  }
}

std::string Families::known_method(const std::string& method) {
  const std::lock_guard lock(_mutex);
  if (_methods.size() < most_methods) _methods.insert(method);
  return _methods.contains(method) ? method : "other";
}

void Families::call_ended(const std::string& method, int code, std::chrono::duration<double> time) {
  const std::string label = known_method(method);
  _handled.Add({{"method", label}, {"code", code_name(code)}}).Increment();
  _call_time.Add({{"method", label}}, call_buckets()).Observe(time.count());
}

void Families::job_ended(const store::JobRecord& job) {
  _jobs_ended.Add({{"state", text(name(job.state))}}).Increment();
  if (job.state == store::JobState::failed && job.error) {
    _job_failures.Add({{"reason", text(errors::name(job.error->reason()))}}).Increment();
  }
  if (job.started) {
    const std::chrono::duration<double> wait = *job.started - job.created;
    _queue_wait.Add({{"priority", text(name(job.spec.priority))}}, work_buckets())
        .Observe(wait.count());
  }
  const PhaseTimes times = phase_times(job);
  for (std::size_t i = 0; i < phase_count; ++i) {
    if (times[i].count() <= 0) continue;
    _phase_time.Add({{"phase", text(name(static_cast<Phase>(i)))}}, work_buckets())
        .Observe(times[i].count());
  }
}

void Families::meshed(const store::MeshRecord& mesh) {
  if (mesh.error) {
    _mesh_failures.Add({{"reason", text(errors::name(mesh.error->reason()))}}).Increment();
  } else {
    _mesh_time.Observe(mesh.mesh_seconds);
  }
}

void Families::factorised(std::chrono::duration<double> time) {
  _factorization_time.Observe(time.count());
}

}  // namespace anticrack::metrics
