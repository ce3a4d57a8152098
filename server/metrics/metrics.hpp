// SPDX-License-Identifier: GPL-3.0-or-later
//
// Metrics for Prometheus: text over HTTP on a separate port. Names begin with "anticrack_" (except
// the standard process_*), units are base units, counters end in "_total". No label names a job or
// a mesh; a bounded number of owners are labels of the anticrack_owner_* families.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "jobs/job_engine.hpp"
#include "operators/operator_cache.hpp"
#include "store/store.hpp"

namespace anticrack::records {
struct JobRecord;
struct MeshRecord;
}  // namespace anticrack::records

namespace anticrack::metrics {

/// The values read at each scrape.
struct Snapshot {
  jobs::EngineMetrics engine;
  operators::CacheMetrics cache;
  store::Usage disk;
  std::vector<store::OwnerUsage> owners;
  std::optional<store::GroupState> group;
  std::chrono::duration<double> store_unreachable{0};
  std::uint64_t meshings = 0;
  int pending_meshes = 0;
  int connections = 0;
  int connections_limit = 0;
  std::uint64_t connections_accepted = 0;
  std::uint64_t connections_refused = 0;
  int watchers = 0;
  int transfers = 0;
  std::uint64_t largest_lag = 0;
  bool ready = false;
};

/// Counts and times events between scrapes. Thread-safe. Counting is quick and never throws.
class Metrics {
 public:
  /// `version` and `build` are labels of anticrack_build_info.
  Metrics(const std::string& version, const std::string& build);
  ~Metrics();

  /// Counts a call. `method`: "/anticrack.v1.UploadService/CreateUploads"; `code`: that of gRPC.
  void call_ended(const std::string& method, int code, std::chrono::duration<double> time) noexcept;
  /// Counts the job by state and reason, and its time in each phase.
  void job_ended(const records::JobRecord& job) noexcept;
  void meshed(const records::MeshRecord& mesh) noexcept;
  /// Times a transaction with the database of several servers.
  void store_answered(std::chrono::duration<double> time) noexcept;
  void factorised(std::chrono::duration<double> time) noexcept;

  /// Serves /metrics at HOST:PORT (port 0 picks one) and returns the address, and /ready for
  /// balancers: 200 if ready() and else 503. `read` is called at
  /// each scrape, on the HTTP server's thread, until stop(). Throws errors::Error
  /// (invalid_argument, field "metrics-listen").
  std::string listen(
      const std::string& address, std::function<Snapshot()> read,
      std::function<bool()> ready = [] { return true; });
  void stop();

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::metrics
