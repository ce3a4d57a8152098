// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <array>
#include <iterator>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "metrics/http_page.hpp"
#include "metrics/phases.hpp"
#include "metrics/pulled.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"

namespace anticrack::metrics {
namespace {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;
using prometheus::Counter;
using prometheus::Family;
using prometheus::Histogram;

/// More than the API has: limits the labels that made-up method names can add.
constexpr std::size_t max_methods = 64;

/// Seconds of a call: unary calls take milliseconds, watches last as long as their job.
const Histogram::BucketBoundaries call_buckets{0.001, 0.003, 0.01, 0.03, 0.1, 0.3,
                                               1,     3,     10,   60,   600, 3600};

/// Seconds of work: a small mesh takes hundredths, a long queue a day.
const Histogram::BucketBoundaries work_buckets{0.01, 0.03, 0.1, 0.3,  1,    3,      10,
                                               30,   100,  300, 1000, 3600, 10'000, 86'400};

/// Name of a gRPC status code.
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

template <class Builder>
auto& family(prometheus::Registry& registry, Builder builder, const char* name, const char* help) {
  return builder.Name(name).Help(help).Register(registry);
}

double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

void append(std::vector<prometheus::MetricFamily>& all,
            std::vector<prometheus::MetricFamily> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

/// Ignores errors of `action`, as metrics must never make anything else fail.
template <class Action>
void quietly(const Action& action) noexcept {
  try {
    action();
  } catch (...) {
  }
}

}  // namespace

struct Metrics::State {
  State(const std::string& version, const std::string& build) {
    family(registry, BuildGauge(), "anticrack_build_info",
           "1, with the version and the build as labels.")
        .Add({{"version", version}, {"build", build}})
        .Set(1);
    // Begin at zero: a rate over a counter that appears with its first event misses that event.
    for (const auto state : {records::JobState::succeeded, records::JobState::not_converged,
                             records::JobState::failed, records::JobState::cancelled})
      jobs_ended.Add({{"state", std::string(name(state))}});
  }

  std::string known_method(const std::string& method) {
    const std::lock_guard lock(methods_mutex);
    if (methods.size() < max_methods) methods.insert(method);
    return methods.contains(method) ? method : "other";
  }

  /// The page. Values that cannot be read are left out; an alert fires on their absence.
  std::string page(const std::function<Snapshot()>& read) const noexcept {
    std::vector<prometheus::MetricFamily> all;
    quietly([&] {
      append(all, registry.Collect());
      append(all, process_families(started));
      const Snapshot now = read();
      append(all, server_families(now));
      if (now.group) append(all, group_families(*now.group, now.engine.leases_lost));
    });
    std::string text;
    quietly([&] { text = prometheus::TextSerializer().Serialize(all); });
    return text;
  }

