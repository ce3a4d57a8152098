// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cases through the server: the requests it reads are those it takes, and what it refuses of them
// was written where it says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "anticrack/v1/case.grpc.pb.h"
#include "rpc/details.hpp"
#include "rpc/running_server.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::Context;
using anticrack::testing::details_of;
using anticrack::testing::RunningServer;

const std::string square = R"([geometry]
boundary  = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
interface = [[-1, 0], [1, 0]]
crack     = [{ name = "c", from = [-0.5, 0], to = [0.5, 0] }]
[mesh]
size = 0.5
[[load]]
name = "up"
f = "1 + x"
)";

class CaseService : public ::testing::Test {
 protected:
  grpc::Status read(const std::string& toml) {
    v1::ReadCaseRequest request;
    request.set_toml(toml);
    request.set_source("square.toml");
    Context context;
    return v1::CaseService::NewStub(server.channel())->ReadCase(&context, request, &answer);
  }

  RunningServer server;
  v1::ReadCaseResponse answer;
};

TEST_F(CaseService, GivesRequestsThatTheServerTakes) {
  ASSERT_TRUE(read(square).ok());
  v1::CreateJobRequest request;
  request.set_request_id("123e4567-e89b-42d3-a456-426614174000");
  *request.mutable_spec() = answer.spec();
  request.mutable_spec()->set_mesh(server.create(answer.mesh()).name());
  EXPECT_EQ(server.finish(server.create(request).name()).status().state(),
            v1::JobStatus::STATE_SUCCEEDED);
}

TEST_F(CaseService, PlacesTellWhereARefusedFieldWasWritten) {
  std::string outside = square;
  outside.replace(outside.find("0.5, 0] }"), 3, "7.5");
  ASSERT_TRUE(read(outside).ok());
  const grpc::Status refused = server.try_create(answer.mesh());
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  const v1::CasePlace& place = answer.places().at(details_of(refused).fields.at(0));
  EXPECT_EQ(place.where(), "square.toml:4");
  EXPECT_EQ(place.key(), "geometry.crack.c.to");
}

TEST_F(CaseService, RefusesACaseByItsKey) {
  testing::expect_error(read(square + "force = 1\n"), grpc::StatusCode::INVALID_ARGUMENT,
                        "CASE_INVALID", "load.up.force");
  testing::expect_error(read("\xff"), grpc::StatusCode::INVALID_ARGUMENT, "CASE_INVALID",
                        "column 1");
}

}  // namespace
}  // namespace anticrack::rpc
