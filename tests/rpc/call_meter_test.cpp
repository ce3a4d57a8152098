// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <map>
#include <mutex>

#include "rpc/details.hpp"
#include "rpc/people.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::Context;
using anticrack::testing::named;
using anticrack::testing::opening_job;
using anticrack::testing::owner_token;
using anticrack::testing::RunningServer;

/// What a server told of its calls. The status is sent after it, so that a client who has it finds
/// its call here.
class Calls {
 public:
  CallListener listener() {
    return [this](const std::string& method, int code, std::chrono::duration<double> time) {
      EXPECT_GE(time.count(), 0);
      const std::lock_guard lock(_mutex);
      ++_counts[{method, code}];
    };
  }
  int count(const std::string& method, grpc::StatusCode code) {
    const std::lock_guard lock(_mutex);
    return _counts[{"/anticrack.v1." + method, code}];
  }

 private:
  std::mutex _mutex;
  std::map<std::pair<std::string, int>, int> _counts;
};

TEST(CallMeter, IsToldOfEveryCallHoweverItEnds) {
  Calls calls;
  RunningServer server([&](auto& settings) {
    settings.server.call_ended = calls.listener();
    settings.server.security.tokens = anticrack::testing::people();
  });
  const auto info = [&](const std::string& token) {
    Context context(token);
    v1::ServerInfo answer;
    return server.servers->GetServerInfo(&context, {}, &answer);
  };
  EXPECT_TRUE(info(owner_token).ok());
  EXPECT_TRUE(info(owner_token).ok());
  EXPECT_FALSE(info("").ok());
  EXPECT_EQ(calls.count("ServerService/GetServerInfo", grpc::StatusCode::OK), 2);
  EXPECT_EQ(calls.count("ServerService/GetServerInfo", grpc::StatusCode::UNAUTHENTICATED), 1);

  const auto watch = [&](const std::string& token) {
    Context context(token);
    v1::WatchJobResponse event;
    const auto reader = server.jobs->WatchJob(&context, named<v1::WatchJobRequest>("jobs/none"));
    EXPECT_FALSE(reader->Read(&event));
    return reader->Finish();
  };
  EXPECT_EQ(watch(owner_token).error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(watch("").error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(calls.count("SolveService/WatchJob", grpc::StatusCode::NOT_FOUND), 1);
  EXPECT_EQ(calls.count("SolveService/WatchJob", grpc::StatusCode::UNAUTHENTICATED), 1);

  Context context(owner_token);
  v1::CreateUploadsResponse response;
  const auto writer = server.uploads->CreateUploads(&context, &response);
  writer->WritesDone();
  EXPECT_EQ(writer->Finish().error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(calls.count("UploadService/CreateUploads", grpc::StatusCode::INVALID_ARGUMENT), 1);

  Context unary(owner_token);
  v1::Job job;
  EXPECT_EQ(server.jobs->CreateJob(&unary, opening_job("meshes/none"), &job).error_code(),
            grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(calls.count("SolveService/CreateJob", grpc::StatusCode::NOT_FOUND), 1);
}

}  // namespace
}  // namespace anticrack::rpc
