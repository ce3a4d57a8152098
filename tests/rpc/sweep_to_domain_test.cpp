// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "api/requests.hpp"
#include "digest/digest.hpp"
#include "records/job_record.hpp"
#include "rpc/from_domain.hpp"
#include "rpc/refusals.hpp"
#include "rpc/requests.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::packed;
using anticrack::testing::sweep_job;
using api::JobLimits;
using api::max_job_bytes;
using api::max_packed_bytes;
using api::to_spec;
using errors::Reason;
using ::testing::ElementsAre;

constexpr JobLimits sweep_limits{1'000};
const std::string sha256(64, 'c');

v1::JobSpec good_sweep() { return sweep_job("meshes/a", {1, 2, 3}).spec(); }

TEST(SweepToDomain, NamesAPackedMatrixByItsHash) {
  v1::JobSpec job = good_sweep();
  job.mutable_sweep()->add_traces(3);
  job.mutable_sweep()->add_traces(5);
  job.mutable_sweep()->set_bounds(true);
  const records::JobSpec spec = to_spec(job, sweep_limits);
  ASSERT_TRUE(spec.sweep);
  EXPECT_EQ(spec.sweep->cases, records::SweepSpec::Cases::combinations);
  EXPECT_EQ(spec.sweep->upload, digest::Sha256().add(packed({1, 2, 3})).finish());
  EXPECT_THAT(spec.sweep->traces, ElementsAre(3u, 5u));
  EXPECT_TRUE(spec.sweep->bounds);
  EXPECT_FALSE(to_spec(good_sweep(), sweep_limits).sweep->bounds);
  EXPECT_EQ(spec.loads.size(), 3u);
}

TEST(SweepToDomain, TakesNodalForces) {
  v1::JobSpec job = good_sweep();
  job.clear_load_cases();
  job.mutable_sweep()->mutable_nodal_forces()->set_upload("uploads/" + sha256);
  const records::JobSpec spec = to_spec(job, sweep_limits);
  EXPECT_EQ(spec.sweep->cases, records::SweepSpec::Cases::nodal_forces);
  EXPECT_EQ(spec.sweep->upload, sha256);
  EXPECT_TRUE(spec.loads.empty());
}

TEST(SweepToDomain, TakesAMatrixOfAMegabyteInAJobThatWouldBeTooLargeWithoutIt) {
  v1::JobSpec job = good_sweep();
  std::string& matrix = *job.mutable_sweep()->mutable_coefficients()->mutable_packed();
  matrix.assign(max_packed_bytes, '\0');
  job.mutable_load_cases(0)->mutable_force()->set_expression(std::string(1'000, '1'));
  EXPECT_EQ(to_spec(job, sweep_limits).sweep->upload, digest::Sha256().add(matrix).finish());
}

TEST(SweepToDomain, ComesBackAsItWasSent) {
  records::JobRecord record;
  record.spec = to_spec(good_sweep(), sweep_limits);
  const v1::Job told = from_domain(record);
  EXPECT_EQ(told.spec().sweep().coefficients().source_case(), v1::Sweep::Matrix::SOURCE_NOT_SET);
  EXPECT_EQ(told.spec().sweep().coefficients().sha256(),
            digest::Sha256().add(packed({1, 2, 3})).finish());
  EXPECT_EQ(told.spec().load_cases_size(), 3);
}

struct BadSweepMessage {
  const char* name;
  std::function<void(v1::JobSpec&)> spoil;
  Reason reason;
  const char* field;
};

v1::Sweep::Matrix& matrix_of(v1::JobSpec& job) {
  return *job.mutable_sweep()->mutable_coefficients();
}

v1::Sweep::Matrix& nodal_forces(v1::JobSpec& job) {
  job.clear_load_cases();
  return *job.mutable_sweep()->mutable_nodal_forces();
}

TEST(SweepToDomain, RefusesWhatItsTypesCannotExpress) {
  const std::vector<BadSweepMessage> all{
      {"NoCases", [](auto& job) { job.mutable_sweep()->Clear(); }, Reason::invalid_argument,
       "sweep"},
      {"NoSource", [](auto& job) { matrix_of(job).Clear(); }, Reason::invalid_argument,
       "sweep.coefficients"},
      {"NodalNoSource", [](auto& job) { nodal_forces(job).Clear(); }, Reason::invalid_argument,
       "sweep.nodal_forces"},
      {"Empty", [](auto& job) { matrix_of(job).set_packed(""); }, Reason::invalid_argument,
       "sweep.coefficients.packed"},
      {"HalfAValue", [](auto& job) { matrix_of(job).set_packed(std::string(12, '\0')); },
       Reason::invalid_argument, "sweep.coefficients.packed"},
      {"TooLarge",
       [](auto& job) { matrix_of(job).set_packed(std::string(max_packed_bytes + 8, '\0')); },
       Reason::limit_exceeded, "sweep.coefficients.packed"},
      {"NodalHalfAValue", [](auto& job) { nodal_forces(job).set_packed("1234567"); },
       Reason::invalid_argument, "sweep.nodal_forces.packed"},
      {"NoUpload", [](auto& job) { matrix_of(job).set_upload(""); }, Reason::invalid_argument,
       "sweep.coefficients.upload"},
      {"NoHash", [](auto& job) { matrix_of(job).set_upload("uploads/1"); },
       Reason::invalid_argument, "sweep.coefficients.upload"},
      {"AnotherCollection", [](auto& job) { nodal_forces(job).set_upload("meshes/" + sha256); },
       Reason::invalid_argument, "sweep.nodal_forces.upload"},
      {"TooLargeBesidesItsMatrix",
       [](auto& job) {
         job.mutable_load_cases(0)->mutable_force()->set_expression(
             std::string(max_job_bytes, '1'));
       },
       Reason::limit_exceeded, ""},
  };
  for (const BadSweepMessage& bad : all) {
    SCOPED_TRACE(bad.name);
    v1::JobSpec job = good_sweep();
    bad.spoil(job);
    expect_refused([&] { to_spec(job, sweep_limits); }, bad.reason, bad.field);
  }
}

}  // namespace
}  // namespace anticrack::rpc
