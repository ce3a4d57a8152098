// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "jobs/job_engine.hpp"
#include "records/job_record.hpp"
#include "store/canonical.hpp"
#include "support/backend.hpp"
#include "support/eventually.hpp"

namespace anticrack::jobs {

/// A job of one load case that converges in many iterations.
inline records::JobSpec short_job(const std::string& mesh) {
  records::JobSpec spec;
  spec.mesh = mesh;
  spec.loads = {{"pull", fem::Expression{"y > 0 ? 1 : -1"}, ""}};
  contact::UzawaOptions uzawa;
  uzawa.theta.reset();
  uzawa.epsilon = 1e-10;
  spec.solver = uzawa;
  return spec;
}

inline contact::UzawaOptions& uzawa_of(records::JobSpec& spec) {
  return std::get<contact::UzawaOptions>(spec.solver);
}

/// A job that iterates for as long as anybody would wait: its steps are tiny.
inline records::JobSpec endless_job(const std::string& mesh) {
  records::JobSpec spec = short_job(mesh);
  uzawa_of(spec).theta = 1e-7;
  uzawa_of(spec).epsilon = 1e-300;
  uzawa_of(spec).max_iterations = std::numeric_limits<int>::max();
  return spec;
}

/// Waits for the last event, so nothing of the job is left to happen.
inline records::JobRecord ended(const JobEngine& engine, const std::string& id) {
  const std::shared_ptr<EventLog> log = engine.events(id);
  std::shared_ptr<const records::JobRecord> record;
  EXPECT_TRUE(anticrack::testing::eventually([&] {
    if (log->latest() < log->earliest()) {
      return false;
    }
    const auto last = log->read(log->latest() - 1, 1);
    const auto* end = std::get_if<EndEvent>(&last.at(0).event);
    record = end == nullptr ? nullptr : end->job;
    return record != nullptr;
  }));
  return record ? *record : records::JobRecord();
}

inline bool reaches(const JobEngine& engine, const std::string& id, records::JobState state) {
  return anticrack::testing::eventually([&] { return engine.get(id).state == state; });
}

/// A mesh whose operators are in memory and held by nobody.
inline std::string ready_mesh(anticrack::testing::Backend& backend, double size = 0.1) {
  const std::string id = backend.create(size);
  EXPECT_TRUE(anticrack::testing::eventually([&] { return backend.catalogue.ready(id); }));
  return id;
}

inline EngineOptions unlimited(EngineOptions options = {}) {
  options.max_iterations = std::numeric_limits<int>::max();
  return options;
}

/// One load case at a time: what waits behind an endless one waits for good.
inline EngineOptions one_thread() {
  EngineOptions options;
  options.threads = 1;
  options.columns = 1;
  options.long_step = std::chrono::hours(1);  // nor does a spare thread solve another
  return options;
}

class Engine {
 public:
  explicit Engine(EngineOptions options = {},
                  const anticrack::testing::BackendOptions& backend_options = {})
      : backend(backend_options),
        engine(unlimited(std::move(options)), *backend.store, backend.catalogue) {}

  /// As CreateJob does it: a request that is known is answered before anything else is asked.
  std::string submit(const records::JobSpec& spec, const std::string& request_id = {},
                     const std::string& owner = {}) {
    const std::string print = store::CanonicalHash().add_all(spec).finish();
    if (const auto made = engine.submitted(owner, request_id, print)) return made->id;
    return engine.submit({spec, owner, request_id, print}).id;
  }
  std::vector<records::JobRecord> list(std::size_t count = 100) const {
    return engine.list({"", count, {}});
  }
  records::JobState state(const std::string& id) const { return engine.get(id).state; }
  bool reaches(const std::string& id, records::JobState wanted) const {
    return jobs::reaches(engine, id, wanted);
  }
  records::JobRecord ended(const std::string& id) const { return jobs::ended(engine, id); }
  std::string ready_mesh(double size = 0.1) { return jobs::ready_mesh(backend, size); }
  std::vector<NumberedEvent> events(const std::string& id) const {
    return engine.events(id)->read(0, SIZE_MAX);
  }
  bool told(const std::string& id, const std::string& detail) const {
    for (const NumberedEvent& event : events(id)) {
      const auto* phase = std::get_if<PhaseEvent>(&event.event);
      if (phase != nullptr && phase->detail == detail) {
        return true;
      }
    }
    return false;
  }
  bool iterating(const std::string& id) const {
    return anticrack::testing::eventually(
        [&] { return state(id) == records::JobState::running && engine.metrics().iterations > 0; });
  }

  anticrack::testing::Backend backend;
  JobEngine engine;
};

/// The array of a block; none where it has no such array.
template <class T>
std::optional<std::vector<T>> array(const records::BlockSource& block, const std::string& name) {
  for (const records::ArrayLayout& layout : block.arrays()) {
    if (layout.name == name) {
      std::uint64_t count = 1;
      for (const std::uint64_t extent : layout.shape) {
        count *= extent;
      }
      std::vector<T> values(count);
      block.read(layout.offset, std::as_writable_bytes(std::span(values)));
      return values;
    }
  }
  return std::nullopt;
}

}  // namespace anticrack::jobs
