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

/// What is said comes back from a record: store/record_codec_test.
TEST(JobToDomain, TellsWhatIsSaidFromWhatIsNot) {
  v1::JobSpec job = opening_job("meshes/a").spec();
  job.add_load_cases();
  v1::Uzawa& uzawa = *job.mutable_solver()->mutable_uzawa();
  uzawa.set_theta_auto(true);
  uzawa.set_epsilon(0);
  uzawa.set_p(0);
  const records::JobSpec spec = to_spec(job, limits);
  EXPECT_FALSE(spec.fields);
  EXPECT_FALSE(uzawa_of(spec).theta.has_value());
  EXPECT_EQ(uzawa_of(spec).epsilon, 0);
  EXPECT_EQ(uzawa_of(spec).p, 0);
  EXPECT_EQ(std::get<fem::Expression>(spec.loads[0].force).text, "y > 0 ? 1 : -1");
  EXPECT_EQ(std::get<double>(spec.loads[1].force), 0);
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
