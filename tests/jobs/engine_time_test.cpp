// SPDX-License-Identifier: GPL-3.0-or-later
//
// Time limits at every stage of a job's life.
#include <gtest/gtest.h>

#include "jobs/engine_support.hpp"
#include "records/case_record.hpp"

namespace anticrack::jobs {
namespace {

using contact::Status;
using errors::Reason;
using records::JobRecord;
using records::JobState;
using namespace std::chrono_literals;

void expect_timed_out(const JobRecord& record, const std::string& field) {
  EXPECT_EQ(record.state, JobState::failed);
  ASSERT_TRUE(record.error);
  EXPECT_EQ(record.error->reason(), Reason::timed_out);
  EXPECT_EQ(record.error->fields().at(0).field, field);
  for (const records::CaseRecord& ended : record.cases) {
    EXPECT_EQ(ended.status, Status::failed);
    ASSERT_TRUE(ended.error);
    EXPECT_EQ(ended.error->reason(), Reason::timed_out);
  }
}

records::JobSpec waits_briefly(records::JobSpec spec) {
  spec.queue_time_limit = 20ms;
  return spec;
}

records::JobSpec runs_briefly(records::JobSpec spec) {
  spec.run_time_limit = 200ms;
  return spec;
}

TEST(EngineTime, EndsWhileAJobIsQueued) {
  Engine test(one_thread());
  const std::string mesh = test.ready_mesh();
  const std::string running = test.submit(endless_job(mesh));
  ASSERT_TRUE(test.iterating(running));
  const JobRecord record = test.ended(test.submit(waits_briefly(short_job(mesh))));
  expect_timed_out(record, "queue_timeout");
  EXPECT_FALSE(record.started);
  EXPECT_EQ(test.state(running), JobState::running);
}

TEST(EngineTime, EndsWhileFactorising) {
  Engine test;
  test.backend.door.shut();
  expect_timed_out(test.ended(test.submit(waits_briefly(short_job(test.backend.create())))),
                   "queue_timeout");
  test.backend.door.open();
}

TEST(EngineTime, EndsWhileIterating) {
  Engine test(one_thread());
  const JobRecord record = test.ended(test.submit(runs_briefly(endless_job(test.ready_mesh()))));
  expect_timed_out(record, "run_timeout");
  EXPECT_TRUE(record.started);
}

TEST(EngineTime, LeavesTheLoadCasesThatEnded) {
  EngineOptions options = one_thread();
  options.columns = 2;
  Engine test(options);
  records::JobSpec spec = endless_job(test.ready_mesh());
  spec.run_time_limit = 250ms;
  spec.loads.insert(spec.loads.begin(), {"at rest", 0.0, ""});  // ends in its first iterations
  std::string id = test.submit(spec);
  JobRecord record = test.ended(id);
  while (record.cases[0].status != Status::converged && spec.run_time_limit < 1h) {
    spec.run_time_limit *= 2;  // the machine is slow
    id = test.submit(spec);
    record = test.ended(id);
  }
  EXPECT_EQ(record.state, JobState::failed);
  EXPECT_EQ(record.error->reason(), Reason::timed_out);
  EXPECT_EQ(record.cases[0].status, Status::converged);
  EXPECT_EQ(record.cases[1].status, Status::failed);
  EXPECT_TRUE(array<double>(*test.engine.result(id), "loads/0/traces/0/jump"));
}

TEST(EngineTime, IsTheServersWhereTheJobNamesNone) {
  EngineOptions options = one_thread();
  options.run_time = 200ms;
  Engine test(options);
  expect_timed_out(test.ended(test.submit(endless_job(test.ready_mesh()))), "run_timeout");
}

}  // namespace
}  // namespace anticrack::jobs
