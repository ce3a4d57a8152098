// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cancel at every stage of a job's life, and the end of the engine.
#include <gtest/gtest.h>

#include <future>
#include <thread>
#include <utility>
#include <vector>

#include "jobs/engine_support.hpp"
#include "records/case_record.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::eventually;
using anticrack::testing::throws;
using contact::Status;
using errors::Reason;
using records::JobRecord;
using records::JobState;
using namespace std::chrono_literals;

void expect_cancelled(const JobRecord& record) {
  EXPECT_EQ(record.state, JobState::cancelled);
  EXPECT_TRUE(record.ended);
  EXPECT_FALSE(record.error);
  for (const records::CaseRecord& ended : record.cases) {
    EXPECT_EQ(ended.status, Status::cancelled);
  }
}

TEST(EngineCancel, OfAQueuedJobNeedsNoSolverThread) {
  Engine test(one_thread());
  const std::string mesh = test.ready_mesh();
  const std::string running = test.submit(endless_job(mesh));
  ASSERT_TRUE(test.iterating(running));
  const std::string queued = test.submit(short_job(mesh));
  EXPECT_EQ(test.engine.metrics().jobs_queued, 1);
  test.engine.cancel(queued);
  expect_cancelled(test.ended(queued));
  EXPECT_EQ(test.engine.metrics().jobs_queued, 0);
  EXPECT_EQ(test.state(running), JobState::running);
  EXPECT_TRUE(throws([&] { test.engine.result(queued); }, Reason::not_ready));
}

TEST(EngineCancel, WhileFactorising) {
  Engine test;
  test.backend.door.shut();
  const std::string id = test.submit(short_job(test.backend.create()));
  ASSERT_TRUE(eventually([&] { return test.told(id, "factorising"); }));
  test.engine.cancel(id);
  expect_cancelled(test.ended(id));  // with the door still shut
  test.backend.door.open();
}

TEST(EngineCancel, AsTheJobStarts) {
  Engine test(one_thread());
  const std::string mesh = test.ready_mesh();
  const std::string blocker = test.submit(endless_job(mesh));
  ASSERT_TRUE(test.iterating(blocker));
  const std::string id = test.submit(short_job(mesh));
  const auto listener = test.engine.events(id)->listen([&] {
    if (!records::ended(test.state(id))) {
      test.engine.cancel(id);  // its first event: that it runs
    }
  });
  test.engine.cancel(blocker);
  expect_cancelled(test.ended(id));
  EXPECT_EQ(test.ended(test.submit(short_job(mesh))).state, JobState::succeeded);
}

TEST(EngineCancel, WhileIteratingIsEffectiveWithinOneIteration) {
  Engine test(one_thread());
  const std::string id = test.submit(endless_job(test.ready_mesh()));
  ASSERT_TRUE(test.iterating(id));
  const auto log = test.engine.events(id);
  test.engine.cancel(id);
  const std::uint64_t latest = log->latest();
  expect_cancelled(test.ended(id));
  EXPECT_LE(log->latest(), latest + 3);  // one more sample, the case, the end
}

TEST(EngineCancel, OfAnEndedJobChangesNothing) {
  Engine test;
  const std::string id = test.submit(short_job(test.ready_mesh()));
  test.ended(id);
  const std::uint64_t latest = test.engine.events(id)->latest();
  EXPECT_EQ(test.engine.cancel(id).state, JobState::succeeded);
  EXPECT_EQ(test.engine.events(id)->latest(), latest);
  EXPECT_NE(test.engine.result(id), nullptr);
}

TEST(EngineCancel, KeepsTheLoadCasesThatWereFinished) {
  Engine test(one_thread());
  const std::string mesh = test.ready_mesh();
  // The only solver thread is kept busy until the listener is in place.
  const std::string blocker = test.submit(endless_job(mesh));
  ASSERT_TRUE(test.iterating(blocker));
  records::JobSpec spec = short_job(mesh);
  spec.loads.push_back({"second", 1.0, ""});
  spec.loads.push_back({"third", 2.0, ""});
  const std::string id = test.submit(spec);
  const auto log = test.engine.events(id);
  const auto listener = log->listen([&] {
    const auto last = log->read(log->latest() - 1, 1);
    if (std::holds_alternative<CaseEvent>(last.at(0).event)) {
      test.engine.cancel(id);
    }
  });
  test.engine.cancel(blocker);
  const JobRecord record = test.ended(id);
  EXPECT_EQ(record.state, JobState::cancelled);
  EXPECT_EQ(record.cases[0].status, Status::converged);
  EXPECT_EQ(record.cases[1].status, Status::cancelled);
  EXPECT_EQ(record.cases[2].status, Status::cancelled);
  const auto block = test.engine.result(id);
  EXPECT_TRUE(array<double>(*block, "loads/0/traces/0/jump"));
  EXPECT_FALSE(array<double>(*block, "loads/1/traces/0/jump"));
}

