// SPDX-License-Identifier: GPL-3.0-or-later
//
// Many watches of one job, and watches over a restart.
#include <gtest/gtest.h>

#include "rpc/details.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"
#include "support/eventually.hpp"

namespace anticrack::rpc {
namespace {

using namespace std::chrono_literals;
using anticrack::testing::Context;
using anticrack::testing::details_of;
using anticrack::testing::endless_job;
using anticrack::testing::eventually;
using anticrack::testing::named;
using anticrack::testing::opening_job;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;

struct Watcher {
  Watcher(RunningServer& server, const std::string& job) {
    reader = server.jobs->WatchJob(&context, named<v1::WatchJobRequest>(job));
  }
  Context context;
  std::unique_ptr<grpc::ClientReader<v1::WatchJobResponse>> reader;
};

TEST(WatchScale, IdleWatchersHoldNobodyUp) {
  RunningServer server([](auto& settings) {
    settings.engine.event_log_bytes = 64 << 10;
    settings.server.stall = 10min;
  });
  const std::string mesh = server.create(paper_mesh()).name();
  const std::string busy = server.create(endless_job(mesh)).name();
  std::vector<std::unique_ptr<Watcher>> idle;
  for (int i = 0; i < 200; ++i) idle.push_back(std::make_unique<Watcher>(server, busy));
  v1::WatchJobResponse event;
  for (const auto& watcher : idle) {
    ASSERT_TRUE(watcher->reader->Read(&event));
    EXPECT_TRUE(event.has_snapshot());
  }
  // Nobody reads on; the job and others go on all the same.
  const auto before = server.info().metrics().iterations();
  EXPECT_EQ(server.finish(server.create(opening_job(mesh)).name()).status().state(),
            v1::JobStatus::STATE_SUCCEEDED);
  EXPECT_TRUE(eventually([&] { return server.info().metrics().iterations() > before + 1'000; }));
  EXPECT_TRUE(server.cancel(busy).ok());
  for (const auto& watcher : idle) {
    while (watcher->reader->Read(&event)) {
    }
    const grpc::Status status = watcher->reader->Finish();
    if (status.ok()) {
      EXPECT_TRUE(event.has_ended());
    } else {  // fell behind the log's end while it did not read
      EXPECT_EQ(status.error_code(), grpc::StatusCode::OUT_OF_RANGE) << status.error_message();
    }
  }
  EXPECT_TRUE(eventually([&] { return server.server().metrics().watchers == 0; }));
  EXPECT_EQ(server.server().metrics().largest_lag, 0u);
}

TEST(WatchScale, AWatcherThatDoesNotReadIsSeenToLag) {
  RunningServer server([](auto& settings) { settings.server.stall = 10min; });
  const std::string job = server.create(endless_job(server.create(paper_mesh(0.05)).name())).name();
  Watcher slow(server, job);
  EXPECT_TRUE(eventually([&] { return server.server().metrics().largest_lag > 10'000; }));
  slow.context.TryCancel();
  slow.reader->Finish();
  server.cancel(job);
}

TEST(WatchScale, GoesOnOverARestartWithLargerNumbers) {
  RunningServer server;
  const std::string job = server.create(endless_job(server.create(paper_mesh()).name())).name();
  std::uint64_t sequence = 0;
  {
    Watcher first(server, job);
    v1::WatchJobResponse event;
    while (first.reader->Read(&event) && !event.has_samples()) {
    }
    ASSERT_TRUE(event.has_samples());
    sequence = event.sequence();
    first.context.TryCancel();
    first.reader->Finish();
  }
  server.restart();
  ASSERT_TRUE(
      eventually([&] { return server.job(job).status().state() == v1::JobStatus::STATE_RUNNING; }));
  std::vector<v1::WatchJobResponse> events;
  grpc::Status status = server.watch(job, sequence, events);
  ASSERT_EQ(status.error_code(), grpc::StatusCode::OUT_OF_RANGE) << status.error_message();
  server.cancel(job);
  while (status.error_code() == grpc::StatusCode::OUT_OF_RANGE) {  // again while the log moves on
    const std::uint64_t earliest = std::stoull(details_of(status).metadata.at("earliest_sequence"));
    EXPECT_GT(earliest, std::uint64_t{1} << 40);
    events.clear();
    status = server.watch(job, earliest - 1, events);
  }
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_GE(events.size(), 2u);
  EXPECT_EQ(events.front().snapshot().job().status().attempt(), 2);
  EXPECT_TRUE(events.back().has_ended());
  for (std::size_t i = 1; i < events.size(); ++i) {
    EXPECT_GT(events[i].sequence(), events[i - 1].sequence());
  }

  server.restart();  // of the ended job nothing is left but its end
  std::vector<v1::WatchJobResponse> rest;
  ASSERT_TRUE(server.watch(job, 0, rest).ok());
  ASSERT_EQ(rest.size(), 2u);
  EXPECT_TRUE(rest.back().has_ended());
  EXPECT_GT(rest.back().sequence(), events.back().sequence());
}

}  // namespace
}  // namespace anticrack::rpc
