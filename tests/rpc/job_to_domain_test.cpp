// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <functional>

#include "api/requests.hpp"
#include "records/case_record.hpp"
#include "records/job_record.hpp"
#include "rpc/from_domain.hpp"
#include "rpc/refusals.hpp"
#include "rpc/requests.hpp"

namespace anticrack::rpc {
namespace {

using anticrack::testing::opening_job;
using api::JobLimits;
using api::max_job_bytes;
using api::require_request_id;
using api::to_spec;
using errors::Error;
using errors::Reason;

constexpr JobLimits limits{1'000};

void expect_job_refused(const std::function<void(v1::JobSpec&)>& spoil, Reason reason,
                        const std::string& field) {
  v1::JobSpec job = opening_job("meshes/a").spec();
  spoil(job);
  expect_refused([&] { to_spec(job, limits); }, reason, field);
}

contact::UzawaOptions uzawa_of(const records::JobSpec& spec) {
  return std::get<contact::UzawaOptions>(spec.solver);
}

TEST(JobToDomain, TakesTheActiveSetUnlessAskedOtherwise) {
  v1::JobSpec job = opening_job("meshes/a").spec();
  const records::JobSpec spec = to_spec(job, {1'000'000});
  EXPECT_EQ(spec.mesh, "a");
  const auto defaults = std::get<contact::ActiveSetOptions>(spec.solver);
  EXPECT_EQ(defaults.tolerance, contact::ActiveSetOptions().tolerance);
  EXPECT_EQ(defaults.max_steps, contact::ActiveSetOptions().max_steps);
  job.mutable_solver()->mutable_active_set()->set_tolerance(0);
  const auto exact = std::get<contact::ActiveSetOptions>(to_spec(job, {50}).solver);
  EXPECT_EQ(exact.tolerance, 0);
  EXPECT_EQ(exact.max_steps, 50);
  job.mutable_solver()->mutable_active_set()->set_max_steps(7);
  EXPECT_EQ(std::get<contact::ActiveSetOptions>(to_spec(job, limits).solver).max_steps, 7);
}

TEST(JobToDomain, TakesPriorityAndTimes) {
  using std::chrono::milliseconds;
  const JobLimits timed{1'000, milliseconds(60'500), milliseconds(1'000)};
  v1::JobSpec job = opening_job("meshes/a").spec();
  EXPECT_EQ(to_spec(job, timed).priority, records::Priority::normal);
  EXPECT_EQ(to_spec(job, timed).queue_time_limit.count(), 0);
  job.set_priority(v1::JobSpec::PRIORITY_BULK);
  job.mutable_queue_timeout()->set_seconds(60);
  job.mutable_queue_timeout()->set_nanos(500'000'000);
  job.mutable_run_timeout()->set_nanos(1);
  const records::JobSpec spec = to_spec(job, timed);
  EXPECT_EQ(spec.priority, records::Priority::bulk);
  EXPECT_EQ(spec.queue_time_limit, milliseconds(60'500));
  EXPECT_EQ(spec.run_time_limit, milliseconds(1));  // not 0, which is the server's
  job.set_priority(v1::JobSpec::PRIORITY_INTERACTIVE);
  EXPECT_EQ(to_spec(job, timed).priority, records::Priority::interactive);
}

TEST(JobToDomain, RefusesTimesAndPrioritiesThereAreNot) {
  const auto expect = [](const std::function<void(v1::JobSpec&)>& spoil, Reason reason,
                         const std::string& field) {
    v1::JobSpec job = opening_job("meshes/a").spec();
    spoil(job);
    const JobLimits timed{1'000, std::chrono::seconds(60), std::chrono::seconds(60)};
    expect_refused([&] { to_spec(job, timed); }, reason, field);
  };
  expect([](v1::JobSpec& job) { job.set_priority(static_cast<v1::JobSpec::Priority>(9)); },
         Reason::invalid_argument, "priority");
  expect([](v1::JobSpec& job) { job.mutable_queue_timeout()->set_seconds(-1); },
         Reason::invalid_argument, "queue_timeout");
  expect([](v1::JobSpec& job) { job.mutable_run_timeout()->set_nanos(1'000'000'000); },
         Reason::invalid_argument, "run_timeout");
  expect([](v1::JobSpec& job) { job.mutable_queue_timeout(); }, Reason::invalid_argument,
         "queue_timeout");
  expect([](v1::JobSpec& job) { job.mutable_run_timeout()->set_nanos(-1); },
         Reason::invalid_argument, "run_timeout");
  expect([](v1::JobSpec& job) { job.mutable_queue_timeout()->set_seconds(61); },
         Reason::limit_exceeded, "queue_timeout");
  expect([](v1::JobSpec& job) { job.mutable_run_timeout()->set_seconds(INT64_MAX); },
         Reason::limit_exceeded, "run_timeout");
  expect(
      [](v1::JobSpec& job) {
        job.mutable_run_timeout()->set_seconds(60);
        job.mutable_run_timeout()->set_nanos(1);
      },
      Reason::limit_exceeded, "run_timeout");
}

TEST(JobToDomain, TakesTheDefaultsOfThePaper) {
  v1::JobSpec job = opening_job("meshes/a").spec();
  job.mutable_solver()->mutable_uzawa();
  const contact::UzawaOptions uzawa = uzawa_of(to_spec(job, {1'000'000}));
  EXPECT_EQ(uzawa.theta, 2.0);
  EXPECT_EQ(uzawa.epsilon, 1e-12);
  EXPECT_EQ(uzawa.p, 1e5);
  EXPECT_EQ(uzawa.max_iterations, 20'000);
  EXPECT_EQ(uzawa.mass, contact::Mass::lumped);
  EXPECT_FALSE(uzawa.kkt_tolerance);
  EXPECT_EQ(uzawa_of(to_spec(job, limits)).max_iterations, 1'000);
}

TEST(JobToDomain, TakesWhatIsSet) {
  v1::JobSpec job = opening_job("meshes/a").spec();
  job.set_title("t");
  job.add_outputs(v1::OUTPUT_FIELDS);
  v1::Uzawa& uzawa = *job.mutable_solver()->mutable_uzawa();
  uzawa.set_theta_auto(true);
  uzawa.set_epsilon(0);
  uzawa.set_p(0);
  uzawa.set_max_iterations(7);
  uzawa.set_mass(v1::MASS_CONSISTENT);
  uzawa.set_kkt_tolerance(1e-9);
  v1::LoadCase& regions = *job.add_load_cases();
  (*regions.mutable_force()->mutable_per_region()->mutable_values())["plus"] = 3;
  regions.set_boundary_value("x");
  regions.set_traction("y");
  v1::PointForce& point = *regions.add_point_forces();
  point.mutable_at()->set_x(0.5);
  point.mutable_at()->set_y(-0.25);
  point.set_value(4);
  (*regions.mutable_inclusion_forces())["fibre"] = -5;
  job.add_load_cases()->mutable_force()->set_constant(-2);
  job.add_load_cases();
  const std::string sha256(64, 'c');
  v1::Force::Array& array = *job.add_load_cases()->mutable_force()->mutable_array();
  array.set_upload("uploads/" + sha256);
  array.set_per_triangle(true);
  const records::JobSpec spec = to_spec(job, limits);
  EXPECT_TRUE(spec.fields);
  const contact::UzawaOptions options = uzawa_of(spec);
  EXPECT_FALSE(options.theta.has_value());
  EXPECT_EQ(options.epsilon, 0);
  EXPECT_EQ(options.p, 0);
  EXPECT_EQ(options.max_iterations, 7);
  EXPECT_EQ(options.mass, contact::Mass::consistent);
  EXPECT_EQ(options.kkt_tolerance, 1e-9);
  ASSERT_EQ(spec.loads.size(), 5u);
  EXPECT_EQ(std::get<fem::Expression>(spec.loads[0].force).text, "y > 0 ? 1 : -1");
  EXPECT_EQ(std::get<fem::PerRegion>(spec.loads[1].force).values.at("plus"), 3);
  EXPECT_EQ(spec.loads[1].boundary_value, "x");
  EXPECT_EQ(spec.loads[1].traction, "y");
  ASSERT_EQ(spec.loads[1].point_forces.size(), 1u);
  EXPECT_EQ(spec.loads[1].point_forces[0].x, 0.5);
  EXPECT_EQ(spec.loads[1].point_forces[0].y, -0.25);
  EXPECT_EQ(spec.loads[1].point_forces[0].value, 4);
  EXPECT_EQ(spec.loads[1].inclusion_forces.at("fibre"), -5);
  EXPECT_EQ(std::get<double>(spec.loads[2].force), -2);
  EXPECT_EQ(std::get<double>(spec.loads[3].force), 0);
  EXPECT_EQ(std::get<fem::Array>(spec.loads[4].force).upload, sha256);
  EXPECT_TRUE(std::get<fem::Array>(spec.loads[4].force).per_triangle);
  EXPECT_FALSE(std::get<fem::Array>(spec.loads[4].force).values);
}

/// A client reads back what it asked for, defaults filled in.
TEST(JobFromDomain, TellsTheWholeJobAgain) {
  v1::JobSpec job = opening_job("meshes/a").spec();
  job.mutable_solver()->mutable_active_set()->set_tolerance(1e-10);
  job.mutable_solver()->mutable_active_set()->set_max_steps(9);
  v1::LoadCase& load = *job.mutable_load_cases(0);
  load.set_boundary_value("x");
  load.set_traction("y");
  v1::PointForce& point = *load.add_point_forces();
  point.mutable_at()->set_x(0.5);
  point.set_value(4);
  (*load.mutable_inclusion_forces())["fibre"] = -5;
  v1::InclusionMoment& moment = (*load.mutable_inclusion_moments())["fibre"];
  moment.set_x(0.5);
  moment.set_y(-0.25);
  load.mutable_force()->mutable_array()->set_upload("uploads/" + std::string(64, 'c'));
  load.mutable_force()->mutable_array()->set_per_triangle(true);
  records::JobRecord record;
  record.id = "b";
  record.spec = to_spec(job, limits);
  const v1::Job told = from_domain(record);
  EXPECT_EQ(told.spec().solver().SerializeAsString(), job.solver().SerializeAsString());
  EXPECT_EQ(told.spec().load_cases(0).SerializeAsString(), load.SerializeAsString());
  EXPECT_EQ(record.spec.loads[0].inclusion_moments.at("fibre").y, -0.25);

  job.mutable_solver()->mutable_uzawa()->set_kkt_tolerance(1e-9);
  record.spec = to_spec(job, limits);
  EXPECT_EQ(from_domain(record).spec().solver().uzawa().kkt_tolerance(), 1e-9);
}

TEST(AnswerFromDomain, TellsHowAnInclusionTilts) {
  records::CaseRecord record;
  record.status = contact::Status::converged;
  record.answer.inclusions = {{"fibre", 1, 2, 3, 4, 5, 6, 7}};
  const v1::LoadCaseAnswer told = from_domain(record, "a");
  ASSERT_EQ(told.inclusions_size(), 1);
  EXPECT_EQ(told.inclusions(0).contact_length(), 3);
  EXPECT_EQ(told.inclusions(0).slope_x(), 4);
  EXPECT_EQ(told.inclusions(0).slope_y(), 5);
  EXPECT_EQ(told.inclusions(0).moment_x(), 6);
  EXPECT_EQ(told.inclusions(0).moment_y(), 7);
}

TEST(AnswerFromDomain, TellsWarningsAndWhatJustTouches) {
  records::CaseRecord record;
  record.status = contact::Status::converged;
  record.answer.weakly_active = 3;
  record.answer.warnings = {"inexact \xff"};
  const v1::LoadCaseAnswer told = from_domain(record, "a");
  EXPECT_EQ(told.weakly_active(), 3);
  EXPECT_EQ(told.theta(), 0);
  ASSERT_EQ(told.warnings_size(), 1);
  EXPECT_EQ(told.warnings(0), "inexact ?");
}

TEST(JobToDomain, RefusesWhatItsTypesCannotExpress) {
  expect_job_refused([](auto& job) { job.clear_mesh(); }, Reason::invalid_argument, "mesh");
  expect_job_refused([](auto& job) { job.set_title(std::string(201, 't')); },
                     Reason::limit_exceeded, "title");
  expect_job_refused(
      [](auto& job) {
        job.mutable_load_cases(0)->mutable_force()->set_expression(std::string(max_job_bytes, '1'));
      },
      Reason::limit_exceeded, "");
  expect_job_refused([](auto& job) { job.mutable_load_cases(0)->add_point_forces(); },
                     Reason::invalid_argument, "load_cases[0].point_forces[0].at");
  expect_job_refused(
      [](auto& job) {
        job.mutable_load_cases(0)->mutable_force()->mutable_array()->set_upload("uploads/1");
      },
      Reason::invalid_argument, "load_cases[0].force.array.upload");
  expect_job_refused(
      [](auto& job) { job.mutable_solver()->mutable_uzawa()->set_theta_auto(false); },
      Reason::invalid_argument, "solver.uzawa.theta_auto");
  expect_job_refused(
      [](auto& job) { job.mutable_solver()->mutable_uzawa()->set_mass(static_cast<v1::Mass>(9)); },
      Reason::invalid_argument, "solver.uzawa.mass");
}

TEST(JobToDomain, TakesRequestIdsLikeUuids) {
  require_request_id("");
  require_request_id("123e4567-e89b-12d3-a456-426614174000");
  EXPECT_THROW(require_request_id("a b"), Error);
  EXPECT_THROW(require_request_id(std::string(65, 'a')), Error);
}

}  // namespace
}  // namespace anticrack::rpc
