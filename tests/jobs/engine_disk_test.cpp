// SPDX-License-Identifier: GPL-3.0-or-later
//
// A disk that is full when a job starts or ends.
#include <gtest/gtest.h>

#include "jobs/engine_support.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::Backend;
using anticrack::testing::eventually;
using anticrack::testing::FailingStore;
using anticrack::testing::throws;
using errors::Reason;
using records::JobRecord;
using records::JobState;
using namespace std::chrono_literals;

class EngineDisk : public ::testing::Test {
 protected:
  std::string submit(JobEngine& engine) { return engine.submit({short_job(mesh), "", ""}).id; }
  /// A job whose result the disk has refused at least once.
  std::string refused_job(JobEngine& engine) {
    store.finish_fails = true;
    const std::string id = submit(engine);
    EXPECT_TRUE(eventually([&] { return store.failures > 0; }));
    return id;
  }

  Backend backend;
  FailingStore& store = *backend.store;
  const std::string mesh = ready_mesh(backend);
};

TEST_F(EngineDisk, FullAtTheEndIsTriedAgainUntilThereIsSpace) {
  JobEngine engine(one_thread(), store, backend.catalogue);
  const std::string id = refused_job(engine);
  EXPECT_EQ(engine.get(id).state, JobState::running);
  EXPECT_EQ(engine.get(id).timeline.back().detail, "writing the result");
  EXPECT_FALSE(engine.idle());
  EXPECT_TRUE(throws([&] { engine.result(id); }, Reason::not_ready));
  // The solver thread is free: this one gets as far.
  const std::string second = submit(engine);
  EXPECT_TRUE(eventually([&] { return engine.metrics().load_cases_ended == 2; }));
  store.finish_fails = false;
  for (const std::string& job : {id, second}) {
    const JobRecord record = ended(engine, job);
    EXPECT_EQ(record.state, JobState::succeeded);
    EXPECT_GT(record.result_bytes, 0U);
    EXPECT_TRUE(array<double>(*engine.result(job), "loads/0/traces/0/jump"));
  }
  EXPECT_TRUE(eventually([&] { return engine.idle(); }));
}

TEST_F(EngineDisk, FullAtTheEndMayBeCancelled) {
  JobEngine engine(one_thread(), store, backend.catalogue);
  const std::string id = refused_job(engine);
  ASSERT_TRUE(eventually([&] {  // the job knows that it was refused
    const auto log = engine.events(id);
    const auto last = log->read(log->latest() - 1, 1);
    const auto* phase = std::get_if<PhaseEvent>(&last.at(0).event);
    return phase != nullptr && phase->detail == "writing the result";
  }));
  engine.cancel(id);
  store.finish_fails = false;
  const JobRecord record = ended(engine, id);
  EXPECT_EQ(record.state, JobState::cancelled);
  EXPECT_EQ(record.result_bytes, 0U);
  EXPECT_TRUE(throws([&] { engine.result(id); }, Reason::not_ready));
}

TEST_F(EngineDisk, FullAtTheEndLeavesTheJobToTheNextStart) {
  std::string id;
  {
    JobEngine engine(one_thread(), store, backend.catalogue);
    id = refused_job(engine);
    engine.stop(0ms);
    EXPECT_TRUE(engine.idle());
    EXPECT_FALSE(records::ended(store.job(id)->state));
  }
  store.finish_fails = false;
  JobEngine engine(one_thread(), store, backend.catalogue);
  const JobRecord record = ended(engine, id);
  EXPECT_EQ(record.state, JobState::succeeded);
  EXPECT_EQ(record.attempt, 2);
}

TEST_F(EngineDisk, FullAtTheStartKeepsTheJobQueued) {
  JobEngine engine(one_thread(), store, backend.catalogue);
  store.put_fails = true;
  const std::string id = submit(engine);
  EXPECT_TRUE(eventually([&] { return store.failures > 0; }));
  EXPECT_NE(engine.get(id).state, JobState::running);
  EXPECT_EQ(engine.metrics().jobs_queued, 1);
  store.put_fails = false;
  EXPECT_EQ(ended(engine, id).state, JobState::succeeded);
}

TEST_F(EngineDisk, FullAtTheStartMayBeCancelled) {
  JobEngine engine(one_thread(), store, backend.catalogue);
  store.put_fails = true;
  const std::string id = submit(engine);
  EXPECT_TRUE(eventually([&] { return store.failures > 0; }));
  engine.cancel(id);
  EXPECT_EQ(ended(engine, id).state, JobState::cancelled);
}

}  // namespace
}  // namespace anticrack::jobs
