// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "store/records.hpp"

namespace anticrack::metrics {

/// Name of a gRPC status code, e.g. "NOT_FOUND".
std::string code_name(int code);

/// The families that count what happens. Thread-safe.
class Families {
 public:
  /// Both are labels of anticrack_build_info.
  Families(const std::string& version, const std::string& build);

  /// Count what ended; `code`: gRPC's. Of a method beyond the first so many the label is "other".
  void call_ended(const std::string& method, int code, std::chrono::duration<double> time);
  void job_ended(const store::JobRecord& job);
  void meshed(const store::MeshRecord& mesh);
  void factorised(std::chrono::duration<double> time);

  const std::shared_ptr<prometheus::Registry>& registry() const noexcept { return _registry; }

 private:
  std::string known_method(const std::string& method);

  std::shared_ptr<prometheus::Registry> _registry;
  prometheus::Family<prometheus::Counter>& _handled;
  prometheus::Family<prometheus::Histogram>& _call_time;
  prometheus::Family<prometheus::Counter>& _jobs_ended;
  prometheus::Family<prometheus::Counter>& _job_failures;
  prometheus::Family<prometheus::Histogram>& _queue_wait;
  prometheus::Family<prometheus::Histogram>& _phase_time;
  prometheus::Histogram& _mesh_time;
  prometheus::Family<prometheus::Counter>& _mesh_failures;
  prometheus::Histogram& _factorization_time;
  std::mutex _mutex;  ///< of `_methods`
  std::set<std::string> _methods;
};

}  // namespace anticrack::metrics
