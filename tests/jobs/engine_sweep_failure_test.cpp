// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps that are refused, or fail.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "jobs/sweep_support.hpp"
#include "support/errors.hpp"
#include "support/flip.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::throws;
using errors::Reason;
using records::JobRecord;
using records::JobState;

TEST(EngineSweepFailure, RefusesAMatrixThatDoesNotFit) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  const auto submit = [&](const std::vector<double>& matrix) {
    test.submit(combinations(mesh, upload(test.backend, matrix)));
  };
  EXPECT_TRUE(throws(
      [&] {
        submit({1, 2, 3, 4});
      },
      Reason::invalid_argument, "sweep.coefficients"));
  EXPECT_TRUE(throws([&] { test.submit(combinations(mesh, std::string(64, 'b'))); },
                     Reason::not_found, "sweep.coefficients"));
  records::JobSpec beyond = combinations(mesh, upload(test.backend, {1, 2, 3}));
  beyond.sweep->traces = {1};
  EXPECT_TRUE(throws([&] { test.submit(beyond); }, Reason::invalid_argument, "sweep.traces[0]"));
  EXPECT_TRUE(test.list().empty());
  EXPECT_EQ(test.engine.metrics().queued_bytes, 0U);
}

TEST(EngineSweepFailure, AnswersTheSameRequestThoughItsMatrixIsGone) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  const records::JobSpec spec = combinations(mesh, upload(test.backend, {1, 2, 3}));
  const std::string id = test.submit(spec, "request");
  test.ended(id);
  ASSERT_EQ(test.backend.store->expire_uploads(records::Clock::time_point::max()), 1U);
  EXPECT_EQ(test.submit(spec, "request"), id);
  EXPECT_TRUE(throws([&] { test.submit(spec); }, Reason::not_found, "sweep.coefficients"));
}

void expect_failed_at(const JobRecord& record, const std::string& field, Reason reason,
                      const std::string& said) {
  EXPECT_EQ(record.state, JobState::failed);
  ASSERT_TRUE(record.error);
  EXPECT_EQ(record.error->reason(), reason);
  ASSERT_EQ(record.error->fields().size(), 1U);
  EXPECT_EQ(record.error->fields()[0].field, field);
  EXPECT_NE(std::string(record.error->what()).find(said), std::string::npos)
      << record.error->what();
}

TEST(EngineSweepFailure, FailsWhereTheNodalForcesAreNotOfTheMesh) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  const std::size_t nodes = node_count(test.backend, mesh);
  const std::string longer = upload(test.backend, std::vector<double>(nodes + 1, 1.0));
  const JobRecord record = test.ended(test.submit(nodal_forces(mesh, longer)));
  expect_failed_at(record, "sweep.nodal_forces", Reason::invalid_argument, std::to_string(nodes));
  EXPECT_FALSE(record.started);
  records::JobSpec beyond =
      nodal_forces(mesh, upload(test.backend, std::vector<double>(nodes, 1.0)));
  beyond.sweep->traces = {0, 1};
  expect_failed_at(test.ended(test.submit(beyond)), "sweep.traces[1]", Reason::invalid_argument,
                   "no row 1");
  EXPECT_EQ(test.engine.metrics().jobs_queued, 0);
  EXPECT_EQ(test.engine.metrics().jobs_running, 0);
}

TEST(EngineSweepFailure, FailsWhereTheMatrixHasChangedOnTheDisk) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  const std::string matrix = upload(test.backend, {1, 2, 3});
  anticrack::testing::flip(test.backend.store->upload_path(matrix, "").value(), 7);
  const JobRecord record = test.ended(test.submit(combinations(mesh, matrix)));
  expect_failed_at(record, "sweep.coefficients", Reason::storage, "upload it again");
}

TEST(EngineSweepFailure, FailsAtAValueThatIsNotFinite) {
  Engine test(one_thread());
  const std::string mesh = test.ready_mesh(mesh_size);
  std::vector<double> matrix = eighths(600 * std::size_t{3});
  matrix[3 * 400 + 2] = std::nan("");
  const std::string id = test.submit(combinations(mesh, upload(test.backend, matrix)));
  const JobRecord record = test.ended(id);
  expect_failed_at(record, "sweep.coefficients", Reason::invalid_argument,
                   "row 400 of the matrix: column 2 is nan");
  // The chunk before had its answers.
  EXPECT_EQ(record.sweep.converged, 256U);
  EXPECT_EQ(record.sweep.failed, 344U);
  const auto status = *array<std::int32_t>(*test.engine.result(id), "sweep/status");
  EXPECT_EQ(std::count(status.begin(), status.end(), converged), 256);
  EXPECT_EQ(std::count(status.begin(), status.end(), failed), 344);

  std::vector<double> forces(2 * node_count(test.backend, mesh), 1.0);
  forces[node_count(test.backend, mesh) + 4] = HUGE_VAL;
  expect_failed_at(test.ended(test.submit(nodal_forces(mesh, upload(test.backend, forces)))),
                   "sweep.nodal_forces", Reason::invalid_argument,
                   "row 1 of the matrix: column 4 is inf");
}

TEST(EngineSweepFailure, FailsWithTheLoadThatCannotBeCondensed) {
  Engine test;
  records::JobSpec spec = combinations(test.ready_mesh(mesh_size), upload(test.backend, {1, 2, 3}));
  spec.loads[1].force = fem::Expression{"sqrt(-1 - x*x)"};
  const JobRecord record = test.ended(test.submit(spec));
  EXPECT_EQ(record.state, JobState::failed);
  ASSERT_TRUE(record.error);
  EXPECT_EQ(record.error->fields().at(0).field.rfind("load_cases[1].force", 0), 0U)
      << record.error->fields()[0].field;
  EXPECT_EQ(record.sweep.failed, 1U);
}

TEST(EngineSweepFailure, IsRefusedWhereItsAnswersWouldBeTooLarge) {
  EngineOptions options;
  options.max_result_bytes = 20'000;
  Engine test(options);
  const std::string mesh = test.ready_mesh(mesh_size);
  const auto run = [&](std::size_t rows) {
    return test.ended(test.submit(combinations(mesh, upload(test.backend, eighths(3 * rows)))));
  };
  EXPECT_EQ(run(10).state, JobState::succeeded);
  const JobRecord record = run(1000);
  expect_failed_at(record, "sweep.coefficients", Reason::limit_exceeded, "split the matrix");
  EXPECT_FALSE(record.started);
}

}  // namespace
}  // namespace anticrack::jobs
