// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "rpc/details.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"
#include "rpc/watch_feed.hpp"
#include "support/eventually.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::Context;
using anticrack::testing::Details;
using anticrack::testing::details_of;
using anticrack::testing::endless_job;
using anticrack::testing::eventually;
using anticrack::testing::expect_error;
using anticrack::testing::named;
using anticrack::testing::opening_job;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;
using anticrack::testing::sweep_job;
using Events = std::vector<v1::WatchJobResponse>;

v1::WatchJobRequest watch_request(const std::string& job, std::uint64_t after = 0) {
  auto request = named<v1::WatchJobRequest>(job);
  request.set_after_sequence(after);
  return request;
}

/// Every iteration in the events, in order.
std::vector<int> iterations(const Events& events) {
  std::vector<int> result;
  for (const auto& event : events) {
    const auto& samples = event.samples();
    EXPECT_EQ(samples.criterion_size(), samples.iteration_size());
    EXPECT_EQ(samples.load_case_size(), samples.iteration_size());
    EXPECT_EQ(samples.kkt_equilibrium_size(), samples.iteration_size());
    EXPECT_LE(samples.iteration_size(), static_cast<int>(WatchFeed::max_batch));
    result.insert(result.end(), samples.iteration().begin(), samples.iteration().end());
  }
  return result;
}

TEST(Watch, GoesFromASnapshotOverEveryEventToTheEnd) {
  RunningServer server;
  const std::string job = server.create(opening_job(server.create(paper_mesh()).name())).name();
  Events events;
  ASSERT_TRUE(server.watch(job, 0, events).ok());
  ASSERT_GE(events.size(), 4u);
  ASSERT_TRUE(events.front().has_snapshot());
  EXPECT_EQ(events.front().snapshot().job().name(), job);
  ASSERT_TRUE(events.back().has_ended());
  EXPECT_EQ(events.back().ended().status().state(), v1::JobStatus::STATE_SUCCEEDED);
  for (std::size_t i = 1; i < events.size(); ++i) {
    EXPECT_GT(events[i].sequence(), events[i - 1].sequence());
    EXPECT_FALSE(events[i].has_snapshot());
  }
  const std::vector<int> seen = iterations(events);
  ASSERT_EQ(static_cast<int>(seen.size()), events.back().ended().status().answers(0).iterations());
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], static_cast<int>(i) + 1);
  const auto& case_ended = events[events.size() - 2];
  ASSERT_EQ(case_ended.load_cases_ended_size(), 1);
  EXPECT_EQ(case_ended.load_cases_ended(0).answer().name(), "opening");
}

TEST(Watch, ResumesExactlyWhereItIsTold) {
  RunningServer server;
  const std::string job = server.create(opening_job(server.create(paper_mesh()).name())).name();
  Events all;
  ASSERT_TRUE(server.watch(job, 0, all).ok());
  const std::vector<int> every = iterations(all);
  for (std::size_t i = 1; i < all.size(); ++i) {
    Events rest;
    ASSERT_TRUE(server.watch(job, all[i].sequence(), rest).ok());
    ASSERT_TRUE(rest.front().has_snapshot());
    EXPECT_EQ(rest.front().sequence(), all[i].sequence());
    const std::vector<int> tail = iterations(rest);
    const std::vector<int> before =
        iterations({all.begin(), all.begin() + static_cast<long>(i) + 1});
    EXPECT_EQ(before.size() + tail.size(), every.size());
    EXPECT_EQ(tail, std::vector<int>(every.end() - static_cast<long>(tail.size()), every.end()));
  }
}

/// Every row of a sweep in the events, in the order told.
std::vector<std::uint64_t> row_numbers(const Events& events) {
  std::vector<std::uint64_t> result;
  for (const auto& event : events) {
    const v1::SweepRows& some = event.sweep_rows();
    EXPECT_EQ(some.energy_size(), some.status_size());
    EXPECT_EQ(some.displacement_size(), some.status_size());
    for (int i = 0; i < some.status_size(); ++i) {
      result.push_back(some.first_row() + static_cast<std::uint64_t>(i));
    }
  }
  return result;
}