TEST(EngineCancel, MayComeFromManyAtOnce) {
  Engine test;
  const std::string id = test.submit(endless_job(test.ready_mesh()));
  ASSERT_TRUE(test.iterating(id));
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] { test.engine.cancel(id); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  expect_cancelled(test.ended(id));
  EXPECT_EQ(test.engine.metrics().jobs_ended, 1U);
}

bool has_ended(const EventLog& log) {
  const std::uint64_t latest = log.latest();
  return latest >= log.earliest() &&
         std::holds_alternative<EndEvent>(log.read(latest - 1, 1).at(0).event);
}

TEST(EngineStop, LeavesWhatHasNotEndedToTheNextStart) {
  Engine test(one_thread());
  const std::string mesh = test.ready_mesh();
  test.backend.door.shut();
  const std::string running = test.submit(endless_job(mesh));
  ASSERT_TRUE(test.iterating(running));
  const std::string queued = test.submit(short_job(mesh));
  const std::string factorising = test.submit(short_job(test.backend.create(0.3)));
  ASSERT_TRUE(eventually([&] { return test.told(factorising, "factorising"); }));
  EXPECT_FALSE(test.engine.idle());
  test.engine.stop(0ms);
  EXPECT_TRUE(test.engine.idle());
  for (const std::string& id : {running, queued, factorising}) {
    EXPECT_EQ(test.state(id), JobState::queued);
    EXPECT_FALSE(has_ended(*test.engine.events(id)));
    EXPECT_FALSE(records::ended(test.backend.store->job(id)->state));
  }
  EXPECT_EQ(test.backend.store->unfinished().size(), 3U);
  EXPECT_TRUE(throws([&] { test.submit(short_job(mesh)); }, Reason::draining));
  EXPECT_EQ(test.list().size(), 3U);
  test.engine.stop(0ms);
  EXPECT_EQ(test.engine.metrics().jobs_ended, 0U);
  EXPECT_EQ(test.engine.metrics().jobs_queued, 0);
  EXPECT_EQ(test.engine.metrics().jobs_running, 0);
}

TEST(EngineStop, LetsRunningJobsFinishInTheGraceTheyHave) {
  Engine test(one_thread());
  const std::string mesh = test.ready_mesh();
  const std::string blocker = test.submit(endless_job(mesh));
  ASSERT_TRUE(test.iterating(blocker));
  records::JobSpec spec = short_job(mesh);
  spec.loads.push_back({"second", 1.0, ""});
  const std::string running = test.submit(spec, "request");
  // Its first event does not return before the engine is stopping.
  std::promise<void> started;
  std::promise<void> stopping;
  bool first = true;
  const auto listener = test.engine.events(running)->listen([&] {
    if (std::exchange(first, false)) {
      started.set_value();
      stopping.get_future().wait();
    }
  });
  test.engine.cancel(blocker);
  started.get_future().wait();
  const std::string queued = test.submit(short_job(mesh));
  std::thread stopper([&] { test.engine.stop(10min); });
  // Once it refuses jobs it is stopping.
  EXPECT_TRUE(eventually([&] {
    return throws([&] { test.engine.cancel(test.submit(short_job(mesh))); }, Reason::draining);
  }));
  stopping.set_value();
  stopper.join();
  EXPECT_EQ(test.state(queued), JobState::queued);
  EXPECT_EQ(test.state(running), JobState::succeeded);
  // The same request is answered by a stopped engine, too.
  EXPECT_EQ(test.submit(spec, "request"), running);
}

}  // namespace
}  // namespace anticrack::jobs
