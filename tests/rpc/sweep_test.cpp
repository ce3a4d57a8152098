// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps from submission to result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "digest/digest.hpp"
#include "rpc/details.hpp"
#include "rpc/received.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::doubles;
using anticrack::testing::expect_error;
using anticrack::testing::packed;
using anticrack::testing::paper_mesh;
using anticrack::testing::read_result;
using anticrack::testing::Received;
using anticrack::testing::RunningServer;
using anticrack::testing::sweep_job;
using anticrack::testing::values_of;
using ::testing::Each;
using ::testing::ElementsAre;

constexpr double tolerance = 1e-9;
constexpr std::size_t basis = 3;

/// Opening, closing and both, with and without a push.
const std::vector<double> matrix{1,    0,   0,    -1, 0,    0,   0.3, 2, 0,    -0.3, 2,  0.1,
                                 0.01, 1.5, -0.2, 0,  -2.5, 0.4, 0,   0, -0.7, 1,    -1, 1};
constexpr std::size_t row_count = 8;

/// What a watch told of a sweep's row_count, by row.
struct Watched {
  std::vector<int> times = std::vector<int>(row_count, 0);
  std::vector<std::int32_t> status = std::vector<std::int32_t>(row_count, 0);
  std::vector<double> energy = std::vector<double>(row_count, 0);
  std::vector<double> displacement = std::vector<double>(row_count, 0);
  v1::Job ended;
};

Watched watch(RunningServer& server, const std::string& job) {
  Watched told;
  std::vector<v1::WatchJobResponse> events;
  EXPECT_TRUE(server.watch(job, 0, events).ok());
  for (const v1::WatchJobResponse& event : events) {
    if (event.has_ended()) told.ended = event.ended();
    if (!event.has_sweep_rows()) continue;
    const v1::SweepRows& some = event.sweep_rows();
    for (int i = 0; i < some.status_size(); ++i) {
      const std::size_t row = some.first_row() + static_cast<std::size_t>(i);
      if (row >= row_count) {
        ADD_FAILURE() << "row " << row;
        return told;
      }
      ++told.times[row];
      told.status[row] = some.status(i);
      told.energy[row] = some.energy(i);
      told.displacement[row] = some.displacement(i);
    }
  }
  return told;
}

/// That rows are as load cases of their own: jobs/engine_sweep_test.
TEST(Sweep, TellsEveryRowOnceAsTheResultHasIt) {
  RunningServer server;
  const std::string mesh = server.create(paper_mesh()).name();
  v1::CreateJobRequest request = sweep_job(mesh, matrix);
  request.mutable_spec()->mutable_sweep()->add_traces(1);
  request.mutable_spec()->mutable_sweep()->add_traces(6);
  const v1::Job created = server.create(request);
  EXPECT_EQ(created.status().sweep_answer().rows(), row_count);
  EXPECT_EQ(created.spec().sweep().coefficients().sha256(),
            digest::Sha256().add(packed(matrix)).finish());
  const Watched told = watch(server, created.name());

  ASSERT_EQ(told.ended.status().state(), v1::JobStatus::STATE_SUCCEEDED)
      << told.ended.status().error().message();
  EXPECT_EQ(told.ended.status().answers_size(), 0);
  EXPECT_EQ(told.ended.status().sweep_answer().converged(), row_count);
  EXPECT_EQ(told.ended.status().sweep_answer().not_converged() +
                told.ended.status().sweep_answer().failed(),
            0u);
  EXPECT_GT(told.ended.status().sweep_answer().most_steps(), 0);
  EXPECT_LT(told.ended.status().sweep_answer().worst_kkt(), tolerance);
  EXPECT_THAT(told.times, Each(1));
  EXPECT_THAT(told.status, Each(v1::LoadCaseAnswer::STATUS_CONVERGED));

  Received block;
  ASSERT_TRUE(read_result(server, created.name(), 0, block).ok());
  EXPECT_EQ(block.layout.sha256(), digest::Sha256().add(block.bytes).finish());
  EXPECT_EQ(doubles(block, "sweep/energy"), told.energy);
  EXPECT_EQ(doubles(block, "sweep/displacement"), told.displacement);
  EXPECT_EQ(values_of<std::int32_t>(block, "sweep/status", v1::ArrayLayout::TYPE_INT32),
            told.status);
  for (const char* row : {"1", "6"})
    EXPECT_FALSE(doubles(block, std::string("traces/") + row + "/0/jump").empty());
}

TEST(Sweep, OfAnUploadIsTheSame) {
  RunningServer server;
  const std::string mesh = server.create(paper_mesh()).name();
  v1::CreateJobRequest request = sweep_job(mesh, matrix);
  request.set_request_id("123e4567-e89b-12d3-a456-426614174000");
  const v1::Job first = server.create(request);
  const std::string upload = "uploads/" + first.spec().sweep().coefficients().sha256();
  request.mutable_spec()->mutable_sweep()->mutable_coefficients()->set_upload(upload);
  EXPECT_EQ(server.create(request).name(), first.name());
  EXPECT_EQ(server.upload_files(), 1u);
  request.mutable_spec()->mutable_sweep()->mutable_coefficients()->set_packed(packed({1, 2, 3}));
  expect_error(server.try_create(request), grpc::StatusCode::INVALID_ARGUMENT, "REQUEST_ID_REUSED",
               "request_id");
}

}  // namespace
}  // namespace anticrack::rpc
