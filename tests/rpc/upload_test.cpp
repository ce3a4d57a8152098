// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <set>

#include "digest/digest.hpp"
#include "rpc/details.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"
#include "support/eventually.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::BegunUpload;
using anticrack::testing::call;
using anticrack::testing::Context;
using anticrack::testing::eventually;
using anticrack::testing::expect_error;
using anticrack::testing::must;
using anticrack::testing::named;
using anticrack::testing::RunningServer;
using anticrack::testing::small_msh;
using anticrack::testing::upload_header;
using anticrack::testing::Uploads;

TEST(Upload, IsKeptUnderItsHash) {
  RunningServer server;
  const std::string content = small_msh();
  std::string name;
  const grpc::Status status = server.upload(content, &name);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(name, "uploads/" + digest::Sha256().add(content).finish());
  std::string again;
  EXPECT_TRUE(server.upload(content, &again).ok());
  EXPECT_EQ(again, name);
  EXPECT_EQ(server.upload_files(), 1u);
}

std::string upload_array(RunningServer& server, const std::vector<double>& values) {
  const std::string bytes = anticrack::testing::packed(values);
  std::string name;
  EXPECT_TRUE(server.upload(upload_header(bytes, v1::Upload::KIND_ARRAY), bytes, &name).ok());
  return name;
}

grpc::Status erase(RunningServer& server, const std::string& name) {
  return call(*server.uploads, &Uploads::DeleteUpload, named<v1::DeleteUploadRequest>(name));
}

TEST(Upload, SaysWhatItIs) {
  RunningServer server([](auto& settings) { settings.engine.upload_ttl = std::chrono::hours(1); });
  v1::GetUploadRequest request;
  ASSERT_TRUE(server.upload(small_msh(), request.mutable_name()).ok());
  v1::Upload upload = must(*server.uploads, &Uploads::GetUpload, request);
  EXPECT_EQ(upload.name(), request.name());
  EXPECT_EQ(upload.kind(), v1::Upload::KIND_MSH);
  EXPECT_EQ(upload.size(), small_msh().size());
  EXPECT_EQ(upload.expire_time().seconds() - upload.create_time().seconds(), 3600);
  request.set_name(upload_array(server, {1.5}));
  upload = must(*server.uploads, &Uploads::GetUpload, request);
  EXPECT_EQ(upload.kind(), v1::Upload::KIND_ARRAY);
  EXPECT_EQ(upload.size(), sizeof(double));
}

TEST(Upload, IsListedByNameInPages) {
  RunningServer server;
  std::set<std::string> expected;
  for (const double value : {1., 2., 3., 4., 5.}) expected.insert(upload_array(server, {value}));
  std::vector<std::string> names;
  v1::ListUploadsRequest request;
  request.set_page_size(2);
  do {
    const v1::ListUploadsResponse response = must(*server.uploads, &Uploads::ListUploads, request);
    EXPECT_LE(response.uploads_size(), 2);
    for (const v1::Upload& upload : response.uploads()) names.push_back(upload.name());
    request.set_page_token(response.next_page_token());
  } while (!request.page_token().empty());
  EXPECT_EQ(names, std::vector<std::string>(expected.begin(), expected.end()));
}

TEST(Upload, IsDeletedUnlessSomethingNeedsIt) {
  RunningServer server;
  const v1::Mesh mesh = server.settle(server.create(anticrack::testing::paper_mesh()).name());
  const std::string name = upload_array(server, std::vector<double>(mesh.node_count(), 1.0));
  v1::CreateJobRequest request = anticrack::testing::endless_job(mesh.name());
  v1::Force& force = *request.mutable_spec()->mutable_load_cases(0)->mutable_force();
  force.mutable_array()->set_upload(name);
  const std::string job = server.create(request).name();
  expect_error(erase(server, name), grpc::StatusCode::FAILED_PRECONDITION, "IN_USE", "");
  EXPECT_TRUE(server.cancel(job).ok());
  EXPECT_TRUE(eventually([&] { return erase(server, name).ok(); }));
  EXPECT_EQ(server.upload_files(), 0u);
  expect_error(erase(server, name), grpc::StatusCode::NOT_FOUND, "NOT_FOUND", "");
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
  v1::CreateUploadsRequest::Header header = upload_header(content);
  header.set_size(10'001);
  expect_error(server.upload(header, content), grpc::StatusCode::INVALID_ARGUMENT, "LIMIT_EXCEEDED",
               "header.size");
  EXPECT_TRUE(eventually([&] { return server.upload_files() == 0; }));
  EXPECT_FALSE(server.info().version().empty());
}

TEST(Upload, LeavesNothingWhenItsClientGoes) {
  RunningServer server;
  {
    BegunUpload upload(server, upload_header(small_msh()));
    ASSERT_TRUE(upload.send("$MeshFormat"));
    ASSERT_TRUE(eventually([&] { return server.upload_files() == 1; }));
    EXPECT_EQ(upload.drop().error_code(), grpc::StatusCode::CANCELLED);
  }
  EXPECT_TRUE(eventually([&] { return server.upload_files() == 0; }));
}

TEST(Upload, ThatStallsGivesItsPlaceUp) {
  RunningServer server([](auto& settings) {
    settings.server.limits.transfers = 1;
    settings.server.stall = std::chrono::milliseconds(50);
  });
  Context context;
  v1::CreateUploadsResponse response;
  const auto writer = server.uploads->CreateUploads(&context, &response);
  EXPECT_EQ(writer->Finish().error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_TRUE(eventually([&] { return server.upload(small_msh()).ok(); }));
}

TEST(Upload, IsRefusedBeyondTheLimitOfTransfers) {
  RunningServer server([](auto& settings) { settings.server.limits.transfers = 1; });
  BegunUpload upload(server, upload_header(small_msh()));
  ASSERT_TRUE(eventually([&] { return server.upload_files() == 1; }));
  expect_error(server.upload(small_msh()), grpc::StatusCode::RESOURCE_EXHAUSTED, "BUSY", "");
  upload.drop();
}

TEST(Upload, IsUsedAsWhatItIs) {
  RunningServer server;
  v1::CreateMeshRequest mesh;
  mesh.set_upload(upload_array(server, std::vector<double>(6, 1.0)));
  expect_error(server.try_create(mesh), grpc::StatusCode::INVALID_ARGUMENT, "MESH_INVALID",
               "upload");
  std::string msh;
  ASSERT_TRUE(server.upload(small_msh(), &msh).ok());
  v1::CreateJobRequest job =
      anticrack::testing::opening_job(server.create(anticrack::testing::paper_mesh()).name());
  v1::Force& force = *job.mutable_spec()->mutable_load_cases(0)->mutable_force();
  force.mutable_array()->set_upload(msh);
  expect_error(server.try_create(job), grpc::StatusCode::INVALID_ARGUMENT, "INVALID_ARGUMENT",
               "spec.load_cases[0].force.array");
}

}  // namespace
}  // namespace anticrack::rpc
