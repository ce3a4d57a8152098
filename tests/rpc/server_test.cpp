// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/server.hpp"

#include <gmock/gmock.h>
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

#include <future>

#include "errors/errors.hpp"
#include "rpc/details.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"
#include "support/errors.hpp"
#include "support/eventually.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::call;
using anticrack::testing::Context;
using anticrack::testing::expect_error;
using anticrack::testing::Meshes;
using anticrack::testing::must;
using anticrack::testing::named;
using anticrack::testing::opening_job;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;

/// One message each way to a service whose stubs are not here, in protobuf's wire format.
grpc::Status call(RunningServer& server, const std::string& method, const std::string& request,
                  std::string& response) {
  grpc::GenericStub stub(server.channel());
  Context context;
  const grpc::Slice slice(request);
  const grpc::ByteBuffer out(&slice, 1);
  grpc::ByteBuffer in;
  std::promise<grpc::Status> done;
  stub.UnaryCall(&context, method, grpc::StubOptions(), &out, &in,
                 [&](grpc::Status status) { done.set_value(std::move(status)); });
  const grpc::Status status = done.get_future().get();
  grpc::Slice flat;
  response.clear();
  if (status.ok() && in.DumpToSingleSlice(&flat).ok()) {
    response.assign(reinterpret_cast<const char*>(flat.begin()), flat.size());
  }
  return status;
}

