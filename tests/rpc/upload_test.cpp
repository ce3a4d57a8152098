// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "rpc/details.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"
#include "store/digest.hpp"
#include "support/eventually.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::Context;
using anticrack::testing::eventually;
using anticrack::testing::expect_error;
using anticrack::testing::RunningServer;
using anticrack::testing::small_msh;

v1::UploadMeshRequest::Header upload_header(const std::string& content) {
  v1::UploadMeshRequest::Header header;
  header.set_size(content.size());
  header.set_sha256(store::Sha256().add(content).finish());
  return header;
}

TEST(Upload, IsKeptUnderItsHash) {
  RunningServer server;
  const std::string content = small_msh();
  std::string name;
  const grpc::Status status = server.upload(content, &name);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(name, "uploads/" + store::Sha256().add(content).finish());
  std::string again;
  EXPECT_TRUE(server.upload(content, &again).ok());
  EXPECT_EQ(again, name);
  EXPECT_EQ(server.upload_files(), 1u);
}

TEST(Upload, OfSeveralMegabytesArrivesWhole) {
  RunningServer server;
  const std::string content = small_msh() + std::string(5'000'000, '\n');
  std::string name;
  const grpc::Status status = server.upload(upload_header(content), content, &name, 1u << 20);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(server.upload_files(), 1u);
}

TEST(Upload, LeavesNothingWhereItIsRefused) {
  RunningServer server([](auto& settings) { settings.server.limits.upload_bytes = 10'000; });
  const std::string content = small_msh();
  v1::UploadMeshRequest::Header header = upload_header(content);
  header.set_size(10'001);
  expect_error(server.upload(header, content), grpc::StatusCode::INVALID_ARGUMENT, "LIMIT_EXCEEDED",
               "header.size");
  header = upload_header(content);
  header.set_sha256(std::string(64, '0'));
  expect_error(server.upload(header, content), grpc::StatusCode::INVALID_ARGUMENT,
               "INVALID_ARGUMENT", "header.sha256");
  header = upload_header(content);
  header.set_size(content.size() - 1);
  expect_error(server.upload(header, content), grpc::StatusCode::INVALID_ARGUMENT,
               "INVALID_ARGUMENT", "header.size");
  EXPECT_TRUE(eventually([&] { return server.upload_files() == 0; }));
  EXPECT_FALSE(server.info().version().empty());
}

TEST(Upload, LeavesNothingWhenItsClientGoes) {
  RunningServer server;
  {
    Context context;
    v1::UploadMeshResponse response;
    const auto writer = server.meshes->UploadMesh(&context, &response);
    v1::UploadMeshRequest request;
    *request.mutable_header() = upload_header(small_msh());
    ASSERT_TRUE(writer->Write(request));
    request.set_chunk("$MeshFormat");
    ASSERT_TRUE(writer->Write(request));
    ASSERT_TRUE(eventually([&] { return server.upload_files() == 1; }));
    context.TryCancel();
    EXPECT_EQ(writer->Finish().error_code(), grpc::StatusCode::CANCELLED);
  }
  EXPECT_TRUE(eventually([&] { return server.upload_files() == 0; }));
}

TEST(Upload, ThatStallsGivesItsPlaceUp) {
  RunningServer server([](auto& settings) {
    settings.server.limits.transfers = 1;
    settings.server.stall = std::chrono::milliseconds(50);
  });
  Context context;
  v1::UploadMeshResponse response;
  const auto writer = server.meshes->UploadMesh(&context, &response);
  EXPECT_EQ(writer->Finish().error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_TRUE(eventually([&] { return server.upload(small_msh()).ok(); }));
}

TEST(Upload, IsRefusedBeyondTheLimitOfTransfers) {
  RunningServer server([](auto& settings) { settings.server.limits.transfers = 1; });
  Context context;
  v1::UploadMeshResponse response;
  const auto writer = server.meshes->UploadMesh(&context, &response);
  v1::UploadMeshRequest request;
  *request.mutable_header() = upload_header(small_msh());
  ASSERT_TRUE(writer->Write(request));
  ASSERT_TRUE(eventually([&] { return server.upload_files() == 1; }));
  expect_error(server.upload(small_msh()), grpc::StatusCode::RESOURCE_EXHAUSTED, "BUSY", "");
  context.TryCancel();
  writer->Finish();
}

TEST(Upload, IsUsedAsWhatItIs) {
  RunningServer server;
  const std::vector<double> values(6, 1.0);
  const std::string bytes(reinterpret_cast<const char*>(values.data()),
                          values.size() * sizeof(double));
  v1::UploadMeshRequest::Header header = upload_header(bytes);
  header.set_content(v1::UploadMeshRequest::CONTENT_ARRAY);
  std::string array;
  ASSERT_TRUE(server.upload(header, bytes, &array).ok());
  v1::CreateMeshRequest mesh;
  mesh.set_upload(array);
  expect_error(server.try_create(mesh), grpc::StatusCode::INVALID_ARGUMENT, "MESH_INVALID",
               "upload");
  std::string msh;
  ASSERT_TRUE(server.upload(small_msh(), &msh).ok());
  v1::CreateJobRequest job =
      anticrack::testing::opening_job(server.create(anticrack::testing::paper_mesh()).name());
  v1::Force& force = *job.mutable_job()->mutable_load_cases(0)->mutable_force();
  force.mutable_array()->set_upload(msh);
  expect_error(server.try_create(job), grpc::StatusCode::INVALID_ARGUMENT, "INVALID_ARGUMENT",
               "job.load_cases[0].force.array");
}

}  // namespace
}  // namespace anticrack::rpc
