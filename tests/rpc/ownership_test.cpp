// SPDX-License-Identifier: GPL-3.0-or-later
//
// What belongs to whom, beyond the codes of the permissions table.
#include <gtest/gtest.h>

#include "rpc/details.hpp"
#include "rpc/people.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::admin_token;
using anticrack::testing::Context;
using anticrack::testing::expect_error;
using anticrack::testing::opening_job;
using anticrack::testing::other_token;
using anticrack::testing::owner_token;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;
using anticrack::testing::small_msh;

class Ownership : public ::testing::Test {
 protected:
  v1::Mesh create_mesh(const std::string& token) {
    Context context(token);
    v1::Mesh mesh;
    const grpc::Status status = server.meshes->CreateMesh(&context, paper_mesh(), &mesh);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return mesh;
  }
  grpc::Status create_job(const std::string& token, const v1::CreateJobRequest& request,
                          v1::Job& job) {
    Context context(token);
    return server.jobs->CreateJob(&context, request, &job);
  }
  grpc::Status get_job(const std::string& token, const std::string& name) {
    Context context(token);
    v1::GetJobRequest request;
    request.set_name(name);
    v1::Job job;
    return server.jobs->GetJob(&context, request, &job);
  }
  std::vector<std::string> list_jobs(const std::string& token) {
    Context context(token);
    v1::ListJobsResponse response;
    EXPECT_TRUE(server.jobs->ListJobs(&context, {}, &response).ok());
    std::vector<std::string> names;
    for (const v1::Job& job : response.jobs()) names.push_back(job.name());
    return names;
  }
  int count_meshes(const std::string& token) {
    Context context(token);
    v1::ListMeshesResponse response;
    EXPECT_TRUE(server.meshes->ListMeshes(&context, {}, &response).ok());
    return response.meshes_size();
  }

  RunningServer server{
      [](auto& settings) { settings.server.security.tokens = anticrack::testing::people(); }};
};

TEST_F(Ownership, EqualMeshesOfTwoAreTwo) {
  const v1::Mesh ours = create_mesh(owner_token);
  const v1::Mesh theirs = create_mesh(other_token);
  EXPECT_EQ(ours.owner(), "ada");
  EXPECT_EQ(theirs.owner(), "bob");
  EXPECT_NE(ours.name(), theirs.name());
  EXPECT_EQ(create_mesh(owner_token).name(), ours.name());
  EXPECT_EQ(count_meshes(owner_token), 1);
  EXPECT_EQ(count_meshes(other_token), 1);
  EXPECT_EQ(count_meshes(admin_token), 2);
}

TEST_F(Ownership, ListsShowOnesOwn) {
  v1::Job ours, theirs;
  ASSERT_TRUE(create_job(owner_token, opening_job(create_mesh(owner_token).name()), ours).ok());
  ASSERT_TRUE(create_job(other_token, opening_job(create_mesh(other_token).name()), theirs).ok());
  EXPECT_EQ(ours.owner(), "ada");
  EXPECT_EQ(list_jobs(owner_token), std::vector<std::string>{ours.name()});
  EXPECT_EQ(list_jobs(other_token), std::vector<std::string>{theirs.name()});
  EXPECT_EQ(list_jobs(admin_token), (std::vector<std::string>{theirs.name(), ours.name()}));
}

TEST_F(Ownership, AdministratorsListWhatIsOfOneOwner) {
  v1::Job ours, theirs;
  ASSERT_TRUE(create_job(owner_token, opening_job(create_mesh(owner_token).name()), ours).ok());
  ASSERT_TRUE(create_job(other_token, opening_job(create_mesh(other_token).name()), theirs).ok());
  const auto list = [&](const std::string& token, const std::string& owner, auto& response) {
    Context context(token);
    if constexpr (std::is_same_v<decltype(response), v1::ListJobsResponse&>) {
      v1::ListJobsRequest request;
      request.set_owner(owner);
      return server.jobs->ListJobs(&context, request, &response).error_code();
    } else {
      v1::ListMeshesRequest request;
      request.set_owner(owner);
      return server.meshes->ListMeshes(&context, request, &response).error_code();
    }
  };
  for (const std::string& token : {admin_token, other_token}) {
    v1::ListJobsResponse jobs;
    EXPECT_EQ(list(token, "bob", jobs), grpc::StatusCode::OK);
    ASSERT_EQ(jobs.jobs_size(), 1);
    EXPECT_EQ(jobs.jobs(0).name(), theirs.name());
    v1::ListMeshesResponse meshes;
    EXPECT_EQ(list(token, "bob", meshes), grpc::StatusCode::OK);
    ASSERT_EQ(meshes.meshes_size(), 1);
    EXPECT_EQ(meshes.meshes(0).owner(), "bob");
  }
  v1::ListJobsResponse jobs;
  EXPECT_EQ(list(admin_token, "nobody", jobs), grpc::StatusCode::OK);
  EXPECT_EQ(jobs.jobs_size(), 0);
  EXPECT_EQ(list(owner_token, "bob", jobs), grpc::StatusCode::PERMISSION_DENIED);
  EXPECT_EQ(list(owner_token, "nobody", jobs), grpc::StatusCode::PERMISSION_DENIED);
}

