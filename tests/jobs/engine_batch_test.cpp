// SPDX-License-Identifier: GPL-3.0-or-later
//
// Load cases of many jobs on one mesh, together and alone; many meshes in turns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "jobs/engine_support.hpp"
#include "records/case_record.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::eventually;
using contact::Status;
using records::JobRecord;
using records::JobState;
using namespace std::chrono_literals;

/// Jobs of all kinds: both methods, both masses, several thetas, lengths and numbers of cases.
std::vector<records::JobSpec> mix(const std::string& mesh) {
  std::vector<records::JobSpec> specs;
  for (int j = 0; j < 12; ++j) {
    records::JobSpec spec = short_job(mesh);
    spec.fields = j % 4 == 0;
    spec.loads.clear();
    for (int i = 0; i <= j % 5; ++i) {
      spec.loads.push_back({"load " + std::to_string(i),
                            fem::Expression{"sin(" + std::to_string(i + j) + "*x) + y"}, ""});
    }
    if (j % 3 == 0) {
      spec.solver = contact::ActiveSetOptions{};
    } else {
      uzawa_of(spec).mass = j % 3 == 1 ? contact::Mass::lumped : contact::Mass::consistent;
      uzawa_of(spec).epsilon = 1e-300;  // so that none stops an iteration earlier than alone
      uzawa_of(spec).max_iterations = 40 + 30 * j;
    }
    specs.push_back(std::move(spec));
  }
  return specs;
}

/// The end that the answers of a job that ran to its end call for.
JobState end_of(const JobRecord& record) {
  const bool all = std::all_of(
      record.cases.begin(), record.cases.end(),
      [](const records::CaseRecord& each) { return each.status == contact::Status::converged; });
  return all ? JobState::succeeded : JobState::not_converged;
}

using NamedArrays = std::map<std::string, std::vector<double>>;

NamedArrays arrays_of(const records::BlockSource& block) {
  NamedArrays arrays;
  for (const records::ArrayLayout& layout : block.arrays()) {
    if (layout.type == records::ArrayType::float64 &&
        layout.name.find("history") == std::string::npos) {
      arrays[layout.name] = *array<double>(block, layout.name);
    }
  }
  return arrays;
}

double largest_difference(const NamedArrays& a, const NamedArrays& b) {
  double difference = a.size() == b.size() ? 0 : HUGE_VAL;
  for (const auto& [name, values] : a) {
    const auto found = b.find(name);
    if (found == b.end() || found->second.size() != values.size()) {
      return HUGE_VAL;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      difference = std::max(difference, std::abs(values[i] - found->second[i]));
    }
  }
  return difference;
}

TEST(EngineBatch, EqualsEachAlone) {
  std::vector<NamedArrays> alone;
  {
    Engine test(one_thread());
    for (const records::JobSpec& spec : mix(test.ready_mesh())) {
      const std::string id = test.submit(spec);
      const JobRecord record = test.ended(id);
      ASSERT_EQ(record.state, end_of(record));
      alone.push_back(arrays_of(*test.engine.result(id)));
    }
  }
  EngineOptions options;
  options.threads = 2;
  options.columns = 5;
  options.turn = 1ms;
  Engine test(options);
  std::vector<std::string> ids;
  for (const records::JobSpec& spec : mix(test.ready_mesh())) {
    ids.push_back(test.submit(spec));
  }
  for (std::size_t j = 0; j < ids.size(); ++j) {
    const JobRecord record = test.ended(ids[j]);
    ASSERT_EQ(record.state, end_of(record));
    EXPECT_LT(largest_difference(arrays_of(*test.engine.result(ids[j])), alone[j]), 1e-12) << j;
  }
}

TEST(EngineBatch, JobsOnOneMeshRunTogether) {
  EngineOptions options;
  options.threads = 1;
  options.columns = 3;
  Engine test(options);
  const std::string mesh = test.ready_mesh();
  const std::string first = test.submit(endless_job(mesh));
  ASSERT_TRUE(test.iterating(first));
  const std::string second = test.submit(endless_job(mesh));
  ASSERT_TRUE(test.reaches(second, JobState::running));
  // A third joins, ends and leaves while the others go on.
  EXPECT_EQ(test.ended(test.submit(short_job(mesh))).state, JobState::succeeded);
  EXPECT_TRUE(eventually([&] { return test.engine.metrics().columns == 2; }));
  EXPECT_EQ(test.state(first), JobState::running);
  test.engine.cancel(first);
  EXPECT_EQ(test.ended(first).state, JobState::cancelled);
  EXPECT_EQ(test.state(second), JobState::running);
  const auto log = test.engine.events(second);
  const std::uint64_t latest = log->latest();
  EXPECT_TRUE(eventually([&] { return log->latest() > latest; }));
}

