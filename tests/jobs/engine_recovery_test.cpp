// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the next start makes of what the last one left.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <optional>
#include <thread>

#include "jobs/engine_support.hpp"
#include "records/case_record.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::Backend;
using anticrack::testing::eventually;
using anticrack::testing::throws;
using errors::Reason;
using records::JobRecord;
using records::JobState;
using namespace std::chrono_literals;

/// A job whose first load case takes a while and whose second is quick.
records::JobSpec long_job(const std::string& mesh) {
  records::JobSpec spec = short_job(mesh);
  spec.loads.push_back({"second", 1.0, ""});
  uzawa_of(spec).theta = 1e-3;
  uzawa_of(spec).epsilon = 1e-300;
  uzawa_of(spec).max_iterations = 20'000;
  return spec;
}

TEST(EngineRecovery, RunsWhatRanAgainWithTheSameNumbers) {
  Backend backend;
  const std::string mesh = ready_mesh(backend);
  std::string id, queued;
  std::uint64_t latest = 0;
  {
    JobEngine engine(unlimited(one_thread()), *backend.store, backend.catalogue);
    id = engine.submit({long_job(mesh), "alice", "request"}).id;
    // It does not get further than its first samples before the engine is stopping.
    std::promise<void> begun, stopping;
    int events = 0;
    const auto listener = engine.events(id)->listen([&] {
      if (++events == 5) {
        begun.set_value();
        stopping.get_future().wait();
      }
    });
    begun.get_future().wait();
    queued = engine.submit({short_job(mesh), "", ""}).id;
    std::thread stopper([&] { engine.stop(0ms); });
    EXPECT_TRUE(eventually([&] {
      return throws(
          [&] {
            engine.cancel(engine.submit({short_job(mesh), "", ""}).id);
          },
          Reason::draining);
    }));
    stopping.set_value();
    stopper.join();
    latest = engine.events(id)->latest();
  }
  ASSERT_FALSE(records::ended(backend.store->job(id)->state));
  JobEngine engine(unlimited(one_thread()), *backend.store, backend.catalogue);
  const JobRecord record = ended(engine, id);
  EXPECT_EQ(record.state, JobState::not_converged);  // its iterations are bounded
  EXPECT_EQ(record.attempt, 2);
  EXPECT_EQ(record.owner, "alice");
  EXPECT_GT(engine.events(id)->earliest(), latest);
  EXPECT_EQ(engine.events(id)->earliest(), (std::uint64_t{1} << 40U) + 1);
  EXPECT_EQ(engine.submit({long_job(mesh), "alice", "request"}).id, id);
  EXPECT_EQ(ended(engine, queued).attempt, 1);

  const std::string alone = engine.submit({long_job(mesh), "", ""}).id;
  const JobRecord reference = ended(engine, alone);
  for (const char* name : {"loads/0/traces/0/jump", "loads/1/traces/0/pressure"}) {
    EXPECT_EQ(array<double>(*engine.result(id), name), array<double>(*engine.result(alone), name));
  }
  EXPECT_EQ(record.cases[0].answer.iterations, reference.cases[0].answer.iterations);
}

TEST(EngineRecovery, KnowsEndedJobsByTheirEndAlone) {
  anticrack::testing::TemporaryFolder folder;
  anticrack::testing::BackendOptions options;
  options.data_folder = (folder / "data").string();
  std::string id;
  {
    Engine test({}, options);
    id = test.submit(short_job(test.ready_mesh()), "request", "alice");
    test.ended(id);
  }
  Engine test({}, options);  // the store is opened again, too
  const auto log = test.engine.events(id);
  EXPECT_EQ(log->earliest(), (std::uint64_t{1} << 40U) + 1);
  EXPECT_EQ(test.ended(id).state, JobState::succeeded);
  EXPECT_TRUE(array<double>(*test.engine.result(id), "loads/0/traces/0/jump"));
  const std::string mesh = test.engine.get(id).spec.mesh;
  EXPECT_EQ(test.submit(short_job(mesh), "request", "alice"), id);
  EXPECT_NE(test.submit(short_job(mesh), "request", "bob"), id);
  EXPECT_EQ(test.engine.list({"", 10, "alice"}).size(), 1U);
}

