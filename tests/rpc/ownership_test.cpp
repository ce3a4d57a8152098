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
using anticrack::testing::call;
using anticrack::testing::Context;
using anticrack::testing::expect_error;
using anticrack::testing::Jobs;
using anticrack::testing::Meshes;
using anticrack::testing::must;
using anticrack::testing::named;
using anticrack::testing::opening_job;
using anticrack::testing::other_token;
using anticrack::testing::owner_token;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;
using anticrack::testing::Servers;
using anticrack::testing::small_msh;

class Ownership : public ::testing::Test {
 protected:
  v1::Mesh create_mesh(const std::string& token) {
    return must(*server.meshes, &Meshes::CreateMesh, paper_mesh(), token);
  }
  v1::Job create_job(const std::string& token, const v1::CreateJobRequest& request) {
    return must(*server.jobs, &Jobs::CreateJob, request, token);
  }
  /// The opening on a mesh of their own.
  v1::Job create_job(const std::string& token) {
    return create_job(token, opening_job(create_mesh(token).name()));
  }
  grpc::Status get_job(const std::string& token, const std::string& name) {
    return call(*server.jobs, &Jobs::GetJob, named<v1::GetJobRequest>(name), nullptr, token);
  }
  std::vector<std::string> list_jobs(const std::string& token) {
    std::vector<std::string> names;
    const v1::ListJobsResponse listed = must(*server.jobs, &Jobs::ListJobs, {}, token);
    for (const v1::Job& job : listed.jobs()) names.push_back(job.name());
    return names;
  }
  int count_meshes(const std::string& token) {
    return must(*server.meshes, &Meshes::ListMeshes, {}, token).meshes_size();
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
  const v1::Job ours = create_job(owner_token), theirs = create_job(other_token);
  EXPECT_EQ(ours.owner(), "ada");
  EXPECT_EQ(list_jobs(owner_token), std::vector<std::string>{ours.name()});
  EXPECT_EQ(list_jobs(other_token), std::vector<std::string>{theirs.name()});
  EXPECT_EQ(list_jobs(admin_token), (std::vector<std::string>{theirs.name(), ours.name()}));
}

TEST_F(Ownership, AdministratorsListWhatIsOfOneOwner) {
  create_job(owner_token);
  const v1::Job theirs = create_job(other_token);
  v1::ListJobsRequest of_jobs;
  v1::ListMeshesRequest of_meshes;
  of_jobs.set_owner("bob");
  of_meshes.set_owner("bob");
  for (const std::string& token : {admin_token, other_token}) {
    const v1::ListJobsResponse jobs = must(*server.jobs, &Jobs::ListJobs, of_jobs, token);
    ASSERT_EQ(jobs.jobs_size(), 1);
    EXPECT_EQ(jobs.jobs(0).name(), theirs.name());
    const v1::ListMeshesResponse meshes =
        must(*server.meshes, &Meshes::ListMeshes, of_meshes, token);
    ASSERT_EQ(meshes.meshes_size(), 1);
    EXPECT_EQ(meshes.meshes(0).owner(), "bob");
  }
  const auto code_for_owner = [&] {
    return call(*server.jobs, &Jobs::ListJobs, of_jobs, nullptr, owner_token).error_code();
  };
  EXPECT_EQ(code_for_owner(), grpc::StatusCode::PERMISSION_DENIED);
  of_jobs.set_owner("nobody");
  EXPECT_EQ(code_for_owner(), grpc::StatusCode::PERMISSION_DENIED);
  EXPECT_EQ(must(*server.jobs, &Jobs::ListJobs, of_jobs, admin_token).jobs_size(), 0);
}

TEST_F(Ownership, AnothersJobIsAsIfItDidNotExist) {
  const v1::Job job = create_job(owner_token);
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
  const v1::Job ours = create_job(owner_token, request);
  EXPECT_EQ(create_job(owner_token, request).name(), ours.name());
  request.mutable_spec()->set_mesh(create_mesh(other_token).name());
  EXPECT_NE(create_job(other_token, request).name(), ours.name());
}

TEST_F(Ownership, UploadsAreOnesOwn) {
  v1::CreateMeshRequest request;
  ASSERT_TRUE(server
                  .upload(anticrack::testing::upload_header(small_msh()), small_msh(),
                          request.mutable_upload(), 1000, owner_token)
                  .ok());
  const auto create = [&](const std::string& token) {
    return call(*server.meshes, &Meshes::CreateMesh, request, nullptr, token);
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
  must(*server.servers, &Servers::GetServerInfo, {}, "whatever");  // which nobody reads
}

}  // namespace
}  // namespace anticrack::rpc
