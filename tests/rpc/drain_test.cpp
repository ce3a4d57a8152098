// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <thread>

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
using anticrack::testing::expect_error;
using anticrack::testing::named;
using anticrack::testing::opening_job;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;

TEST(Drain, EndsWatchesAndUploadsWithADelay) {
  RunningServer server;
  const std::string job = server.create(endless_job(server.create(paper_mesh()).name())).name();
  Context watch_context;
  const auto watch = server.jobs->WatchJob(&watch_context, named<v1::WatchJobRequest>(job));
  v1::WatchJobResponse event;
  ASSERT_TRUE(watch->Read(&event));
  Context upload_context;
  v1::CreateUploadsResponse response;
  const auto upload = server.uploads->CreateUploads(&upload_context, &response);
  v1::CreateUploadsRequest header;
  header.mutable_header()->set_size(10);
  header.mutable_header()->set_sha256(std::string(64, '0'));
  ASSERT_TRUE(upload->Write(header));
  ASSERT_TRUE(eventually([&] { return server.upload_files() == 1; }));

  std::thread drain([&] { server.server().drain(0ms); });
  while (watch->Read(&event)) {
    EXPECT_FALSE(event.has_ended());  // nobody cancelled the job
  }
  const grpc::Status watched = watch->Finish();
  expect_error(watched, grpc::StatusCode::UNAVAILABLE, "DRAINING", "");
  EXPECT_GT(details_of(watched).retry_seconds, 0);
  const grpc::Status uploaded = upload->Finish();
  expect_error(uploaded, grpc::StatusCode::UNAVAILABLE, "DRAINING", "");
  drain.join();
  EXPECT_EQ(server.upload_files(), 0u);
}

TEST(Drain, RefusesNewWorkAndLetsOldWorkEnd) {
  RunningServer server;
  const std::string mesh = server.create(paper_mesh()).name();
  const std::string job = server.create(endless_job(mesh)).name();
  Context context;
  const auto watch = server.jobs->WatchJob(&context, named<v1::WatchJobRequest>(job));
  v1::WatchJobResponse event;
  while (watch->Read(&event) && !event.has_samples()) {
  }
  std::thread drain([&] { server.server().drain(10min); });
  grpc::Status refused;
  ASSERT_TRUE(eventually([&] {
    refused = server.try_create(opening_job(mesh));
    return !refused.ok();
  }));
  expect_error(refused, grpc::StatusCode::UNAVAILABLE, "DRAINING", "");
  expect_error(server.try_create(paper_mesh(0.3)), grpc::StatusCode::UNAVAILABLE, "DRAINING", "");
  EXPECT_EQ(server.job(job).status().state(),
            v1::JobStatus::STATE_RUNNING);  // looking is still allowed
  EXPECT_TRUE(server.cancel(job).ok());
  while (watch->Read(&event)) {
  }
  EXPECT_TRUE(watch->Finish().ok());
  EXPECT_TRUE(event.has_ended());
  drain.join();
}

TEST(Drain, PutsWhatDoesNotEndBackForTheNextStart) {
  RunningServer server([](auto& settings) { settings.engine.threads = 1; });
  const std::string mesh = server.create(paper_mesh()).name();
  const std::string running = server.create(endless_job(mesh)).name();
  Context context;
  const auto watch = server.jobs->WatchJob(&context, named<v1::WatchJobRequest>(running));
  v1::WatchJobResponse event;
  while (watch->Read(&event) && !event.has_samples()) {
  }
  server.restart();
  while (watch->Read(&event)) {
    EXPECT_FALSE(event.has_ended());
  }
  EXPECT_FALSE(watch->Finish().ok());
  EXPECT_LT(server.job(running).status().state(), v1::JobStatus::STATE_SUCCEEDED);
  EXPECT_TRUE(server.cancel(running).ok());
  EXPECT_EQ(server.finish(running).status().state(), v1::JobStatus::STATE_CANCELLED);
  EXPECT_EQ(server.job(running).status().attempt(), 2);
}

TEST(Drain, AWatchOfAnEndedJobSendsTheRestFirst) {
  RunningServer server;
  const std::string mesh = server.create(paper_mesh(0.05)).name();
  const std::string job = server.create(endless_job(mesh)).name();
  Context context;
  const auto watch = server.jobs->WatchJob(&context, named<v1::WatchJobRequest>(job));
  ASSERT_TRUE(eventually([&] { return server.info().metrics().iterations() > 20'000; }));
  EXPECT_TRUE(server.cancel(job).ok());
  ASSERT_TRUE(eventually(
      [&] { return server.job(job).status().state() == v1::JobStatus::STATE_CANCELLED; }));
  std::thread drain([&] { server.server().drain(10min); });
  ASSERT_TRUE(eventually([&] { return !server.try_create(opening_job(mesh)).ok(); }));
  v1::WatchJobResponse event;
  while (watch->Read(&event)) {
  }
  EXPECT_TRUE(watch->Finish().ok());
  EXPECT_TRUE(event.has_ended());
  drain.join();
}

TEST(Drain, DoesNotWaitForWhoDoesNotRead) {
  RunningServer server;
  const std::string job = server.create(endless_job(server.create(paper_mesh(0.05)).name())).name();
  std::vector<std::unique_ptr<Context>> contexts;
  std::vector<std::unique_ptr<grpc::ClientReader<v1::WatchJobResponse>>> readers;
  for (int i = 0; i < 4; ++i) {
    contexts.push_back(std::make_unique<Context>());
    readers.push_back(
        server.jobs->WatchJob(contexts.back().get(), named<v1::WatchJobRequest>(job)));
  }
  ASSERT_TRUE(eventually([&] { return server.info().metrics().iterations() > 200'000; }));
  server.server().drain(0ms);
  v1::WatchJobResponse event;
  for (const auto& reader : readers) {
    while (reader->Read(&event)) {
    }
    EXPECT_FALSE(reader->Finish().ok());
  }
}

TEST(Drain, IsDoneOnce) {
  RunningServer server;
  std::thread other([&] { server.server().drain(0ms); });
  server.server().drain(0ms);
  other.join();
  EXPECT_EQ(server.try_create(paper_mesh()).error_code(), grpc::StatusCode::UNAVAILABLE);
}

}  // namespace
}  // namespace anticrack::rpc
