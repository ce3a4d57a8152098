// SPDX-License-Identifier: GPL-3.0-or-later
//
// Jobs from submission to result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "digest/digest.hpp"
#include "rpc/details.hpp"
#include "rpc/received.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::call;
using anticrack::testing::Context;
using anticrack::testing::doubles;
using anticrack::testing::endless_job;
using anticrack::testing::expect_error;
using anticrack::testing::Jobs;
using anticrack::testing::named;
using anticrack::testing::opening_job;
using anticrack::testing::paper_mesh;
using anticrack::testing::read_mesh;
using anticrack::testing::read_result;
using anticrack::testing::Received;
using anticrack::testing::RunningServer;

TEST(Job, OpensTheCrackOfExampleThree) {
  RunningServer server;
  v1::CreateMeshRequest mesh = paper_mesh();
  mesh.mutable_options()->Clear();
  mesh.mutable_options()->set_preset(v1::MESH_PRESET_PAPER);
  const v1::Mesh created = server.create(mesh);
  EXPECT_EQ(created.title(), "section 8");
  v1::CreateJobRequest request = opening_job(created.name());
  request.mutable_spec()->set_title("Example 3");
  request.mutable_spec()->add_outputs(v1::OUTPUT_FIELDS);
  request.mutable_spec()->mutable_solver()->mutable_uzawa();
  const v1::Job job = server.finish(server.create(request).name());

  EXPECT_EQ(job.spec().title(), "Example 3");
  EXPECT_EQ(job.spec().mesh(), created.name());
  ASSERT_EQ(job.status().state(), v1::JobStatus::STATE_SUCCEEDED);
  EXPECT_EQ(job.status().attempt(), 1);
  EXPECT_GE(job.status().end_time().seconds(), job.status().start_time().seconds());
  const v1::Uzawa& uzawa = job.spec().solver().uzawa();
  EXPECT_EQ(uzawa.theta(), 2.0);
  EXPECT_EQ(uzawa.epsilon(), 1e-12);
  EXPECT_EQ(uzawa.p(), 1e5);
  EXPECT_EQ(uzawa.mass(), v1::MASS_LUMPED);
  EXPECT_EQ(job.spec().load_cases(0).force().expression(), "y > 0 ? 1 : -1");
  EXPECT_EQ(job.status().load_case_count(), 1);
  EXPECT_EQ(job.status().load_cases_ended(), 1);
  ASSERT_EQ(job.status().answers_size(), 1);
  const v1::LoadCaseAnswer& answer = job.status().answers(0);
  EXPECT_EQ(answer.name(), "opening");
  EXPECT_EQ(answer.status(), v1::LoadCaseAnswer::STATUS_CONVERGED);
  EXPECT_GT(answer.iterations(), 0);
  EXPECT_LE(answer.criterion(), 1e-12);
  ASSERT_EQ(answer.inclusions_size(), 1);
  EXPECT_EQ(answer.inclusions(0).name(), "fibre");
  EXPECT_NEAR(answer.inclusions(0).displacement(), 0.0863, 0.001);
  EXPECT_NEAR(answer.inclusions(0).resultant(), 0, 1e-9);
  EXPECT_EQ(answer.contact_length(), 0);

  Received block;
  ASSERT_TRUE(read_result(server, job.name(), 0, block).ok());
  EXPECT_EQ(block.bytes.size(), job.status().result_bytes());
  EXPECT_EQ(block.layout.size(), job.status().result_bytes());
  EXPECT_EQ(block.layout.sha256(), digest::Sha256().add(block.bytes).finish());
  const auto x = doubles(block, "interfaces/0/x");
  const auto jump = doubles(block, "loads/0/traces/0/jump");
  ASSERT_EQ(x.size(), jump.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::abs(x[i]) < 0.49) {
      EXPECT_GT(jump[i], 0) << "at " << x[i];
    } else {
      EXPECT_NEAR(jump[i], 0, 1e-4) << "at " << x[i];
    }
  }
  EXPECT_EQ(doubles(block, "loads/0/history/criterion").size(),
            static_cast<std::size_t>(answer.iterations()));
}