  const double started = seconds_since_1970();
  prometheus::Registry registry;
  Family<Counter>& handled = family(registry, BuildCounter(), "anticrack_rpc_handled_total",
                                    "Calls that ended, by method and code.");
  Family<Histogram>& call_time =
      family(registry, BuildHistogram(), "anticrack_rpc_duration_seconds",
             "Time of a call from its start to its end, by method.");
  Family<Counter>& jobs_ended =
      family(registry, BuildCounter(), "anticrack_jobs_ended_total", "Jobs that ended, by state.");
  Family<Counter>& job_failures = family(registry, BuildCounter(), "anticrack_job_failures_total",
                                         "Jobs that failed, by reason.");
  Family<Histogram>& queue_wait = family(registry, BuildHistogram(), "anticrack_queue_wait_seconds",
                                         "Time from a job's creation to its start, by priority.");
  Family<Histogram>& phase_time = family(registry, BuildHistogram(), "anticrack_job_phase_seconds",
                                         "Time an ended job spent in a phase, by phase.");
  Histogram& mesh_time = family(registry, BuildHistogram(), "anticrack_meshing_seconds",
                                "Time the mesher took for a mesh.")
                             .Add({}, work_buckets);
  Family<Counter>& mesh_failures = family(registry, BuildCounter(), "anticrack_mesh_failures_total",
                                          "Meshes that could not be made, by reason.");
  Histogram& factorization_time =
      family(registry, BuildHistogram(), "anticrack_factorization_seconds",
             "Time of a factorisation that succeeded.")
          .Add({}, work_buckets);
  Counter& attempts_lost =
      family(registry, BuildCounter(), "anticrack_job_attempts_lost_total",
             "Attempts before the last one of jobs that ended: their server died or stopped.")
          .Add({});
  Histogram& store_time = family(registry, BuildHistogram(), "anticrack_store_seconds",
                                 "Time of a transaction with the database of several servers.")
                              .Add({}, call_buckets);
  std::mutex methods_mutex;
  std::set<std::string> methods;
  std::mutex http_mutex;
  std::unique_ptr<HttpPage> http;
};

Metrics::Metrics(const std::string& version, const std::string& build)
    : _state(std::make_unique<State>(version, build)) {}

Metrics::~Metrics() { stop(); }

void Metrics::call_ended(const std::string& method, int code,
                         std::chrono::duration<double> time) noexcept {
  quietly([&] {
    const std::string label = _state->known_method(method);
    _state->handled.Add({{"method", label}, {"code", code_name(code)}}).Increment();
    _state->call_time.Add({{"method", label}}, call_buckets).Observe(time.count());
  });
}

void Metrics::job_ended(const records::JobRecord& job) noexcept {
  quietly([&] {
    _state->jobs_ended.Add({{"state", std::string(name(job.state))}}).Increment();
    _state->attempts_lost.Increment(job.attempt - 1);
    if (job.state == records::JobState::failed && job.error) {
      const std::string reason(errors::name(job.error->reason()));
      _state->job_failures.Add({{"reason", reason}}).Increment();
    }
    if (job.started) {
      const std::chrono::duration<double> wait = *job.started - job.created;
      _state->queue_wait.Add({{"priority", std::string(name(job.spec.priority))}}, work_buckets)
          .Observe(wait.count());
    }
    const PhaseTimes times = phase_times(job);
    for (std::size_t i = 0; i < phase_count; ++i) {
      if (times[i].count() <= 0) continue;
      _state->phase_time.Add({{"phase", std::string(name(static_cast<Phase>(i)))}}, work_buckets)
          .Observe(times[i].count());
    }
  });
}

void Metrics::meshed(const records::MeshRecord& mesh) noexcept {
  quietly([&] {
    if (mesh.error) {
      const std::string reason(errors::name(mesh.error->reason()));
      _state->mesh_failures.Add({{"reason", reason}}).Increment();
    } else {
      _state->mesh_time.Observe(mesh.mesh_seconds);
    }
  });
}

void Metrics::factorised(std::chrono::duration<double> time) noexcept {
  quietly([&] { _state->factorization_time.Observe(time.count()); });
}

void Metrics::store_answered(std::chrono::duration<double> time) noexcept {
  quietly([&] { _state->store_time.Observe(time.count()); });
}

std::string Metrics::listen(const std::string& address, std::function<Snapshot()> read,
                            std::function<bool()> ready) {
  const std::lock_guard lock(_state->http_mutex);
  try {
    _state->http = std::make_unique<HttpPage>(
        address, "/metrics", "text/plain; version=0.0.4; charset=utf-8",
        [state = _state.get(), read = std::move(read)] { return state->page(read); },
        std::move(ready));
  } catch (const std::exception& problem) {
    throw errors::Error(errors::Reason::invalid_argument,
                        "cannot serve metrics on {}: {}; give another HOST:PORT", address,
                        problem.what())
        .at("metrics-listen");
  }
  return _state->http->address();
}

void Metrics::stop() {
  const std::lock_guard lock(_state->http_mutex);
  _state->http.reset();
}

}  // namespace anticrack::metrics
