// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "rpc/details.hpp"
#include "rpc/pages.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::call;
using anticrack::testing::expect_error;
using anticrack::testing::Jobs;
using anticrack::testing::Meshes;
using anticrack::testing::must;
using anticrack::testing::opening_job;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;

v1::ListJobsResponse list(RunningServer& server, int size, const std::string& token,
                          v1::JobView view = v1::JOB_VIEW_UNSPECIFIED) {
  v1::ListJobsRequest request;
  request.set_view(view);
  request.set_page_size(size);
  request.set_page_token(token);
  return must(*server.jobs, &Jobs::ListJobs, request);
}

TEST(List, PagesThroughJobsNewestFirst) {
  RunningServer server;
  const std::string mesh = server.create(paper_mesh()).name();
  std::vector<std::string> created;
  for (int i = 0; i < 20; ++i) created.push_back(server.create(opening_job(mesh)).name());
  std::vector<std::string> listed;
  std::string token;
  int pages = 0;
  do {
    const v1::ListJobsResponse page = list(server, 19, token);
    EXPECT_LE(page.jobs_size(), 19);
    for (const v1::Job& job : page.jobs()) listed.push_back(job.name());
    token = page.next_page_token();
    ++pages;
  } while (!token.empty());
  EXPECT_EQ(pages, 2);
  EXPECT_EQ(listed, std::vector<std::string>(created.rbegin(), created.rend()));
  EXPECT_EQ(list(server, 20, "").next_page_token(), "");
  EXPECT_EQ(list(server, 0, "").jobs_size(), 20);
}