TEST(Watch, ResumesBetweenTheRowsOfASweep) {
  constexpr std::size_t count = 600;
  std::vector<double> coefficients;
  for (std::size_t row = 0; row < count; ++row) {
    coefficients.insert(coefficients.end(), {1.0, 0.01 * static_cast<double>(row), 0.5});
  }
  RunningServer server;
  const std::string job =
      server.create(sweep_job(server.create(paper_mesh()).name(), coefficients)).name();
  Events all;
  ASSERT_TRUE(server.watch(job, 0, all).ok());
  std::vector<std::uint64_t> every = row_numbers(all);
  const auto pieces = std::count_if(all.begin(), all.end(),
                                    [](const auto& event) { return event.has_sweep_rows(); });
  EXPECT_GT(pieces, 1);
  for (std::size_t i = 1; i < all.size(); ++i) {
    Events rest;
    ASSERT_TRUE(server.watch(job, all[i].sequence(), rest).ok());
    std::vector<std::uint64_t> told =
        row_numbers({all.begin(), all.begin() + static_cast<long>(i) + 1});
    for (const std::uint64_t row : row_numbers(rest)) told.push_back(row);
    EXPECT_EQ(told, every);
  }
  std::sort(every.begin(), every.end());
  ASSERT_EQ(every.size(), count);
  for (std::size_t row = 0; row < count; ++row) EXPECT_EQ(every[row], row);
}

TEST(Watch, TakesUpAgainInMidIteration) {
  RunningServer server;
  const std::string job = server.create(endless_job(server.create(paper_mesh()).name())).name();
  std::uint64_t sequence = 0;
  int last = 0;
  {
    Context context;
    const auto reader = server.jobs->WatchJob(&context, watch_request(job));
    v1::WatchJobResponse event;
    while (last == 0 && reader->Read(&event)) {
      if (!event.has_samples()) continue;
      last = *event.samples().iteration().rbegin();
      sequence = event.sequence();
    }
    context.TryCancel();
    EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
  }
  Context context;
  const auto reader = server.jobs->WatchJob(&context, watch_request(job, sequence));
  v1::WatchJobResponse event;
  ASSERT_TRUE(reader->Read(&event));
  ASSERT_TRUE(event.has_snapshot());
  EXPECT_EQ(event.snapshot().job().status().state(),
            v1::JobStatus::STATE_RUNNING);  // a watch owns no job
  ASSERT_TRUE(reader->Read(&event));
  ASSERT_TRUE(event.has_samples());
  EXPECT_EQ(event.samples().iteration(0), last + 1);
  server.cancel(job);
  while (reader->Read(&event)) {
  }
  EXPECT_TRUE(reader->Finish().ok());
}

