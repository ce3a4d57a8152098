// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps that cannot be: each refused with a clear error that names the field, nothing of it left
// on the disk, the server serving on. One for each way to an error; jobs/sweep_check_test and
// sweep_to_domain_test have all.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "rpc/details.hpp"
#include "rpc/requests.hpp"
#include "rpc/running_server.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::expect_error;
using anticrack::testing::packed;
using anticrack::testing::paper_mesh;
using anticrack::testing::RunningServer;
using anticrack::testing::sweep_job;

struct BadSweep {
  const char* name;
  std::function<void(v1::JobSpec&)> spoil;
  const char* reason;
  const char* field;
  grpc::StatusCode code = grpc::StatusCode::INVALID_ARGUMENT;
  bool matrix_kept = false;  ///< what only the mesh or the length of the matrix can tell
};

v1::Sweep::Matrix& coefficients(v1::JobSpec& job) {
  return *job.mutable_sweep()->mutable_coefficients();
}

const std::vector<BadSweep>& bad_sweeps() {
  static const std::vector<BadSweep> all{
      {"HalfAValue", [](auto& job) { coefficients(job).set_packed("1234"); }, "INVALID_ARGUMENT",
       "spec.sweep.coefficients.packed"},
      {"NotFinite",
       [](auto& job) {
         coefficients(job).set_packed(packed({1, 0, std::numeric_limits<double>::quiet_NaN()}));
       },
       "INVALID_ARGUMENT", "spec.sweep.coefficients.packed"},
      {"UploadUnknown",
       [](auto& job) { coefficients(job).set_upload("uploads/" + std::string(64, '0')); },
       "NOT_FOUND", "spec.sweep.coefficients", grpc::StatusCode::NOT_FOUND},
      {"BasisLargerThanTheLimit", [](auto& job) { job.add_load_cases()->set_name("fourth"); },
       "LIMIT_EXCEEDED", "spec.load_cases"},
      {"Fields", [](auto& job) { job.add_outputs(v1::OUTPUT_FIELDS); }, "INVALID_ARGUMENT",
       "spec.outputs"},
      {"TracesOfARowThatIsNotThere", [](auto& job) { job.mutable_sweep()->add_traces(2); },
       "INVALID_ARGUMENT", "spec.sweep.traces[0]", grpc::StatusCode::INVALID_ARGUMENT, true},
      {"PartOfARow",
       [](auto& job) {
         coefficients(job).set_packed(packed({1, 2, 3, 4}));
       },
       "INVALID_ARGUMENT", "spec.sweep.coefficients", grpc::StatusCode::INVALID_ARGUMENT, true},
      {"MoreRowsThanTheLimit",
       [](auto& job) { coefficients(job).set_packed(packed(std::vector<double>(3 * 101, 1.0))); },
       "LIMIT_EXCEEDED", "spec.sweep.coefficients", grpc::StatusCode::INVALID_ARGUMENT, true},
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
    bad.spoil(*request.mutable_spec());
    expect_error(server.try_create(request), bad.code, bad.reason, bad.field);
    if (bad.matrix_kept) ++kept;
    EXPECT_EQ(server.upload_files(), kept);
  }
  const v1::Job good = server.finish(server.create(sweep_job(mesh, {1, 2, 3})).name());
  EXPECT_EQ(good.status().state(), v1::JobStatus::STATE_SUCCEEDED);
}

}  // namespace
}  // namespace anticrack::rpc
