// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/report.hpp"
#include "cli/submit.hpp"
#include "cli/text.hpp"

namespace anticrack::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

v1::Job sample_job() {
  v1::Job job;
  job.set_name("jobs/1");
  job.mutable_spec()->set_mesh("meshes/2");
  job.mutable_status()->set_state(v1::JobStatus::STATE_SUCCEEDED);
  job.mutable_status()->mutable_create_time()->set_seconds(1'000);
  return job;
}

void add_step(v1::Job& job, std::int64_t seconds, v1::JobStatus::State state,
              const std::string& detail, int attempt = 1) {
  v1::JobStatus::Step& step = *job.mutable_status()->add_timeline();
  step.mutable_time()->set_seconds(seconds);
  step.set_state(state);
  step.set_detail(detail);
  step.set_attempt(attempt);
}

TEST(JobText, TellsWhoseJobItIsAndHowUrgent) {
  v1::Job job = sample_job();
  EXPECT_THAT(job_text(job), HasSubstr("priority normal\n"));
  job.set_owner("ada\x1b[2J");
  job.mutable_spec()->set_priority(v1::JobSpec::PRIORITY_BULK);
  job.mutable_spec()->mutable_run_timeout()->set_seconds(90);
  EXPECT_THAT(job_text(job), HasSubstr("priority bulk, of ada?[2J, runs at most 90 s"));
}

TEST(Shortfalls, AreNoneOfAJobThatSucceeded) { EXPECT_TRUE(shortfalls(sample_job()).empty()); }

TEST(Shortfalls, NameWhatFailedOrDidNotConverge) {
  v1::Job job = sample_job();
  job.mutable_status()->set_state(v1::JobStatus::STATE_NOT_CONVERGED);
  job.mutable_status()->set_not_reached("energy");
  v1::LoadCaseAnswer& slow = *job.mutable_status()->add_answers();
  slow.set_name("slow");
  slow.set_status(v1::LoadCaseAnswer::STATUS_NOT_CONVERGED);
  slow.set_reason("3 iterations");
  v1::LoadCaseAnswer& bad = *job.mutable_status()->add_answers();
  bad.set_name("bad");
  bad.set_status(v1::LoadCaseAnswer::STATUS_FAILED);
  bad.mutable_error()->set_message("f is infinite");
  EXPECT_THAT(shortfalls(job), ElementsAre("slow did not converge: 3 iterations",
                                           "bad failed: f is infinite", "not reached: energy"));
  job.mutable_status()->set_state(v1::JobStatus::STATE_CANCELLED);
  EXPECT_THAT(shortfalls(job), ElementsAre("jobs/1 was cancelled"));
}

TEST(Shortfalls, CountTheRowsOfASweep) {
  v1::Job job = sample_job();
  job.mutable_status()->mutable_sweep_answer()->set_rows(9);
  EXPECT_TRUE(shortfalls(job).empty());
  job.mutable_status()->mutable_sweep_answer()->set_not_converged(2);
  EXPECT_THAT(shortfalls(job), ElementsAre("of 9 rows 2 did not converge, 0 failed"));
}

TEST(JobText, CountsTheRowsOfASweepInPlaceOfAnswers) {
  v1::Job job = sample_job();
  job.mutable_spec()->add_load_cases()->set_name("skew");
  job.mutable_spec()->mutable_sweep()->mutable_coefficients()->set_upload("uploads/1");
  v1::SweepAnswer& answer = *job.mutable_status()->mutable_sweep_answer();
  answer.set_rows(100);
  EXPECT_THAT(job_text(job),
              HasSubstr("sweep of 100 rows: 0 converged, 0 did not converge, 0 failed\n"));
  EXPECT_THAT(job_text(job), Not(HasSubstr("iterations")));
  answer.set_converged(97);
  answer.set_not_converged(2);
  answer.set_failed(1);
  answer.set_most_steps(6);
  answer.set_worst_kkt(2e-13);
  answer.add_warnings("a rough load");
  EXPECT_THAT(job_text(job),
              HasSubstr("sweep of 100 rows: 97 converged, 2 did not converge, 1 failed\n"
                        "at most 6 steps, KKT residuals at most 2e-13\n"
                        "warning: a rough load\n"));
}

TEST(JobText, TellsWhatHappenedWhen) {
  v1::Job job = sample_job();
  add_step(job, 1'000, v1::JobStatus::STATE_QUEUED, "");
  add_step(job, 1'003, v1::JobStatus::STATE_WAITING_FOR_MESH, "meshing");
  EXPECT_THAT(job_text(job), HasSubstr("created " + clock_text(1'000) + "\n"));
  EXPECT_THAT(job_text(job), HasSubstr("\n3        waiting for the mesh (meshing)\n"));
  EXPECT_THAT(job_text(job), Not(HasSubstr("attempt")));
  job.mutable_status()->set_attempt(2);
  add_step(job, 1'010, v1::JobStatus::STATE_RUNNING, "", 2);
  EXPECT_THAT(job_text(job), HasSubstr("attempt 2: the server stopped while it ran"));
  EXPECT_THAT(job_text(job), HasSubstr("\n10       running, attempt 2\n"));
}

TEST(JobText, OfExpiredResultsGivesTheCure) {
  v1::Job job = sample_job();
  job.mutable_status()->set_result_state(v1::JobStatus::RESULT_STATE_EXPIRED);
  EXPECT_THAT(job_text(job), HasSubstr(": done\n")) << "what happened is not forgotten";
  EXPECT_THAT(job_text(job), HasSubstr("run the case again"));
}

TEST(ExitCode, IsThatOfTheEnd) {
  v1::Job job;
  job.mutable_status()->set_state(v1::JobStatus::STATE_SUCCEEDED);
  EXPECT_EQ(exit_code_of(job), exit_ok);
  job.mutable_status()->set_result_state(v1::JobStatus::RESULT_STATE_EXPIRED);
  EXPECT_EQ(exit_code_of(job), exit_ok)
      << "the answers are right whether or not the arrays are left";
  job.mutable_status()->set_state(v1::JobStatus::STATE_NOT_CONVERGED);
  EXPECT_EQ(exit_code_of(job), exit_not_converged);
  job.mutable_status()->mutable_error()->set_message("a load case failed");
  EXPECT_EQ(exit_code_of(job), exit_job_failed);
  for (const auto state : {v1::JobStatus::STATE_FAILED, v1::JobStatus::STATE_CANCELLED}) {
    job.mutable_status()->set_state(state);
    EXPECT_EQ(exit_code_of(job), exit_job_failed);
  }
}

}  // namespace
}  // namespace anticrack::cli
