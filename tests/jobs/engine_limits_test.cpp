// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is bounded, and that nobody starves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "jobs/engine_support.hpp"
#include "records/case_record.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::BackendOptions;
using anticrack::testing::error_of;
using anticrack::testing::eventually;
using anticrack::testing::throws;
using errors::Reason;
using records::JobState;

TEST(EngineLimits, TheQueueIsBoundedButKnowsItsRequests) {
  EngineOptions options = one_thread();
  options.max_queued_jobs = 3;
  Engine test(options);
  const std::string mesh = test.ready_mesh();
  const std::string running = test.submit(endless_job(mesh));
  ASSERT_TRUE(test.iterating(running));
  test.submit(short_job(mesh));
  const std::string last = test.submit(short_job(mesh), "request");
  const auto error = error_of([&] { test.submit(short_job(mesh)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::busy);
  EXPECT_GT(error->retry_delay().count(), 0);
  EXPECT_EQ(test.submit(short_job(mesh), "request"), last);
  EXPECT_TRUE(throws([&] { test.submit(short_job(mesh), "other request"); }, Reason::busy));
  EXPECT_EQ(test.list().size(), 3U);
  test.engine.cancel(running);
  test.ended(last);
  EXPECT_EQ(test.ended(test.submit(short_job(mesh), "other request")).state, JobState::succeeded);
}

TEST(EngineLimits, TheArraysOfAResultAreBoundedWhenAJobIsCreated) {
  EngineOptions options;
  Engine counted;
  const records::JobSpec one = short_job(counted.ready_mesh());
  const std::string id = counted.submit(one);
  counted.ended(id);
  options.max_result_arrays = counted.engine.result(id)->arrays().size();
  Engine test(options);
  records::JobSpec spec = one;
  spec.mesh = test.ready_mesh();
  EXPECT_EQ(test.ended(test.submit(spec)).state, JobState::succeeded);
  spec.fields = true;
  EXPECT_TRUE(throws([&] { test.submit(spec); }, Reason::limit_exceeded));
  spec.fields = false;
  spec.loads.push_back({"second", 1.0, ""});
  const auto error = error_of([&] { test.submit(spec); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::limit_exceeded);
  ASSERT_EQ(error->fields().size(), 1U);
  EXPECT_EQ(error->fields()[0].field, "load_cases");
  EXPECT_THAT(error->what(), ::testing::HasSubstr("split the job"));
  // Before its mesh is meshed nobody knows.
  spec.mesh = test.backend.create(0.07);
  try {
    const records::JobRecord failed = test.ended(test.submit(spec));
    EXPECT_EQ(failed.state, JobState::failed);
    ASSERT_TRUE(failed.error);
    EXPECT_EQ(failed.error->reason(), Reason::limit_exceeded);
  } catch (const errors::Error& early) {
    EXPECT_EQ(early.reason(), Reason::limit_exceeded);
  }
}

TEST(EngineLimits, TheOldestEndedJobsGo) {
  EngineOptions options;
  options.max_kept_jobs = 2;
  Engine test(options);
  const std::string mesh = test.ready_mesh();
  std::vector<std::string> ids;
  for (int i = 0; i < 4; ++i) {
    ids.push_back(test.submit(short_job(mesh), "request " + std::to_string(i)));
    test.ended(ids.back());
  }
  EXPECT_TRUE(
      eventually([&] { return throws([&] { test.engine.get(ids[1]); }, Reason::not_found); }));
  EXPECT_TRUE(throws([&] { test.engine.get(ids[0]); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { test.engine.events(ids[0]); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { test.engine.result(ids[1]); }, Reason::not_found));
  EXPECT_NE(test.engine.result(ids[2]), nullptr);
  EXPECT_EQ(test.list().size(), 2U);
  // "A client that later gets NOT_FOUND for its job may submit again with the same request id."
  EXPECT_NE(test.submit(short_job(mesh), "request 0"), ids[0]);
}

TEST(EngineLimits, TheOldestResultsExpireOverTheirBudget) {
  EngineOptions options;
  options.result_budget = 1;
  Engine test(options);
  const std::string mesh = test.ready_mesh();
  const std::string first = test.submit(short_job(mesh), "first");
  test.ended(first);
  EXPECT_NE(test.engine.result(first), nullptr);  // the newest stays
  const std::string second = test.submit(short_job(mesh));
  test.ended(second);
  ASSERT_TRUE(eventually([&] { return test.engine.get(first).expired.has_value(); }));
  EXPECT_EQ(test.state(first), JobState::succeeded);
  EXPECT_TRUE(throws([&] { test.engine.result(first); }, Reason::result_expired));
  EXPECT_NE(test.engine.result(second), nullptr);
  EXPECT_TRUE(eventually([&] { return test.engine.metrics().results_expired == 1; }));
  EXPECT_EQ(test.engine.get(first).cases.at(0).status, contact::Status::converged);
  EXPECT_EQ(test.submit(short_job(mesh), "first"), first);
}

TEST(EngineLimits, ResultsExpireByTheirAge) {
  EngineOptions options;
  options.result_ttl = std::chrono::milliseconds(1);
  Engine test(options);
  const std::string mesh = test.ready_mesh();
  const std::string first = test.submit(short_job(mesh));
  test.ended(first);
  test.ended(test.submit(short_job(mesh)));  // or a minute later
  EXPECT_TRUE(eventually([&] { return test.engine.get(first).expired.has_value(); }));
}

TEST(EngineLimits, LogsOfEndedJobsAreBoundedInBytes) {
  EngineOptions options;
  options.max_job_memory = 300'000;  // half of it for logs: not for two of these
  Engine test(options);
  records::JobSpec spec = short_job(test.ready_mesh());
  for (int i = 0; i < 8; ++i) {
    const std::string text = "1" + std::string(4'000, ' ');
    spec.loads.push_back({"l" + std::to_string(i), fem::Expression{text}, ""});
  }
  const std::string first = test.submit(spec);
  test.ended(first);
  EXPECT_GT(test.events(first).size(), 3U);
  test.ended(test.submit(spec));
  const auto log = test.engine.events(first);
  EXPECT_EQ(log->earliest(), log->latest());
  EXPECT_EQ(log->earliest(), (std::uint64_t{1} << 40U) + 1);
  const auto last = log->read(log->earliest() - 1, 10);
  ASSERT_EQ(last.size(), 1U);
  EXPECT_EQ(std::get<EndEvent>(last[0].event).job->id, first);
}

TEST(EngineLimits, CasesOfTheQueueAreBounded) {
  EngineOptions options = one_thread();
  options.max_queued_cases = 3;
  Engine test(options);
  const std::string mesh = test.ready_mesh();
  const std::string other = test.ready_mesh(0.25);
  records::JobSpec spec = endless_job(mesh);
  spec.loads.push_back({"second", 1.0, ""});
  const std::string first = test.submit(spec);
  EXPECT_TRUE(throws([&] { test.submit(spec); }, Reason::busy));
  const std::string second = test.submit(endless_job(other));
  records::JobSpec possible_never = short_job(other);
  possible_never.loads.resize(4, possible_never.loads[0]);
  for (std::size_t i = 0; i < 4; ++i) {
    possible_never.loads[i].name = std::to_string(i);
  }
  EXPECT_TRUE(throws([&] { test.submit(possible_never); }, Reason::limit_exceeded, "load_cases"));
  EXPECT_GT(test.engine.metrics().queued_bytes, 0U);
  test.engine.cancel(first);
  test.engine.cancel(second);
  test.ended(first);
  test.ended(second);
  EXPECT_EQ(test.engine.metrics().queued_bytes, 0U);
  EXPECT_EQ(test.ended(test.submit(short_job(mesh))).state, JobState::succeeded);
}

TEST(EngineLimits, OneBudgetBoundsTheMemoryOfJobs) {
  EngineOptions options = one_thread();
  options.max_job_memory = 300'000;
  Engine test(options);
  const std::string mesh = test.ready_mesh();
  const std::string first = test.submit(endless_job(mesh));
  const auto used = [&] { return test.engine.metrics().job_memory; };
  ASSERT_TRUE(test.reaches(first, JobState::running));
  // Its log alone may have more than the budget, and keeps less when that is reached.
  ASSERT_TRUE(eventually([&] { return test.engine.events(first)->earliest() > 1; }));
  records::JobSpec large = short_job(mesh);
  for (int i = 0; i < 70; ++i) {
    const std::string text = "1" + std::string(3'900, ' ');
    large.loads.push_back({"l" + std::to_string(i), fem::Expression{text}, ""});
  }
  EXPECT_TRUE(throws([&] { test.submit(large); }, Reason::busy));
  EXPECT_LT(used(), 2 * options.max_job_memory);
  test.engine.cancel(first);
  test.ended(first);
  // The log of the ended job leaves its room.
  EXPECT_EQ(test.ended(test.submit(large)).state, JobState::succeeded);
}

TEST(EngineLimits, LoadCasesPastTheBytesOfAResultFail) {
  EngineOptions options = one_thread();
  options.max_result_bytes = 1;
  Engine test(options);
  records::JobSpec spec = short_job(test.ready_mesh());
  spec.loads.push_back({"second", 1.0, ""});
  const std::string id = test.submit(spec);
  const auto record = test.ended(id);
  EXPECT_EQ(record.state, JobState::not_converged);
  EXPECT_EQ(record.cases[0].status, contact::Status::converged);
  EXPECT_EQ(record.cases[1].status, contact::Status::failed);
  ASSERT_TRUE(record.error);
  EXPECT_EQ(record.error->reason(), Reason::limit_exceeded);
  EXPECT_EQ(record.error->fields().at(0).field, "load_cases[1]");
  EXPECT_TRUE(array<double>(*test.engine.result(id), "loads/0/traces/0/jump"));
}

TEST(EngineLimits, TheEventLogIsTrimmedAndTheResultIsNot) {
  EngineOptions options = one_thread();
  options.event_log_bytes = 4000;
  Engine test(options);
  records::JobSpec spec = short_job(test.ready_mesh());
  uzawa_of(spec).epsilon = 1e-300;
  uzawa_of(spec).max_iterations = 200;
  const std::string id = test.submit(spec);
  const auto record = test.ended(id);
  const auto log = test.engine.events(id);
  ASSERT_GT(record.cases[0].answer.iterations, 40);
  EXPECT_GT(log->earliest(), 1U);
  EXPECT_LE(log->bytes(), options.event_log_bytes);
  const auto error = error_of([&] { log->read(0, 10); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::sequence_trimmed);
  EXPECT_EQ(error->metadata().at("earliest_sequence"), std::to_string(log->earliest()));
  EXPECT_EQ(array<std::int32_t>(*test.engine.result(id), "loads/0/history/iteration")->size(),
            static_cast<std::size_t>(record.cases[0].answer.iterations));
}

TEST(EngineErase, TakesEndedJobsOnly) {
  Engine test(one_thread());
  const std::string id = test.submit(endless_job(test.ready_mesh()));
  EXPECT_TRUE(throws([&] { test.engine.erase(id); }, Reason::in_use));
  EXPECT_TRUE(throws([&] { test.engine.result(id); }, Reason::not_ready));
  test.engine.cancel(id);
  test.ended(id);
  const auto log = test.engine.events(id);
  test.engine.erase(id);
  EXPECT_TRUE(throws([&] { test.engine.get(id); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { test.engine.erase(id); }, Reason::not_found));
  EXPECT_TRUE(test.list().empty());
  EXPECT_GT(log->latest(), 0U);  // whoever watches it may finish
}

TEST(EngineSchedule, AJobOnAReadyMeshPassesThoseThatWait) {
  Engine test(one_thread());
  const std::string ready = test.ready_mesh(0.25);
  test.backend.door.shut();
  // Two of a size are prepared at a time, and the third waits behind them.
  std::vector<std::string> waiting;
  for (const double size : {0.2, 0.3, 0.4}) {
    waiting.push_back(test.submit(short_job(test.backend.create(size))));
  }
  ASSERT_TRUE(eventually([&] { return test.backend.door.waiting() == 2; }));
  EXPECT_EQ(test.ended(test.submit(short_job(ready))).state, JobState::succeeded);
  for (const std::string& id : waiting) {
    EXPECT_FALSE(records::ended(test.state(id)));
  }
  test.backend.door.open();
  for (const std::string& id : waiting) {
    EXPECT_EQ(test.ended(id).state, JobState::succeeded);
  }
}

TEST(EngineSchedule, AJobOnASmallMeshEndsWhileLargeMeshesAreFactorised) {
  Engine test;
  test.backend.kept_out = 5000;
  test.backend.door.shut();
  std::vector<std::string> waiting;  // more than are prepared ahead
  for (const double size : {0.032, 0.0325, 0.033, 0.0335, 0.034}) {
    waiting.push_back(test.submit(short_job(test.backend.create(size))));
  }
  ASSERT_TRUE(eventually([&] { return test.backend.door.waiting() == 2; }));
  EXPECT_EQ(test.ended(test.submit(short_job(test.backend.create(0.2)))).state,
            JobState::succeeded);
  EXPECT_EQ(test.backend.door.waiting(), 2);
  for (const std::string& id : waiting) {
    EXPECT_FALSE(records::ended(test.state(id)));
    test.engine.cancel(id);
  }
  test.backend.door.open();
}

TEST(EngineSchedule, JobsOnOneMeshShareOneFactorisation) {
  Engine test;
  test.backend.door.shut();
  const std::string mesh = test.backend.create();
  std::vector<std::string> ids;
  for (int i = 0; i < 6; ++i) {
    ids.push_back(test.submit(short_job(mesh)));
  }
  ASSERT_TRUE(eventually([&] { return test.told(ids[0], "factorising"); }));
  test.backend.door.open();
  for (const std::string& id : ids) {
    EXPECT_EQ(test.ended(id).state, JobState::succeeded);
  }
  EXPECT_EQ(test.backend.cache.metrics().factorizations, 1U);
  EXPECT_EQ(test.backend.catalogue.meshings(), 1U);
}

TEST(EngineSchedule, AJobWaitsForMemoryThatAnotherHolds) {
  std::uint64_t larger = 0;
  {
    Engine measure;
    const std::string mesh = measure.ready_mesh(0.2);
    larger = operators::estimate_bytes(
        *measure.backend.store->triangulation(measure.backend.catalogue.get(mesh).sha256));
  }
  BackendOptions tight;
  tight.memory_budget = larger;
  Engine test({}, tight);
  const std::string holds = test.submit(endless_job(test.ready_mesh(0.25)));
  ASSERT_TRUE(test.iterating(holds));
  const std::string waits = test.submit(short_job(test.backend.create(0.2)));
  ASSERT_TRUE(eventually([&] { return test.told(waits, "waiting for memory to factorise"); }));
  EXPECT_EQ(test.state(waits), JobState::waiting_for_mesh);
  const std::string impatient = test.submit(short_job(test.backend.create(0.2)));
  test.engine.cancel(impatient);
  EXPECT_EQ(test.ended(impatient).state, JobState::cancelled);
  test.engine.cancel(holds);
  EXPECT_EQ(test.ended(waits).state, JobState::succeeded);
}

}  // namespace
}  // namespace anticrack::jobs
