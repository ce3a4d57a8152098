// SPDX-License-Identifier: GPL-3.0-or-later
//
// Jobs that cannot be: each refused with a clear error that names the field, the server serving on.
// One for each way to an error; fem/load_test, contact/options_test and jobs/check_test have all.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "rpc/details.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::expect_error;
using anticrack::testing::opening_job;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;

struct BadJob {
  const char* name;
  std::function<void(v1::JobSpec&)> spoil;
  const char* reason;
  const char* field;
  grpc::StatusCode code = grpc::StatusCode::INVALID_ARGUMENT;
};

v1::Uzawa& uzawa(v1::JobSpec& job) { return *job.mutable_solver()->mutable_uzawa(); }

v1::Force& force(v1::JobSpec& job) { return *job.mutable_load_cases(0)->mutable_force(); }

const std::vector<BadJob>& bad_jobs() {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  static const std::vector<BadJob> all{
      {"ExpressionWithASyntaxError", [](auto& job) { force(job).set_expression("x + * y"); },
       "EXPRESSION_INVALID", "spec.load_cases[0].force.expression"},
      {"ConstantNan", [](auto& job) { force(job).set_constant(nan); }, "INVALID_ARGUMENT",
       "spec.load_cases[0].force.constant"},
      {"NoLoadCase", [](auto& job) { job.clear_load_cases(); }, "INVALID_ARGUMENT",
       "spec.load_cases"},
      {"ThetaZero", [](auto& job) { uzawa(job).set_theta(0); }, "INVALID_ARGUMENT",
       "spec.solver.uzawa.theta"},
      {"TitleTooLong", [](auto& job) { job.set_title(std::string(201, 't')); }, "LIMIT_EXCEEDED",
       "spec.title"},
      {"MeshUnnamed", [](auto& job) { job.clear_mesh(); }, "INVALID_ARGUMENT", "spec.mesh"},
      {"MeshUnknown", [](auto& job) { job.set_mesh("meshes/0000000000000000"); }, "NOT_FOUND",
       "spec.mesh", grpc::StatusCode::NOT_FOUND},
      {"ArrayUnnamed", [](auto& job) { force(job).mutable_array(); }, "INVALID_ARGUMENT",
       "spec.load_cases[0].force.array.upload"},
      {"ArrayUnknown",
       [](auto& job) { force(job).mutable_array()->set_upload("uploads/" + std::string(64, '0')); },
       "NOT_FOUND", "spec.load_cases[0].force.array", grpc::StatusCode::NOT_FOUND},
      {"PointForceNowhere", [](auto& job) { job.mutable_load_cases(0)->add_point_forces(); },
       "INVALID_ARGUMENT", "spec.load_cases[0].point_forces[0].at"},
      {"RegionUnknown",
       [](auto& job) {
         auto& force = *job.mutable_load_cases(0)->mutable_force();
         (*force.mutable_per_region()->mutable_values())["left"] = 1;
       },
       "INVALID_ARGUMENT", "spec.load_cases[0].force.per_region[left]"},
      {"InclusionUnknown",
       [](auto& job) { (*job.mutable_load_cases(0)->mutable_inclusion_forces())["rod"] = 1; },
       "INVALID_ARGUMENT", "spec.load_cases[0].inclusion_forces[rod]"},
  };
  return all;
}

void PrintTo(const BadJob& bad, std::ostream* out) { *out << bad.name; }

/// One server for all: each bad job is followed by a good one.
class BadJobTest : public ::testing::TestWithParam<BadJob> {
 protected:
  static void SetUpTestSuite() { _server = std::make_unique<RunningServer>(); }
  static void TearDownTestSuite() { _server.reset(); }
  static std::unique_ptr<RunningServer> _server;
};

std::unique_ptr<RunningServer> BadJobTest::_server;

TEST_P(BadJobTest, IsRefusedAndTheServerServesOn) {
  const std::string mesh = _server->create(paper_mesh()).name();
  v1::CreateJobRequest request = opening_job(mesh);
  GetParam().spoil(*request.mutable_spec());
  expect_error(_server->try_create(request), GetParam().code, GetParam().reason, GetParam().field);
  const v1::Job good = _server->finish(_server->create(opening_job(mesh)).name());
  EXPECT_EQ(good.status().state(), v1::JobStatus::STATE_SUCCEEDED);
}

