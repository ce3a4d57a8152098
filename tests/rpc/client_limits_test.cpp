// SPDX-License-Identifier: GPL-3.0-or-later
//
// What one client can take from the others, and what abuse of uploads leaves behind: nothing.
#include <gtest/gtest.h>

#include "rpc/authentication.hpp"
#include "rpc/details.hpp"
#include "rpc/people.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"
#include "support/eventually.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::BegunUpload;
using anticrack::testing::eventually;
using anticrack::testing::expect_error;
using anticrack::testing::other_token;
using anticrack::testing::owner_token;
using anticrack::testing::RunningServer;
using anticrack::testing::small_msh;
using anticrack::testing::upload_header;

TEST(ClientLimits, AMachineIsOneClientWhateverItsConnections) {
  EXPECT_EQ(without_port("ipv4:10.0.0.1:4711"), "ipv4:10.0.0.1");
  EXPECT_EQ(without_port("ipv6:%5B::1%5D:4711"), "ipv6:%5B::1%5D");
  EXPECT_EQ(without_port("unix:"), "unix:");
}

TEST(ClientLimits, HalfOpenStreamsOfOneHoldNobodyElseOff) {
  constexpr int cap = 8;
  RunningServer server([](auto& settings) {
    settings.server.security.tokens = anticrack::testing::people();
    settings.server.limits.streams_a_client = cap;
  });
  std::vector<std::unique_ptr<BegunUpload>> held;
  for (int i = 0; i < cap; ++i) {
    held.push_back(std::make_unique<BegunUpload>(server, upload_header(small_msh()), owner_token));
  }
  ASSERT_TRUE(eventually([&] { return server.server().metrics().transfers == cap; }));
  std::vector<std::unique_ptr<BegunUpload>> refused;  // all of them open at once, for their client
  for (int i = 0; i < 10'000; ++i) {
    refused.push_back(
        std::make_unique<BegunUpload>(server, upload_header(small_msh()), owner_token));
  }
  BegunUpload other(server, upload_header(small_msh()), other_token);
  other.send(small_msh());
  EXPECT_TRUE(other.finish().ok());
  EXPECT_TRUE(eventually([&] { return server.server().metrics().transfers == cap; }));
  for (const auto& upload : refused) {
    expect_error(upload->finish(), grpc::StatusCode::RESOURCE_EXHAUSTED, "BUSY", "");
  }
  for (const auto& upload : held) upload->drop();
  EXPECT_TRUE(eventually([&] { return server.server().metrics().transfers == 0; }));
  EXPECT_TRUE(eventually([&] { return server.upload_files() == 1; }));
}

TEST(ClientLimits, TransfersOfOneLeaveRoomForOthers) {
  RunningServer server([](auto& settings) {
    settings.server.security.tokens = anticrack::testing::people();
    settings.server.limits.transfers = 8;
  });
  std::vector<std::unique_ptr<BegunUpload>> held;
  for (int i = 0; i < 4; ++i)
    held.push_back(std::make_unique<BegunUpload>(server, upload_header(small_msh()), owner_token));
  ASSERT_TRUE(eventually([&] { return server.server().metrics().transfers == 4; }));
  BegunUpload fifth(server, upload_header(small_msh()), owner_token);
  expect_error(fifth.finish(), grpc::StatusCode::RESOURCE_EXHAUSTED, "BUSY", "");
  BegunUpload other(server, upload_header(small_msh()), other_token);
  other.send(small_msh());
  EXPECT_TRUE(other.finish().ok());
  for (const auto& upload : held) upload->drop();
}

TEST(ClientLimits, SlowUploadsAreCutOff) {
  RunningServer server(
      [](auto& settings) { settings.server.stall = std::chrono::milliseconds(200); });
  const std::string content = small_msh();
  BegunUpload slow(server, upload_header(content));
  // Never silent for as long as a stall, and far below the least rate: ends before its last byte.
  std::size_t sent = 0;
  for (; sent < content.size() && slow.send(std::string(1, content[sent])); ++sent)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_LT(sent, content.size());
  expect_error(slow.finish(), grpc::StatusCode::CANCELLED, "CANCELLED", "");
  EXPECT_TRUE(eventually([&] { return server.server().metrics().transfers == 0; }));
}

TEST(ClientLimits, TwoUploadsOfTheSameAtOnceAreOne) {
  RunningServer server;
  const std::string content = small_msh();
  BegunUpload first(server, upload_header(content));
  BegunUpload second(server, upload_header(content));
  for (const char c : content) {
    ASSERT_TRUE(first.send(std::string(1, c)));
    ASSERT_TRUE(second.send(std::string(1, c)));
  }
  EXPECT_TRUE(first.finish().ok());
  EXPECT_TRUE(second.finish().ok());
  EXPECT_EQ(first.name(), second.name());
  EXPECT_EQ(server.upload_files(), 1u);
}

TEST(ClientLimits, AnUploadIsNotSpoiledByAForgeryOfItsName) {
  RunningServer server;
  const std::string content = small_msh();
  std::string forged = content;
  forged.back() = ' ';
  BegunUpload honest(server, upload_header(content));
  BegunUpload forgery(server, upload_header(content));
  forgery.send(forged);
  honest.send(content);
  expect_error(forgery.finish(), grpc::StatusCode::INVALID_ARGUMENT, "INVALID_ARGUMENT",
               "header.sha256");
  EXPECT_TRUE(honest.finish().ok());
  BegunUpload late(server, upload_header(content));  // what is there already is not replaced either
  late.send(forged);
  EXPECT_FALSE(late.finish().ok());
  v1::CreateMeshRequest request;
  request.set_upload(honest.name());
  EXPECT_FALSE(server.create(request).name().empty());
  EXPECT_TRUE(eventually([&] { return server.upload_files() == 1; }));
}

TEST(ClientLimits, ChunksWithoutEndStopAtWhatWasAnnounced) {
  RunningServer server;
  BegunUpload upload(server, upload_header(small_msh()));
  while (upload.send(small_msh())) {
  }
  expect_error(upload.finish(), grpc::StatusCode::INVALID_ARGUMENT, "INVALID_ARGUMENT",
               "header.size");
  EXPECT_TRUE(eventually([&] { return server.upload_files() == 0; }));
}

}  // namespace
}  // namespace anticrack::rpc