TEST(Server, TellsWhatItIsAndAllows) {
  RunningServer server([](auto& settings) {
    settings.engine.threads = 3;
    settings.engine.max_load_cases = 17;
    settings.engine.max_sweep_rows = 5'000'000'000;
    settings.engine.max_sweep_basis = 18;
    settings.server.limits.upload_bytes = 12'345;
    settings.server.limits.watchers = 5;
    settings.server.limits.meshing_time = std::chrono::seconds(99);
  });
  const v1::ServerInfo info = server.info();
  EXPECT_FALSE(info.version().empty());
  EXPECT_FALSE(info.build().empty());
  EXPECT_GT(info.start_time().seconds(), 0);
  EXPECT_EQ(info.threads(), 3);
  EXPECT_EQ(info.limits().load_cases(), 17);
  EXPECT_EQ(info.limits().sweep_rows(), 5'000'000'000u);
  EXPECT_EQ(info.limits().sweep_basis(), 18);
  EXPECT_EQ(info.limits().upload_bytes(), 12'345u);
  EXPECT_EQ(info.limits().watchers(), 5);
  EXPECT_EQ(info.limits().meshing_time().seconds(), 99);
  EXPECT_GT(info.limits().expression_bytes(), 0u);
  EXPECT_GT(info.limits().queued_jobs(), 0);
  EXPECT_THAT(info.features(), ::testing::Contains("uzawa"));
  EXPECT_THAT(info.features(), ::testing::Contains("active_set"));
  EXPECT_THAT(info.features(), ::testing::Contains("sweep"));
}

TEST(Server, CountsWhatItDoes) {
  RunningServer server;
  const std::string mesh = server.create(paper_mesh()).name();
  ASSERT_EQ(server.settle(mesh).state(), v1::Mesh::STATE_READY);
  server.finish(server.create(opening_job(mesh)).name());
  const v1::ServerMetrics first = server.info().metrics();
  EXPECT_EQ(first.meshings(), 1u);
  EXPECT_EQ(first.factorizations(), 1u);
  EXPECT_EQ(first.jobs_created(), 1u);
  EXPECT_EQ(first.jobs_ended(), 1u);
  EXPECT_EQ(first.load_cases_ended(), 1u);
  EXPECT_GT(first.iterations(), 0u);
  EXPECT_GT(first.operator_bytes(), 0u);

  server.finish(server.create(opening_job(mesh)).name());
  const v1::ServerMetrics second = server.info().metrics();
  EXPECT_EQ(second.factorizations(), 1u);
  EXPECT_GT(second.operator_hits(), first.operator_hits());
  EXPECT_EQ(second.meshings(), 1u);
}

TEST(Server, AnswersHealthChecksByServiceName) {
  RunningServer server;
  const auto check = [&](const std::string& service, std::string& answer) {
    const std::string request =
        service.empty() ? "" : "\x0a" + std::string(1, static_cast<char>(service.size())) + service;
    return call(server, "/grpc.health.v1.Health/Check", request, answer);
  };
  const std::string serving = "\x08\x01";
  for (const char* service : {"", "anticrack.v1.UploadService", "anticrack.v1.MeshService",
                              "anticrack.v1.SolveService", "anticrack.v1.ServerService"}) {
    std::string answer;
    EXPECT_TRUE(check(service, answer).ok()) << service;
    EXPECT_EQ(answer, serving) << service;
  }
  std::string answer;
  EXPECT_EQ(check("anticrack.v1.Other", answer).error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST(Server, ListsItsServicesByReflection) {
  RunningServer server;
  std::string answer;
  const std::string list_services{"\x3a\x00", 2};
  const grpc::Status status =
      call(server, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", list_services,
           answer);
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_THAT(answer, ::testing::HasSubstr("anticrack.v1.SolveService"));
}

TEST(Server, TakesNoPortThatAnotherHas) {
  RunningServer first;
  const auto listen_there = [&](auto& settings) {
    settings.server.listen = first.server().address();
  };
  EXPECT_TRUE(anticrack::testing::throws([&] { RunningServer second(listen_there); },
                                         errors::Reason::invalid_argument, "listen"));
  EXPECT_FALSE(first.info().version().empty());
}

TEST(Server, ListensOnAUnixSocket) {
  const anticrack::testing::TemporaryFolder folder;
  const std::string address = "unix:" + folder.path() + "/socket";
  RunningServer server([&](auto& settings) { settings.server.listen = address; });
  EXPECT_EQ(server.server().address(), address);
  EXPECT_FALSE(server.info().version().empty());
}

TEST(Server, ListsEveryLimit) {
  RunningServer server([](auto& settings) {
    settings.server.limits.memory_budget_bytes = 1;
    settings.server.limits.disk_budget_bytes = 1;
    settings.server.limits.mesher_memory_bytes = 1;
  });
  const v1::ServerLimits limits = server.info().limits();
  const google::protobuf::Reflection& values = *limits.GetReflection();
  const google::protobuf::Descriptor& fields = *limits.GetDescriptor();
  for (int i = 0; i < fields.field_count(); ++i) {
    // proto3 has no field where the value is 0: forgotten, or without a bound.
    EXPECT_TRUE(values.HasField(limits, fields.field(i))) << fields.field(i)->name();
  }
}

TEST(Server, StopsBeingReadyWhenAStopIsAnnouncedAndServesOn) {
  RunningServer server;
  server.server().announce(false);
  std::string answer;
  EXPECT_TRUE(call(server, "/grpc.health.v1.Health/Check", "", answer).ok());
  EXPECT_EQ(answer, "\x08\x02");
  EXPECT_FALSE(server.create(paper_mesh()).name().empty());
}

TEST(Server, WarmsEvictsAndDeletesMeshes) {
  RunningServer server;
  const std::string name = server.create(paper_mesh()).name();
  ASSERT_EQ(server.settle(name).state(), v1::Mesh::STATE_READY);
  EXPECT_FALSE(server.mesh(name).pinned());
  const auto until_free = [](const auto& attempt) {
    grpc::Status status;  // whoever made it READY may still hold it for a moment
    EXPECT_TRUE(anticrack::testing::eventually([&] {
      status = attempt();
      return status.error_code() != grpc::StatusCode::FAILED_PRECONDITION;
    }));
    return status;
  };
  auto warm = named<v1::WarmMeshRequest>(name);
  warm.set_pin(true);
  must(*server.meshes, &Meshes::WarmMesh, warm);
  ASSERT_TRUE(anticrack::testing::eventually([&] { return server.mesh(name).pinned(); }));
  v1::Mesh mesh;
  const grpc::Status evicted = until_free([&] {
    return call(*server.meshes, &Meshes::EvictMesh, named<v1::EvictMeshRequest>(name), &mesh);
  });
  EXPECT_TRUE(evicted.ok()) << evicted.error_message();
  EXPECT_EQ(mesh.state(), v1::Mesh::STATE_EVICTED);
  EXPECT_FALSE(mesh.pinned());
  const auto erase = [&] {
    return call(*server.meshes, &Meshes::DeleteMesh, named<v1::DeleteMeshRequest>(name));
  };
  EXPECT_TRUE(until_free(erase).ok());
  expect_error(erase(), grpc::StatusCode::NOT_FOUND, "NOT_FOUND", "");
}

TEST(Server, SurvivesARequestLargerThanAMessageMayBe) {
  RunningServer server;
  v1::CreateJobRequest request = opening_job("meshes/a");
  request.mutable_spec()->mutable_load_cases(0)->mutable_force()->set_expression(
      std::string(5u << 20, '1'));
  EXPECT_EQ(server.try_create(request).error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_FALSE(server.info().version().empty());
}

}  // namespace
}  // namespace anticrack::rpc