INSTANTIATE_TEST_SUITE_P(Each, BadJobTest, ::testing::ValuesIn(bad_jobs()),
                         [](const auto& bad) { return std::string(bad.param.name); });

struct BadLoad {
  const char* name;
  std::function<void(v1::LoadCase&)> spoil;
  const char* reason;
  const char* field;
  const char* told;  ///< a part of the message
};

/// What only the mesh can tell: the load case fails, the others are solved.
const std::vector<BadLoad>& bad_loads() {
  static const std::vector<BadLoad> all{
      {"ForceNotFinite", [](auto& load) { load.mutable_force()->set_expression("sqrt(x - 5)"); },
       "EXPRESSION_INVALID", "load_cases[1].force.expression", "nan at (x, y)"},
      {"PointOutside", [](auto& load) { load.add_point_forces()->mutable_at()->set_x(1.5); },
       "INVALID_ARGUMENT", "load_cases[1].point_forces[0].at", "(1.5, 0) is outside"},
  };
  return all;
}

TEST(BadJob, ThatOnlyTheMeshCanTellFailsItsLoadCaseAlone) {
  RunningServer server;
  const std::string mesh = server.create(paper_mesh()).name();
  for (const BadLoad& bad : bad_loads()) {
    SCOPED_TRACE(bad.name);
    v1::CreateJobRequest request = opening_job(mesh);
    v1::LoadCase& load = *request.mutable_spec()->add_load_cases();
    load.set_name("bad");
    bad.spoil(load);
    const v1::Job job = server.finish(server.create(request).name());
    ASSERT_EQ(job.status().answers_size(), 2);
    EXPECT_EQ(job.status().answers(0).status(), v1::LoadCaseAnswer::STATUS_CONVERGED);
    EXPECT_EQ(job.status().answers(1).status(), v1::LoadCaseAnswer::STATUS_FAILED);
    const v1::Status& error = job.status().answers(1).error();
    EXPECT_NE(error.message().find(bad.told), std::string::npos) << error.message();
    const grpc::Status status(static_cast<grpc::StatusCode>(error.code()), error.message(),
                              error.SerializeAsString());
    expect_error(status, grpc::StatusCode::INVALID_ARGUMENT, bad.reason, bad.field);
  }
}

TEST(BadJob, LargerThanALimitIsRefusedBeforeItIsRead) {
  RunningServer server([](auto& settings) {
    settings.engine.max_load_cases = 2;
    settings.engine.max_expression_bytes = 10;
    settings.engine.max_iterations = 100;
  });
  const std::string mesh = server.create(paper_mesh()).name();
  v1::CreateJobRequest many = opening_job(mesh);
  many.mutable_spec()->add_load_cases();
  many.mutable_spec()->add_load_cases();
  expect_error(server.try_create(many), grpc::StatusCode::INVALID_ARGUMENT, "LIMIT_EXCEEDED",
               "spec.load_cases");
  v1::CreateJobRequest request = opening_job(mesh);
  force(*request.mutable_spec()).set_expression("1 + 1 + 1 + 1");
  EXPECT_EQ(anticrack::testing::details_of(server.try_create(request)).fields,
            std::vector<std::string>{"spec.load_cases[0].force.expression"});
  force(*request.mutable_spec()).set_constant(1);
  uzawa(*request.mutable_spec()).set_max_iterations(101);
  EXPECT_EQ(anticrack::testing::details_of(server.try_create(request)).fields,
            std::vector<std::string>{"spec.solver.uzawa.max_iterations"});
}

TEST(BadJob, FindsTheQueueFullAndIsToldWhenToComeAgainUnlessItIsKnown) {
  RunningServer server([](auto& settings) {
    settings.engine.threads = 1;
    settings.engine.max_queued_jobs = 1;
  });
  const std::string mesh = server.create(paper_mesh()).name();
  v1::CreateJobRequest known = anticrack::testing::endless_job(mesh);
  known.set_request_id("123e4567-e89b-12d3-a456-426614174000");
  const std::string name = server.create(known).name();
  grpc::Status status;
  for (int i = 0; i < 50 && status.ok(); ++i)
    status = server.try_create(anticrack::testing::endless_job(mesh));
  expect_error(status, grpc::StatusCode::RESOURCE_EXHAUSTED, "BUSY", "");
  EXPECT_GT(anticrack::testing::details_of(status).retry_seconds, 0);
  EXPECT_EQ(server.create(known).name(), name);
}

}  // namespace
}  // namespace anticrack::rpc
