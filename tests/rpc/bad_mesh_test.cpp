// SPDX-License-Identifier: GPL-3.0-or-later
//
// Geometries and files that cannot become a mesh: each refused with a clear error that names the
// field, the server serving on. One for each way to an error; tests/mesh and mesh_to_domain_test
// have all.
#include <gtest/gtest.h>

#include <functional>

#include "rpc/details.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::details_of;
using anticrack::testing::expect_error;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;
using anticrack::testing::small_msh;

struct BadMesh {
  const char* name;
  std::function<void(v1::CreateMeshRequest&)> spoil;
  const char* reason;
  const char* field;
  grpc::StatusCode code = grpc::StatusCode::INVALID_ARGUMENT;
};

v1::Geometry& geometry(v1::CreateMeshRequest& request) { return *request.mutable_geometry(); }

void move(v1::Point& point, double x, double y) {
  point.set_x(x);
  point.set_y(y);
}

v1::InterfacePart& part(v1::CreateMeshRequest& request) {
  return *geometry(request).mutable_inclusions(0)->mutable_part();
}

const std::vector<BadMesh>& bad_meshes() {
  static const std::vector<BadMesh> all{
      {"SelfCrossingBoundary",
       [](auto& request) { geometry(request).mutable_boundary()->SwapElements(1, 2); },
       "GEOMETRY_INVALID", "geometry.boundary"},
      {"InclusionOffTheInterface",
       [](auto& request) { move(*part(request).mutable_from(), 0, 0.1); }, "GEOMETRY_INVALID",
       "geometry.inclusions[0].part.from"},
      {"NegativeSize", [](auto& request) { request.mutable_options()->set_size(-1); },
       "INVALID_ARGUMENT", "options.size"},
      {"LawNotAboveZero",
       [](v1::CreateMeshRequest& request) {
         v1::Region& region = *request.mutable_geometry()->add_regions();
         region.set_name("top");
         region.mutable_at()->set_y(0.5);
         region.mutable_tension_law()->set_along("y - 0.5");
       },
       "EXPRESSION_INVALID", "geometry.regions[0].tension_law.along"},
      {"MoreTrianglesThanAllowed", [](auto& request) { request.mutable_options()->set_size(1e-3); },
       "LIMIT_EXCEEDED", "options.size"},
      {"NoSource", [](auto& request) { request.clear_source(); }, "INVALID_ARGUMENT", "geometry"},
      {"UploadThatIsNotThere",
       [](auto& request) {
         request.clear_options();
         request.set_upload("uploads/" + std::string(64, '0'));
       },
       "NOT_FOUND", "upload", grpc::StatusCode::NOT_FOUND},
  };
  return all;
}

void PrintTo(const BadMesh& bad, std::ostream* out) { *out << bad.name; }

class BadMeshTest : public ::testing::TestWithParam<BadMesh> {
 protected:
  static void SetUpTestSuite() {
    _server = std::make_unique<RunningServer>(
        [](auto& settings) { settings.catalogue.max_triangles = 10'000; });
  }
  static void TearDownTestSuite() { _server.reset(); }
  static std::unique_ptr<RunningServer> _server;
};

std::unique_ptr<RunningServer> BadMeshTest::_server;

TEST_P(BadMeshTest, IsRefusedAndTheServerServesOn) {
  v1::CreateMeshRequest request = paper_mesh();
  GetParam().spoil(request);
  const grpc::Status status = _server->try_create(request);
  EXPECT_EQ(status.error_code(), GetParam().code) << status.error_message();
  const auto details = details_of(status);
  EXPECT_EQ(details.reason, GetParam().reason) << status.error_message();
  ASSERT_EQ(details.fields.size(), 1u) << status.error_message();
  // A list may be named as a whole or by the element at fault.
  EXPECT_TRUE(details.fields[0].starts_with(GetParam().field)) << details.fields[0];
  const v1::Mesh good = _server->settle(_server->create(paper_mesh()).name());
  EXPECT_EQ(good.state(), v1::Mesh::STATE_READY);
}

INSTANTIATE_TEST_SUITE_P(Each, BadMeshTest, ::testing::ValuesIn(bad_meshes()),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(BadFile, ThatIsNoMshIsRefusedAsItArrives) {
  RunningServer server;
  const std::string garbage("\x00\x01\xfe\xff garbage", 12);
  for (const std::string& content :
       {std::string("SystemCall \"touch nowhere\";\nPoint(1) = {0, 0, 0};\n"), garbage,
        std::string("  \n"), std::string("$meshformat\n")}) {
    expect_error(server.upload(content), grpc::StatusCode::INVALID_ARGUMENT, "MESH_INVALID",
                 "chunk");
  }
  expect_error(server.upload(""), grpc::StatusCode::INVALID_ARGUMENT, "MESH_INVALID",
               "header.size");
  EXPECT_EQ(server.upload_files(), 0u);
  EXPECT_EQ(server.settle(server.create(paper_mesh()).name()).state(), v1::Mesh::STATE_READY);
}

const std::string quads =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
    "$EndNodes\n$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n";

TEST(BadFile, ThatIsAMshButNoMembraneFailsItsMesh) {
  RunningServer server;
  const std::string whole = small_msh();
  const std::string garbage = "$MeshFormat\n4.1 1 8\n" + std::string(5'000, '\xfe');
  for (const std::string& content :
       {quads, garbage, whole.substr(0, whole.size() / 2), std::string("$MeshFormat\n")}) {
    v1::CreateMeshRequest request;
    ASSERT_TRUE(server.upload(content, request.mutable_upload()).ok());
    const v1::Mesh mesh = server.settle(server.create(request).name());
    EXPECT_EQ(mesh.state(), v1::Mesh::STATE_FAILED) << content.substr(0, 200);
    const v1::Status& error = mesh.error();
    const grpc::Status status(static_cast<grpc::StatusCode>(error.code()), error.message(),
                              error.SerializeAsString());
    expect_error(status, grpc::StatusCode::INVALID_ARGUMENT, "MESH_INVALID", "");
  }
  EXPECT_EQ(server.settle(server.create(paper_mesh()).name()).state(), v1::Mesh::STATE_READY);
}

TEST(BadFile, FailsTheJobThatWaitsForIt) {
  RunningServer server;
  v1::CreateMeshRequest request;
  ASSERT_TRUE(server.upload(quads, request.mutable_upload()).ok());
  const std::string mesh = server.create(request).name();
  const v1::Job job = server.finish(server.create(anticrack::testing::opening_job(mesh)).name());
  EXPECT_EQ(job.status().state(), v1::JobStatus::STATE_FAILED);
  EXPECT_EQ(job.status().error().code(), static_cast<int>(grpc::StatusCode::INVALID_ARGUMENT));
}

}  // namespace
}  // namespace anticrack::rpc
