// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps that cannot be: each refused with a clear error that names the field, nothing of it left
// on the disk, the server serving on.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "digest/digest.hpp"
#include "rpc/details.hpp"
#include "rpc/people.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::Context;
using anticrack::testing::expect_error;
using anticrack::testing::packed;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;
using anticrack::testing::sweep_job;

struct BadSweep {
  const char* name;
  std::function<void(v1::Job&)> spoil;
  const char* reason;
  const char* field;
  grpc::StatusCode code = grpc::StatusCode::INVALID_ARGUMENT;
  bool matrix_kept = false;  ///< what only the mesh or the length of the matrix can tell
};

v1::Sweep::Matrix& coefficients(v1::Job& job) {
  return *job.mutable_sweep()->mutable_coefficients();
}

const std::vector<BadSweep>& bad_sweeps() {
  static const std::vector<BadSweep> all{
      {"NoCases", [](auto& job) { job.mutable_sweep()->Clear(); }, "INVALID_ARGUMENT", "job.sweep"},
      {"NoSource", [](auto& job) { coefficients(job).Clear(); }, "INVALID_ARGUMENT",
       "job.sweep.coefficients"},
      {"HalfAValue", [](auto& job) { coefficients(job).set_packed("1234"); }, "INVALID_ARGUMENT",
       "job.sweep.coefficients.packed"},
      {"NotFinite",
       [](auto& job) {
         coefficients(job).set_packed(packed({1, 0, std::numeric_limits<double>::quiet_NaN()}));
       },
       "INVALID_ARGUMENT", "job.sweep.coefficients.packed"},
      {"UploadUnknown",
       [](auto& job) { coefficients(job).set_upload("uploads/" + std::string(64, '0')); },
       "NOT_FOUND", "job.sweep.coefficients", grpc::StatusCode::NOT_FOUND},
      {"NoBasis", [](auto& job) { job.clear_load_cases(); }, "INVALID_ARGUMENT", "job.load_cases"},
      {"BasisUnnamed", [](auto& job) { job.mutable_load_cases(1)->clear_name(); },
       "INVALID_ARGUMENT", "job.load_cases[1].name"},
      {"BasisNamedTwice", [](auto& job) { job.mutable_load_cases(1)->set_name("opening"); },
       "INVALID_ARGUMENT", "job.load_cases[1].name"},
      {"BasisLargerThanTheLimit", [](auto& job) { job.add_load_cases()->set_name("fourth"); },
       "LIMIT_EXCEEDED", "job.load_cases"},
      {"NodalWithABasis",
       [](auto& job) { job.mutable_sweep()->mutable_nodal_forces()->set_packed(packed({1})); },
       "INVALID_ARGUMENT", "job.load_cases"},
      {"Fields", [](auto& job) { job.add_outputs(v1::OUTPUT_FIELDS); }, "INVALID_ARGUMENT",
       "job.outputs"},
      {"Uzawa", [](auto& job) { job.mutable_solver()->mutable_uzawa(); }, "INVALID_ARGUMENT",
       "job.solver.uzawa"},
      {"TracesNotAscending",
       [](auto& job) {
         job.mutable_sweep()->add_traces(1);
         job.mutable_sweep()->add_traces(0);
       },
       "INVALID_ARGUMENT", "job.sweep.traces[1]"},
      {"TracesOfARowThatIsNotThere", [](auto& job) { job.mutable_sweep()->add_traces(2); },
       "INVALID_ARGUMENT", "job.sweep.traces[0]", grpc::StatusCode::INVALID_ARGUMENT, true},
      {"PartOfARow",
       [](auto& job) {
         coefficients(job).set_packed(packed({1, 2, 3, 4}));
       },
       "INVALID_ARGUMENT", "job.sweep.coefficients", grpc::StatusCode::INVALID_ARGUMENT, true},
      {"MoreRowsThanTheLimit",
       [](auto& job) { coefficients(job).set_packed(packed(std::vector<double>(3 * 101, 1.0))); },
       "LIMIT_EXCEEDED", "job.sweep.coefficients", grpc::StatusCode::INVALID_ARGUMENT, true},
      {"MeshUnknown", [](auto& job) { job.set_mesh("meshes/0000000000000000"); }, "NOT_FOUND",
       "job.mesh", grpc::StatusCode::NOT_FOUND},
  };
  return all;
}

TEST(BadSweep, IsRefusedAndTheServerServesOn) {
  RunningServer server([](auto& settings) {
    settings.engine.max_sweep_basis = 3;
    settings.engine.max_sweep_rows = 100;
  });
  const std::string mesh = server.create(paper_mesh()).name();
  std::size_t kept = 0;
  for (const BadSweep& bad : bad_sweeps()) {
    SCOPED_TRACE(bad.name);
    v1::CreateJobRequest request = sweep_job(mesh, {1, 2, 3, 4, 5, static_cast<double>(kept)});
    bad.spoil(*request.mutable_job());
    expect_error(server.try_create(request), bad.code, bad.reason, bad.field);
    if (bad.matrix_kept) ++kept;
    EXPECT_EQ(server.upload_files(), kept);
  }
  const v1::Job good = server.finish(server.create(sweep_job(mesh, {1, 2, 3})).name());
  EXPECT_EQ(good.state(), v1::Job::STATE_SUCCEEDED);
}

/// What only the mesh can tell fails the job.
TEST(BadSweep, OverNodesHasAValueForEach) {
  RunningServer server;
  const v1::Mesh mesh = server.settle(server.create(paper_mesh()).name());
  v1::CreateJobRequest request = sweep_job(mesh.name(), {});
  request.mutable_job()->clear_load_cases();
  request.mutable_job()->mutable_sweep()->mutable_nodal_forces()->set_packed(
      packed(std::vector<double>(mesh.node_count() + 1, 1.0)));
  const v1::Job job = server.finish(server.create(request).name());
  EXPECT_EQ(job.state(), v1::Job::STATE_FAILED);
  const grpc::Status status(static_cast<grpc::StatusCode>(job.error().code()),
                            job.error().message(), job.error().SerializeAsString());
  expect_error(status, grpc::StatusCode::INVALID_ARGUMENT, "INVALID_ARGUMENT",
               "sweep.nodal_forces");
}

TEST(BadSweep, OfAnothersUploadIsAsIfItDidNotExist) {
  using anticrack::testing::other_token;
  using anticrack::testing::owner_token;
  RunningServer server(
      [](auto& settings) { settings.server.security.tokens = anticrack::testing::people(); });
  const auto create = [&](const std::string& token, const std::function<void(v1::Job&)>& adjust) {
    Context meshing(token);
    v1::Mesh mesh;
    EXPECT_TRUE(server.meshes->CreateMesh(&meshing, paper_mesh(), &mesh).ok());
    v1::CreateJobRequest request = sweep_job(mesh.name(), {1, 2, 3});
    adjust(*request.mutable_job());
    Context context(token);
    v1::Job job;
    return server.jobs->CreateJob(&context, request, &job);
  };
  const auto by_name = [](v1::Job& job) {
    job.mutable_sweep()->mutable_coefficients()->set_upload(
        "uploads/" + digest::Sha256().add(packed({1, 2, 3})).finish());
  };
  EXPECT_TRUE(create(owner_token, [](v1::Job&) {}).ok());
  EXPECT_TRUE(create(owner_token, by_name).ok());
  expect_error(create(other_token, by_name), grpc::StatusCode::NOT_FOUND, "NOT_FOUND",
               "job.sweep.coefficients");
}

}  // namespace
}  // namespace anticrack::rpc