/// Ninety slits in a plate.
v1::CreateMeshRequest mesh_of_slits() {
  v1::CreateMeshRequest request;
  v1::Geometry& geometry = *request.mutable_geometry();
  const auto point = [](v1::Point& to, double x, double y) {
    to.set_x(x);
    to.set_y(y);
  };
  for (const auto& [x, y] :
       {std::pair(0, 0), std::pair(10, 0), std::pair(10, 9), std::pair(0, 9)}) {
    point(*geometry.add_boundary(), x, y);
  }
  for (int i = 0; i < 90; ++i) {
    const double x = i % 10 + 0.3, y = i / 10 + 0.5;
    v1::InterfaceCurve& slit = *geometry.add_interfaces();
    slit.set_name("slit-" + std::to_string(i));
    point(*slit.mutable_polyline()->add_points(), x, y);
    point(*slit.mutable_polyline()->add_points(), x + 0.4, y);
    v1::Crack& crack = *geometry.add_cracks();
    crack.set_name("crack-" + std::to_string(i));
    point(*crack.mutable_part()->mutable_from(), x, y);
    point(*crack.mutable_part()->mutable_to(), x + 0.4, y);
  }
  request.mutable_options()->set_preset(v1::MESH_PRESET_UNIFORM);
  request.mutable_options()->set_size(0.3);
  return request;
}