/// Submits a job and stops while it runs.
void submit_and_stop(Backend& backend, const std::string& mesh, std::string& id) {
  JobEngine engine(unlimited(one_thread()), *backend.store, backend.catalogue);
  id = engine.submit({endless_job(mesh), "", ""}).id;
  ASSERT_TRUE(eventually([&] { return engine.metrics().iterations > 0; }));
  engine.stop(0ms);
}

TEST(EngineRecovery, FailsTheJobOfAMeshThatIsGone) {
  Backend backend;
  const std::string mesh = ready_mesh(backend);
  std::string id;
  ASSERT_NO_FATAL_FAILURE(submit_and_stop(backend, mesh, id));
  backend.catalogue.erase(mesh);
  JobEngine engine(unlimited(one_thread()), *backend.store, backend.catalogue);
  const JobRecord record = ended(engine, id);
  EXPECT_EQ(record.state, JobState::failed);
  ASSERT_TRUE(record.error);
  EXPECT_EQ(record.error->reason(), Reason::not_found);
  EXPECT_EQ(record.error->fields().at(0).field, "mesh");
}

/// Leaves a job that runs, as a crash would if `crash`, else as a stop.
void run_and_leave(Backend& backend, const std::string& id, bool crash) {
  {
    JobEngine engine(unlimited(one_thread()), *backend.store, backend.catalogue);
    ASSERT_TRUE(eventually([&] { return engine.metrics().iterations > 0; }));
    EXPECT_EQ(engine.get(id).state, JobState::running);
  }
  if (crash) backend.store->set_running(true);  // as a server that died has left it
}

TEST(EngineRecovery, EndsAJobThatTheServerDoesNotSurvive) {
  Backend backend;
  const std::string mesh = ready_mesh(backend);
  JobRecord created;
  created.id = "job";
  created.spec = endless_job(mesh);
  created.cases.resize(1);
  created.created = records::Clock::now();
  backend.store->create(created, "print");
  for (const bool crash : {true, false, true, false, true}) {
    run_and_leave(backend, "job", crash);
  }
  JobEngine engine(unlimited(one_thread()), *backend.store, backend.catalogue);
  const JobRecord record = ended(engine, "job");
  EXPECT_EQ(record.state, JobState::failed);
  ASSERT_TRUE(record.error);
  EXPECT_THAT(record.error->what(), ::testing::HasSubstr("crashed 3 times"));
  EXPECT_EQ(record.attempt, 6);
}

TEST(EngineRecovery, WritesNoJobBeforeItStarts) {
  Backend backend;
  const std::string mesh = ready_mesh(backend);
  std::string id;
  ASSERT_NO_FATAL_FAILURE(submit_and_stop(backend, mesh, id));
  anticrack::testing::FailingStore& store = *backend.store;
  store.put_fails = true;
  JobEngine engine(unlimited(one_thread()), store, backend.catalogue);
  EXPECT_EQ(engine.get(id).attempt, 2);
  EXPECT_TRUE(eventually([&] { return store.failures > 1; }));  // set_running, then its start
  EXPECT_EQ(backend.store->job(id)->attempt, 1);
  engine.cancel(id);
  EXPECT_EQ(ended(engine, id).state, JobState::cancelled);
}

TEST(EngineRecovery, AMeshIsKeptWhileAJobNeedsIt) {
  Engine test(one_thread());
  const std::string mesh = test.ready_mesh();
  const std::string id = test.submit(endless_job(mesh));
  ASSERT_TRUE(test.iterating(id));
  EXPECT_TRUE(throws([&] { test.backend.catalogue.erase(mesh); }, Reason::in_use));
  test.engine.cancel(id);
  test.ended(id);
  EXPECT_NO_THROW(test.backend.catalogue.erase(mesh));
}

}  // namespace
}  // namespace anticrack::jobs