TEST(EngineBatch, TheCasesOfOneJobAreSharedByIdleThreads) {
  EngineOptions options;
  options.threads = 2;
  options.columns = 8;
  Engine test(options);
  const std::string mesh = test.ready_mesh();
  records::JobSpec spec = endless_job(mesh);
  spec.loads.clear();
  for (int i = 0; i < 8; ++i) {
    spec.loads.push_back({std::to_string(i), fem::Expression{"y > 0 ? 1 : -1"}, ""});
  }
  // One thread would iterate eight columns or none; two have four each, not always in step. A
  // thread that was not yet idle when the job came has no share: the next job finds it idle.
  const auto shared = [&] {
    const std::string id = test.submit(spec);
    const std::uint64_t before = test.engine.metrics().iterations;
    bool seen = false;
    EXPECT_TRUE(eventually([&] {
      const EngineMetrics metrics = test.engine.metrics();
      seen = seen || metrics.columns == 4;
      return seen || metrics.iterations > before + 100'000;
    }));
    test.engine.cancel(id);
    test.ended(id);
    return seen;
  };
  EXPECT_TRUE(eventually(shared));
}

TEST(EngineBatch, MeshesTakeTurnsOnOneThread) {
  EngineOptions options;
  options.threads = 1;
  options.turn = 1ms;
  options.long_step = 1h;
  Engine test(options);
  const std::string busy = test.submit(endless_job(test.ready_mesh(0.1)));
  ASSERT_TRUE(test.iterating(busy));
  const std::string other = test.submit(endless_job(test.ready_mesh(0.2)));
  ASSERT_TRUE(test.reaches(other, JobState::running));
  records::JobSpec exact = short_job(test.ready_mesh(0.25));
  exact.solver = contact::ActiveSetOptions{};
  EXPECT_EQ(test.ended(test.submit(exact)).state, JobState::succeeded);
  exact.mesh = test.engine.get(busy).spec.mesh;  // another lane of a mesh with an endless block
  EXPECT_EQ(test.ended(test.submit(exact)).state, JobState::succeeded);
  for (const std::string& id : {busy, other}) {
    const auto log = test.engine.events(id);
    const std::uint64_t latest = log->latest();
    EXPECT_TRUE(eventually([&] { return log->latest() > latest + 5; }));
  }
  test.engine.cancel(busy);
  EXPECT_EQ(test.ended(busy).state, JobState::cancelled);
}

TEST(EngineBatch, AMoreUrgentJobNeedsNoPlaceInAFullBlock) {
  Engine test(one_thread());
  const std::string mesh = test.ready_mesh();
  records::JobSpec bulk = endless_job(mesh);
  bulk.priority = records::Priority::bulk;
  const std::string busy = test.submit(bulk);
  ASSERT_TRUE(test.iterating(busy));
  EXPECT_EQ(test.ended(test.submit(short_job(mesh))).state, JobState::succeeded);
  EXPECT_EQ(test.state(busy), JobState::running);
  const auto log = test.engine.events(busy);
  const std::uint64_t latest = log->latest();
  EXPECT_TRUE(eventually([&] { return log->latest() > latest; }));
}

TEST(EngineBatch, TheMoreUrgentJobStartsFirst) {
  Engine test(one_thread());
  const std::string mesh = test.ready_mesh();
  const std::string blocker = test.submit(endless_job(mesh));
  ASSERT_TRUE(test.iterating(blocker));
  std::vector<std::string> ids;
  for (const records::Priority priority :
       {records::Priority::bulk, records::Priority::normal, records::Priority::interactive}) {
    records::JobSpec spec = short_job(mesh);
    spec.priority = priority;
    ids.push_back(test.submit(spec));
  }
  test.engine.cancel(blocker);
  std::vector<records::Clock::time_point> starts;
  for (const std::string& id : ids) {
    starts.push_back(test.ended(id).started.value());
  }
  EXPECT_LT(starts[2], starts[1]);
  EXPECT_LT(starts[1], starts[0]);
}

}  // namespace
}  // namespace anticrack::jobs