TEST(List, ClosesAPageBeforeItGrowsTooLargeForAMessage) {
  RunningServer server;
  v1::CreateJobRequest request = opening_job(server.create(paper_mesh()).name());
  for (int i = 0; i < 230; ++i) {
    v1::LoadCase& load = *request.mutable_spec()->add_load_cases();
    load.set_name(std::to_string(i));
    load.mutable_force()->set_expression("1" + std::string(4'000, ' '));
  }
  std::vector<std::string> names;
  for (int i = 0; i < 5; ++i) {
    names.push_back(server.create(request).name());
    server.cancel(names.back());
    server.finish(names.back());
  }
  const v1::ListJobsResponse basic = list(server, 5, "");
  ASSERT_EQ(basic.jobs_size(), 5);
  EXPECT_EQ(basic.jobs(0).status().load_case_count(), request.spec().load_cases_size());
  EXPECT_EQ(basic.jobs(0).status().load_cases_ended(), request.spec().load_cases_size());
  EXPECT_LT(basic.ByteSizeLong(), 5u << 10);
  const v1::ListJobsResponse first = list(server, 5, "", v1::JOB_VIEW_FULL);
  EXPECT_LT(first.jobs_size(), 5);
  EXPECT_LT(first.ByteSizeLong(), 4u << 20);
  const v1::ListJobsResponse second = list(server, 5, first.next_page_token(), v1::JOB_VIEW_FULL);
  EXPECT_EQ(first.jobs_size() + second.jobs_size(), 5);
}

TEST(List, IsFilteredByStateAndMeshInEitherOrder) {
  RunningServer server;
  const std::string mesh = server.create(paper_mesh()).name();
  const std::string other = server.create(paper_mesh(0.3)).name();
  std::vector<std::string> names;
  for (const std::string& on : {mesh, other, mesh, mesh})
    names.push_back(server.finish(server.create(opening_job(on)).name()).name());
  const auto listed = [&](auto&& choose) {
    v1::ListJobsRequest request;
    choose(request);
    request.set_page_size(2);
    std::vector<std::string> found;
    do {
      const v1::ListJobsResponse page = must(*server.jobs, &Jobs::ListJobs, request);
      EXPECT_LE(page.jobs_size(), 2);
      for (const v1::Job& job : page.jobs()) found.push_back(job.name());
      request.set_page_token(page.next_page_token());
    } while (!request.page_token().empty());
    return found;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(listed([&](auto& request) { request.set_mesh(mesh); }),
            (Names{names[3], names[2], names[0]}));
  EXPECT_EQ(listed([&](auto& request) { request.set_oldest_first(true); }), names);
  EXPECT_EQ(listed([&](auto& request) {
              request.set_mesh(other);
              request.add_states(v1::JobStatus::STATE_FAILED);
              request.add_states(v1::JobStatus::STATE_SUCCEEDED);
            }),
            Names{names[1]});
  EXPECT_EQ(listed([&](auto& request) { request.add_states(v1::JobStatus::STATE_RUNNING); }),
            Names{});

  v1::ListJobsRequest request;
  request.set_mesh("jobs/0123456789abcdef");
  expect_error(call(*server.jobs, &Jobs::ListJobs, request), grpc::StatusCode::INVALID_ARGUMENT,
               "INVALID_ARGUMENT", "mesh");
}

TEST(List, ClosesAPageOfFewThatFit) {
  struct Record {
    std::string id;
  };
  std::size_t read = 0;
  const auto page = [&](const std::string& token) {
    read = 0;
    return fill_page(
        to_page(50, token),
        [&](const std::string& after, std::size_t count) {
          const std::size_t first = after.empty() ? 0 : std::stoul(after) + 1;
          std::vector<Record> records;
          for (std::size_t i = first; i < std::min<std::size_t>(first + count, 1'500); ++i)
            records.push_back({std::to_string(i)});
          return records;
        },
        [&](const Record&) -> std::size_t { return ++read, 0; });
  };
  EXPECT_EQ(page(""), "999");
  EXPECT_EQ(read, max_page_records);
  EXPECT_EQ(page("999"), "");
  EXPECT_EQ(read, 500U);
}

TEST(List, RefusesPagesThereAreNot) {
  RunningServer server;
  v1::ListJobsRequest request;
  request.set_page_size(1001);
  expect_error(call(*server.jobs, &Jobs::ListJobs, request), grpc::StatusCode::INVALID_ARGUMENT,
               "INVALID_ARGUMENT", "page_size");
  request.set_page_size(10);
  request.set_page_token("deadbeef");
  expect_error(call(*server.jobs, &Jobs::ListJobs, request), grpc::StatusCode::INVALID_ARGUMENT,
               "INVALID_ARGUMENT", "page_token");
  v1::ListMeshesRequest mesh_request;
  mesh_request.set_page_size(-1);
  expect_error(call(*server.meshes, &Meshes::ListMeshes, mesh_request),
               grpc::StatusCode::INVALID_ARGUMENT, "INVALID_ARGUMENT", "page_size");
}

TEST(List, ShowsMeshes) {
  RunningServer server;
  const std::string a = server.create(paper_mesh(0.2)).name();
  const std::string b = server.create(paper_mesh(0.3)).name();
  EXPECT_EQ(server.create(paper_mesh(0.2)).name(), a);  // the same content is the same mesh
  const v1::ListMeshesResponse response = must(*server.meshes, &Meshes::ListMeshes, {});
  ASSERT_EQ(response.meshes_size(), 2);
  EXPECT_EQ(response.meshes(0).name(), b);
  EXPECT_EQ(response.meshes(1).name(), a);
  EXPECT_EQ(response.meshes(1).source_case(), v1::Mesh::SOURCE_NOT_SET);

  const v1::Mesh mesh = server.mesh(a);
  v1::CreateMeshRequest again;
  *again.mutable_geometry() = mesh.geometry();
  *again.mutable_options() = mesh.options();
  EXPECT_EQ(again.options().size(), 0.2);
  EXPECT_FALSE(again.options().has_grading());
  EXPECT_EQ(server.create(again).name(), a);
}

}  // namespace
}  // namespace anticrack::rpc