TEST_F(Ownership, AnothersJobIsAsIfItDidNotExist) {
  v1::Job job;
  ASSERT_TRUE(create_job(owner_token, opening_job(create_mesh(owner_token).name()), job).ok());
  const grpc::Status hidden = get_job(other_token, job.name());
  std::string missing = job.name();
  missing.back() = missing.back() == '0' ? '1' : '0';
  const grpc::Status absent = get_job(other_token, missing);
  std::string expected = absent.error_message();
  expected.replace(expected.find(missing), missing.size(), job.name());
  EXPECT_EQ(hidden.error_code(), absent.error_code());
  EXPECT_EQ(hidden.error_message(), expected);
}

TEST_F(Ownership, RequestIdsAreOnesOwn) {
  v1::CreateJobRequest request = opening_job(create_mesh(owner_token).name());
  request.set_request_id("123e4567-e89b-12d3-a456-426614174000");
  v1::Job ours, theirs, again;
  ASSERT_TRUE(create_job(owner_token, request, ours).ok());
  ASSERT_TRUE(create_job(owner_token, request, again).ok());
  EXPECT_EQ(again.name(), ours.name());
  request.mutable_spec()->set_mesh(create_mesh(other_token).name());
  ASSERT_TRUE(create_job(other_token, request, theirs).ok());
  EXPECT_NE(theirs.name(), ours.name());
}

TEST_F(Ownership, UploadsAreOnesOwn) {
  Context context(owner_token);
  v1::CreateUploadsResponse response;
  const auto writer = server.uploads->CreateUploads(&context, &response);
  v1::CreateUploadsRequest part;
  part.mutable_header()->set_size(small_msh().size());
  part.mutable_header()->set_sha256(digest::Sha256().add(small_msh()).finish());
  writer->Write(part);
  part.set_chunk(small_msh());
  writer->Write(part);
  writer->WritesDone();
  ASSERT_TRUE(writer->Finish().ok());
  v1::CreateMeshRequest request;
  request.set_upload(response.uploads(0).name());
  const auto create = [&](const std::string& token) {
    Context call(token);
    v1::Mesh mesh;
    return server.meshes->CreateMesh(&call, request, &mesh);
  };
  expect_error(create(other_token), grpc::StatusCode::NOT_FOUND, "NOT_FOUND", "upload");
  EXPECT_TRUE(create(owner_token).ok());
}

TEST_F(Ownership, ATokenIsSentOnceAsABearer) {
  const auto info = [&](const std::vector<std::string>& values) {
    Context context;
    for (const std::string& value : values) context.AddMetadata("authorization", value);
    v1::ServerInfo answer;
    return server.servers->GetServerInfo(&context, {}, &answer).error_code();
  };
  EXPECT_EQ(info({"Bearer " + owner_token}), grpc::StatusCode::OK);
  EXPECT_EQ(info({"bearer " + owner_token}), grpc::StatusCode::OK);
  for (const auto& wrong :
       std::vector<std::vector<std::string>>{{owner_token},
                                             {"Basic " + owner_token},
                                             {"Bearer"},
                                             {"Bearer "},
                                             {"Bearer " + owner_token + "x"},
                                             {"Bearer " + owner_token, "Bearer " + other_token}}) {
    EXPECT_EQ(info(wrong), grpc::StatusCode::UNAUTHENTICATED) << wrong.front();
  }
}

TEST(OwnershipWithoutTokens, NobodyIsAskedAndEverybodyMay) {
  RunningServer server;
  const v1::Mesh mesh = server.create(paper_mesh());
  EXPECT_EQ(mesh.owner(), "");
  EXPECT_EQ(server.create(opening_job(mesh.name())).owner(), "");
  Context context("whatever");  // asked by nobody, read by nobody
  v1::ServerInfo info;
  EXPECT_TRUE(server.servers->GetServerInfo(&context, {}, &info).ok());
}

}  // namespace
}  // namespace anticrack::rpc