/// The layout alone has some 20 MB. The numbers of 180,000 tips have no room in the answers.
TEST(Job, OfManyLoadsAndInterfacesIsReadWhole) {
  RunningServer server;
  const std::string mesh = server.create(mesh_of_slits()).name();
  v1::CreateJobRequest request;
  request.mutable_spec()->set_mesh(mesh);
  for (int i = 0; i < 1000; ++i) {
    v1::LoadCase& load = *request.mutable_spec()->add_load_cases();
    load.set_name("load-" + std::to_string(i));
    load.mutable_force()->set_constant(i);
  }
  const v1::Job job = server.finish(server.create(request).name());
  ASSERT_EQ(job.status().state(), v1::JobStatus::STATE_SUCCEEDED) << job.status().error().message();
  ASSERT_EQ(job.status().answers_size(), 1000);
  EXPECT_EQ(job.status().answers(999).tips_size(), 0);
  ASSERT_EQ(job.status().answers(999).warnings_size(), 1);
  EXPECT_THAT(job.status().answers(999).warnings(0), ::testing::StartsWith("no numbers of tips"));
  Received block;
  ASSERT_TRUE(read_result(server, job.name(), 0, block).ok());
  EXPECT_GT(block.layout.arrays_size(), 450'000);
  EXPECT_EQ(static_cast<std::uint32_t>(block.layout.arrays_size()), block.layout.array_count());
  EXPECT_EQ(block.layout.sha256(), digest::Sha256().add(block.bytes).finish());
  EXPECT_FALSE(doubles(block, "loads/999/traces/89/jump").empty());
}

TEST(Job, ReadsItsMeshInChunksFromAnyOffset) {
  RunningServer server;
  const v1::Mesh mesh = server.settle(server.create(paper_mesh(0.01)).name());
  ASSERT_EQ(mesh.state(), v1::Mesh::STATE_READY);
  EXPECT_EQ(mesh.subdomains_size(), 2);
  EXPECT_EQ(mesh.interfaces_size(), 1);
  EXPECT_GT(mesh.minimum_angle(), 10);

  Received whole;
  ASSERT_TRUE(read_mesh(server, mesh.name(), 0, whole).ok());
  EXPECT_GT(whole.chunks, 1);
  EXPECT_EQ(whole.layout.sha256(), digest::Sha256().add(whole.bytes).finish());
  EXPECT_EQ(doubles(whole, "nodes").size(), 2 * mesh.node_count());

  Received rest;
  ASSERT_TRUE(read_mesh(server, mesh.name(), 1'234'567, rest).ok());
  EXPECT_EQ(rest.bytes, whole.bytes.substr(1'234'567));

  Received nothing;
  ASSERT_TRUE(read_mesh(server, mesh.name(), whole.bytes.size(), nothing).ok());
  EXPECT_TRUE(nothing.bytes.empty());
  EXPECT_EQ(nothing.layout.size(), whole.bytes.size());

  Received beyond;
  expect_error(read_mesh(server, mesh.name(), whole.bytes.size() + 1, beyond),
               grpc::StatusCode::OUT_OF_RANGE, "OFFSET_OUT_OF_RANGE", "offset");
}

TEST(Job, OfTheSameRequestIdIsTheSame) {
  RunningServer server;
  const std::string mesh = server.create(paper_mesh()).name();
  v1::CreateJobRequest request = opening_job(mesh);
  request.set_request_id("123e4567-e89b-12d3-a456-426614174000");
  const std::string first = server.create(request).name();
  EXPECT_EQ(server.create(request).name(), first);
  request.mutable_spec()->mutable_load_cases(0)->set_name("other");
  expect_error(server.try_create(request), grpc::StatusCode::INVALID_ARGUMENT, "REQUEST_ID_REUSED",
               "request_id");
  request.clear_request_id();
  EXPECT_NE(server.create(request).name(), first);
}

TEST(Job, IsCancelledWhileItRuns) {
  RunningServer server;
  const std::string mesh = server.create(paper_mesh()).name();
  const std::string name = server.create(endless_job(mesh)).name();
  Context context;
  const auto reader = server.jobs->WatchJob(&context, named<v1::WatchJobRequest>(name));
  v1::WatchJobResponse event;
  while (reader->Read(&event) && !event.has_samples()) {
  }
  ASSERT_TRUE(event.has_samples());
  EXPECT_TRUE(server.cancel(name).ok());
  while (reader->Read(&event)) {
  }
  EXPECT_TRUE(reader->Finish().ok());
  ASSERT_TRUE(event.has_ended());
  EXPECT_EQ(event.ended().status().state(), v1::JobStatus::STATE_CANCELLED);
  EXPECT_TRUE(server.cancel(name).ok());  // idempotent
  EXPECT_EQ(server.job(name).status().state(), v1::JobStatus::STATE_CANCELLED);
}

TEST(Job, ThatDidNotConvergeSaysWhy) {
  RunningServer server;
  v1::CreateJobRequest request = opening_job(server.create(paper_mesh()).name());
  request.mutable_spec()->mutable_solver()->mutable_uzawa()->set_max_iterations(3);
  const v1::Job job = server.finish(server.create(request).name());
  EXPECT_EQ(job.status().state(), v1::JobStatus::STATE_NOT_CONVERGED);
  EXPECT_FALSE(job.status().has_error());
  EXPECT_EQ(job.status().result_state(), v1::JobStatus::RESULT_STATE_AVAILABLE);
  ASSERT_EQ(job.status().answers_size(), 1);
  EXPECT_EQ(job.status().answers(0).status(), v1::LoadCaseAnswer::STATUS_NOT_CONVERGED);
  EXPECT_EQ(job.status().answers(0).iterations(), 3);
  EXPECT_FALSE(job.status().answers(0).reason().empty());
  EXPECT_FALSE(job.status().answers(0).has_error());
}

TEST(Job, IsDeletedOnceItEnded) {
  RunningServer server;
  const std::string name = server.create(endless_job(server.create(paper_mesh()).name())).name();
  const auto remove = [&] {
    return call(*server.jobs, &Jobs::DeleteJob, named<v1::DeleteJobRequest>(name));
  };
  expect_error(remove(), grpc::StatusCode::FAILED_PRECONDITION, "IN_USE", "");
  Received block;
  expect_error(read_result(server, name, 0, block), grpc::StatusCode::FAILED_PRECONDITION,
               "NOT_READY", "");
  server.cancel(name);
  server.finish(name);
  EXPECT_TRUE(remove().ok());
  expect_error(remove(), grpc::StatusCode::NOT_FOUND, "NOT_FOUND", "");
}

}  // namespace
}  // namespace anticrack::rpc