TEST(Watch, RefusesTheFutureAndTheUnknown) {
  RunningServer server;
  const std::string job = server.create(opening_job(server.create(paper_mesh()).name())).name();
  const v1::Job ended = server.finish(job);
  Events events;
  const grpc::Status future = server.watch(job, 1'000'000'000, events);
  expect_error(future, grpc::StatusCode::OUT_OF_RANGE, "SEQUENCE_TRIMMED", "after_sequence");
  const Details details = details_of(future);
  EXPECT_EQ(details.metadata.count("earliest_sequence"), 1u);
  EXPECT_EQ(details.metadata.count("latest_sequence"), 1u);
  expect_error(server.watch("jobs/none", 0, events), grpc::StatusCode::NOT_FOUND, "NOT_FOUND", "");
  expect_error(server.watch("none", 0, events), grpc::StatusCode::INVALID_ARGUMENT,
               "INVALID_ARGUMENT", "name");
  EXPECT_TRUE(events.empty());
}

TEST(Watch, SaysWhenItsPlaceWasTrimmed) {
  RunningServer server([](auto& settings) { settings.engine.event_log_bytes = 4'096; });
  v1::CreateJobRequest request = opening_job(server.create(paper_mesh()).name());
  v1::Uzawa& uzawa = *request.mutable_spec()->mutable_solver()->mutable_uzawa();
  uzawa.set_theta(0.01);
  uzawa.set_max_iterations(2'000);
  const std::string job = server.create(request).name();
  ASSERT_TRUE(eventually(
      [&] { return server.job(job).status().state() >= v1::JobStatus::STATE_SUCCEEDED; }));
  Events events;
  const grpc::Status status = server.watch(job, 1, events);
  expect_error(status, grpc::StatusCode::OUT_OF_RANGE, "SEQUENCE_TRIMMED", "after_sequence");
  EXPECT_GT(std::stoull(details_of(status).metadata.at("earliest_sequence")), 2u);
  EXPECT_TRUE(server.watch(job, 0, events).ok());  // from the earliest kept
  EXPECT_TRUE(events.back().has_ended());
}

TEST(Watch, ThatIsNotReadFallsBehindWithoutHoldingTheJob) {
  RunningServer server([](auto& settings) { settings.engine.event_log_bytes = 64 << 10; });
  const std::string job = server.create(endless_job(server.create(paper_mesh(0.05)).name())).name();
  Context context;
  const auto reader = server.jobs->WatchJob(&context, watch_request(job));
  ASSERT_TRUE(eventually([&] { return server.info().metrics().iterations() > 200'000; }));
  v1::WatchJobResponse event;
  while (reader->Read(&event)) {
  }
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::OUT_OF_RANGE);
  EXPECT_TRUE(server.cancel(job).ok());
}

TEST(Watch, ThatStallsIsBrokenOff) {
  RunningServer server(
      [](auto& settings) { settings.server.stall = std::chrono::milliseconds(50); });
  const std::string job = server.create(endless_job(server.create(paper_mesh(0.05)).name())).name();
  Context context;
  const auto reader = server.jobs->WatchJob(&context, watch_request(job));
  ASSERT_TRUE(eventually([&] { return server.info().metrics().iterations() > 0; }));
  EXPECT_TRUE(eventually([&] { return server.info().metrics().watchers() == 0; }));
  v1::WatchJobResponse event;
  while (reader->Read(&event)) {
  }
  EXPECT_FALSE(reader->Finish().ok());
  EXPECT_EQ(server.job(job).status().state(), v1::JobStatus::STATE_RUNNING);
  server.cancel(job);
}

TEST(Watch, BeatsWhereNothingHappens) {
  RunningServer server([](auto& settings) {
    settings.engine.threads = 1;
    settings.engine.turn = std::chrono::hours(1);  // the other mesh waits for its own
    settings.engine.long_step = std::chrono::hours(1);
    settings.server.heartbeat = std::chrono::milliseconds(20);
  });
  const std::string mesh = server.create(paper_mesh(0.5)).name();
  const std::string running = server.create(endless_job(server.create(paper_mesh()).name())).name();
  ASSERT_TRUE(eventually(
      [&] { return server.job(running).status().state() == v1::JobStatus::STATE_RUNNING; }));
  const std::string waiting = server.create(opening_job(mesh)).name();
  Context context;
  const auto reader = server.jobs->WatchJob(&context, watch_request(waiting));
  v1::WatchJobResponse event;
  std::uint64_t last = 0;
  for (int beats = 0; beats < 3;) {
    ASSERT_TRUE(reader->Read(&event));
    if (event.has_heartbeat()) {
      ++beats;
      EXPECT_EQ(event.sequence(), last);
      EXPECT_NE(event.heartbeat().state(), v1::JobStatus::STATE_UNSPECIFIED);
    }
    last = event.sequence();
  }
  server.cancel(running);
  while (reader->Read(&event)) {
  }
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_TRUE(event.has_ended());
}

TEST(Watch, IsRefusedBeyondTheLimitAndFreesItsPlace) {
  RunningServer server([](auto& settings) { settings.server.limits.watchers = 1; });
  const std::string job = server.create(endless_job(server.create(paper_mesh()).name())).name();
  Context context;
  const auto reader = server.jobs->WatchJob(&context, watch_request(job));
  v1::WatchJobResponse event;
  ASSERT_TRUE(reader->Read(&event));
  EXPECT_EQ(server.info().metrics().watchers(), 1);
  Events events;
  const grpc::Status status = server.watch(job, 0, events);
  expect_error(status, grpc::StatusCode::RESOURCE_EXHAUSTED, "BUSY", "");
  EXPECT_GT(details_of(status).retry_seconds, 0);
  context.TryCancel();
  reader->Finish();
  EXPECT_TRUE(eventually([&] { return server.info().metrics().watchers() == 0; }));
  server.cancel(job);
  EXPECT_TRUE(server.watch(job, 0, events).ok());
}

TEST(Watch, ManyOnOneJobAllSeeItsEnd) {
  RunningServer server;
  const std::string job = server.create(endless_job(server.create(paper_mesh()).name())).name();
  struct Watcher {
    Context context;
    std::unique_ptr<grpc::ClientReader<v1::WatchJobResponse>> reader;
  };
  std::vector<std::unique_ptr<Watcher>> watchers;
  for (int i = 0; i < 50; ++i) {
    watchers.push_back(std::make_unique<Watcher>());
    watchers.back()->reader = server.jobs->WatchJob(&watchers.back()->context, watch_request(job));
  }
  v1::WatchJobResponse event;
  for (const auto& watcher : watchers) ASSERT_TRUE(watcher->reader->Read(&event));
  server.cancel(job);
  for (const auto& watcher : watchers) {
    while (watcher->reader->Read(&event)) {
    }
    EXPECT_TRUE(watcher->reader->Finish().ok());
    EXPECT_TRUE(event.has_ended());
  }
}

}  // namespace
}  // namespace anticrack::rpc
