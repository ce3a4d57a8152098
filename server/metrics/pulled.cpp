// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/pulled.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>
#include <utility>

namespace anticrack::metrics {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

template <class Number>
MetricFamily counter(std::string name, std::string help, Number value) {
  ClientMetric metric;
  metric.counter.value = static_cast<double>(value);
  return {std::move(name), std::move(help), MetricType::Counter, {metric}};
}

template <class Number>
MetricFamily gauge(std::string name, std::string help, Number value) {
  ClientMetric metric;
  metric.gauge.value = static_cast<double>(value);
  return {std::move(name), std::move(help), MetricType::Gauge, {metric}};
}

/// A gauge with a value for each word of a label.
using Values = std::vector<std::pair<std::string, std::uint64_t>>;
MetricFamily gauges(const char* name, const char* help, const char* label, const Values& values) {
  MetricFamily family{name, help, MetricType::Gauge, {}};
  for (const auto& [word, value] : values) {
    ClientMetric& metric = family.metric.emplace_back();
    metric.label = {{label, word}};
    metric.gauge.value = static_cast<double>(value);
  }
  return family;
}

/// The owners with the most bytes and jobs, and the sum of the others.
std::vector<store::OwnerUsage> bounded(std::vector<store::OwnerUsage> owners) {
  if (owners.size() <= most_owners) return owners;
  std::ranges::sort(owners, [](const store::OwnerUsage& a, const store::OwnerUsage& b) {
    return std::tie(a.result_bytes, a.jobs, a.owner) > std::tie(b.result_bytes, b.jobs, b.owner);
  });
  store::OwnerUsage others{.owner = "(others)"};
  for (std::size_t i = most_owners; i < owners.size(); ++i) {
    others.jobs += owners[i].jobs;
    others.unfinished += owners[i].unfinished;
    others.result_bytes += owners[i].result_bytes;
  }
  owners.resize(most_owners);
  owners.push_back(std::move(others));
  return owners;
}

Values by_owner(const std::vector<store::OwnerUsage>& owners,
                std::uint64_t store::OwnerUsage::*amount) {
  Values values;
  for (const store::OwnerUsage& usage : owners) values.emplace_back(usage.owner, usage.*amount);
  return values;
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

double resident_bytes() {
  double all = 0;
  double resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

std::ptrdiff_t open_descriptors() {
  std::error_code ignored;
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd", ignored), {});
}

}  // namespace

std::vector<MetricFamily> group_families(const store::GroupState& group,
                                         std::uint64_t leases_lost) {
  return {
      gauges("anticrack_group_servers", "Servers on the database, by state.", "state",
             {{"living", group.living}, {"dead", group.dead}}),
      gauges("anticrack_group_jobs", "Jobs of all servers that have not ended, by state.", "state",
             {{"waiting", group.waiting}, {"running", group.running}}),
      counter("anticrack_group_leases_lost_total", "Leases that this server lost.", leases_lost),
      gauge("anticrack_group_oldest_wait_seconds", "Longest wait of a job for a server.",
            group.oldest_wait),
      gauge("anticrack_store_clock_offset_seconds",
            "The database's clock less that of this machine.", group.clock_offset)};
}

std::vector<MetricFamily> server_families(const Snapshot& now) {
  const jobs::EngineMetrics& engine = now.engine;
  const operators::CacheMetrics& cache = now.cache;
  const std::vector<store::OwnerUsage> owners = bounded(now.owners);
  return {
      counter("anticrack_jobs_created_total", "Jobs acknowledged.", engine.jobs_created),
      counter("anticrack_load_cases_ended_total", "Load cases ended, however.",
              engine.load_cases_ended),
      counter("anticrack_iterations_total", "Iterations of all load cases.", engine.iterations),
      counter("anticrack_results_expired_total", "Results removed by age or by the budget.",
              engine.results_expired),
      gauge("anticrack_jobs_queued", "Jobs that have not started.", engine.jobs_queued),
      gauge("anticrack_jobs_running", "Jobs that run.", engine.jobs_running),
      gauge("anticrack_batch_columns", "Load cases on solver threads now.", engine.columns),
      gauge("anticrack_queue_bytes", "Bytes of the definitions of jobs that have not ended.",
            engine.queued_bytes),
      gauge("anticrack_job_memory_bytes", "Definitions, events and answers of jobs in memory.",
            engine.job_memory),
      gauge("anticrack_unfinished_jobs_limit", "Most jobs that have not ended, of all owners.",
            engine.jobs_limit),
      gauge("anticrack_kept_jobs_limit", "Most ended jobs kept, of all owners.",
            engine.kept_jobs_limit),
      gauge("anticrack_job_memory_limit_bytes", "Most bytes of definitions, events and answers.",
            engine.job_memory_limit),
      gauge("anticrack_queue_oldest_wait_seconds", "Longest wait of those that have not started.",
            engine.oldest_wait.count()),
      counter("anticrack_factorizations_total", "Factorisations begun.", cache.factorizations),
      counter("anticrack_cache_hits_total", "Operators found in memory.", cache.hits),
      counter("anticrack_cache_joins_total", "Callers that waited for a factorisation under way.",
              cache.joins),
      counter("anticrack_cache_evictions_total", "Operators dropped from memory.", cache.evictions),
      gauge("anticrack_cache_bytes", "Bytes of operators, held or reserved.", cache.bytes),
      gauge("anticrack_cache_pinned_bytes", "Of these, bytes that cannot be evicted now.",
            cache.pinned),
      gauge("anticrack_cache_budget_bytes", "Most bytes operators may take.", cache.budget),
      gauge("anticrack_cache_meshes", "Meshes whose operators are in memory.", cache.entries),
      counter("anticrack_meshings_total", "Runs of the mesher.", now.meshings),
      gauge("anticrack_meshes_pending", "Meshes that wait for the mesher or are in it.",
            now.pending_meshes),
      gauge("anticrack_store_unreachable_seconds", "How long the store has been out of reach.",
            now.store_unreachable.count()),
      gauges("anticrack_disk_bytes", "Bytes of the data folder, by kind.", "kind",
             {{"meshes", now.disk.meshes},
              {"results", now.disk.results},
              {"uploads", now.disk.uploads},
              {"database", now.disk.database}}),
      gauges("anticrack_owner_jobs", "Jobs kept, ended ones too, by owner.", "owner",
             by_owner(owners, &store::OwnerUsage::jobs)),
      gauges("anticrack_owner_unfinished_jobs", "Jobs that have not ended, by owner.", "owner",
             by_owner(owners, &store::OwnerUsage::unfinished)),
      gauges("anticrack_owner_result_bytes", "Bytes of results kept, by owner.", "owner",
             by_owner(owners, &store::OwnerUsage::result_bytes)),
      gauge("anticrack_connections", "Connections that are open.", now.connections),
      gauge("anticrack_connections_limit", "Most connections open at once, of all addresses.",
            now.connections_limit),
      counter("anticrack_connections_accepted_total", "Connections taken.",
              now.connections_accepted),
      counter("anticrack_connections_refused_total", "Connections closed at once, beyond a limit.",
              now.connections_refused),
      gauge("anticrack_watchers", "Watches that are open.", now.watchers),
      gauge("anticrack_watch_lag_events", "Events the slowest watcher is behind.", now.largest_lag),
      gauge("anticrack_transfers", "Uploads and downloads under way.", now.transfers),
      gauge("anticrack_ready", "1 while new work is taken.", now.ready),
  };
}

std::vector<MetricFamily> process_families(double started) {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  rlimit files{};
  ::getrlimit(RLIMIT_NOFILE, &files);
  return {
      gauge("process_resident_memory_bytes", "Resident memory size in bytes.", resident_bytes()),
      counter("process_cpu_seconds_total", "User and system CPU time spent in seconds.",
              seconds(usage.ru_utime) + seconds(usage.ru_stime)),
      gauge("process_start_time_seconds", "Start time since 1970 in seconds.", started),
      gauge("process_open_fds", "Open file descriptors.", open_descriptors()),
      gauge("process_max_fds", "Most open file descriptors.", files.rlim_cur),
  };
}

}  // namespace anticrack::metrics
