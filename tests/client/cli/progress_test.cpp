// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "client/cli/sample_stages.hpp"

namespace anticrack::cli {
namespace {

TEST(JobProgress, FollowsALoadCaseFromSnapshotToEnd) {
  JobProgress progress;
  progress.apply(snapshot(2));
  ASSERT_EQ(progress.cases.size(), 2U);
  EXPECT_EQ(progress.cases[1].name, "load-1");
  EXPECT_EQ(progress.cases[1].status, v1::LoadCaseAnswer::STATUS_PENDING);

  progress.apply(sample(1, 7, 1e-3, 12));
  EXPECT_EQ(progress.cases[1].status, v1::LoadCaseAnswer::STATUS_RUNNING);
  EXPECT_EQ(progress.cases[1].iteration, 7);
  EXPECT_EQ(progress.cases[1].contact_count, 12);

  progress.apply(load_ended(1, 9, 1e-13));
  EXPECT_EQ(progress.cases[1].status, v1::LoadCaseAnswer::STATUS_CONVERGED);
  EXPECT_EQ(progress.cases[1].iteration, 9);
  EXPECT_DOUBLE_EQ(progress.cases[1].seconds, 0.0125);
  EXPECT_EQ(progress.cases[1].end_rank, 1U);
  EXPECT_EQ(progress.ended_count, 1U);
}

TEST(JobProgress, IsNotSetBackByOldEvents) {
  JobProgress progress;
  progress.apply(snapshot(1));
  progress.apply(sample(0, 7, 1e-3, 12));
  progress.apply(sample(0, 3, 1e-1, 1));
  EXPECT_EQ(progress.cases[0].iteration, 7);
  progress.apply(load_ended(0, 9, 1e-13));
  progress.apply(sample(0, 10, 1e-1, 1));
  progress.apply(load_ended(0, 9, 1e-13));
  EXPECT_EQ(progress.cases[0].status, v1::LoadCaseAnswer::STATUS_CONVERGED);
  EXPECT_EQ(progress.ended_count, 1U);
}

TEST(JobProgress, OfAJobThatHasEndedIsNotRunningAgain) {
  JobProgress progress;
  v1::WatchJobResponse late = snapshot(1);
  late.mutable_snapshot()->mutable_job()->mutable_status()->set_state(
      v1::JobStatus::STATE_SUCCEEDED);
  progress.apply(late);
  v1::WatchJobResponse phase;
  phase.mutable_phase()->set_state(v1::JobStatus::STATE_RUNNING);
  phase.mutable_phase()->set_detail("writing the result");
  progress.apply(phase);
  EXPECT_EQ(progress.state, v1::JobStatus::STATE_SUCCEEDED);
  EXPECT_EQ(progress.detail, "");
}

TEST(JobProgress, BeginsAnewWithAnotherAttempt) {
  JobProgress progress;
  v1::WatchJobResponse first = snapshot(2);
  first.mutable_snapshot()->mutable_job()->mutable_status()->set_attempt(1);
  progress.apply(first);
  progress.apply(sample(0, 7, 1e-3, 12));
  progress.apply(load_ended(1, 9, 1e-13));
  progress.apply(first);
  EXPECT_EQ(progress.cases[0].iteration, 7) << "the same attempt, watched again";

  v1::WatchJobResponse second = snapshot(2);
  second.mutable_snapshot()->mutable_job()->mutable_status()->set_attempt(2);
  progress.apply(second);
  EXPECT_EQ(progress.ended_count, 0U);
  progress.apply(sample(0, 1, 0.5, 1));
  EXPECT_EQ(progress.cases[0].iteration, 1);
}

TEST(JobProgress, TellsThePhaseUntilTheStateChanges) {
  JobProgress progress;
  v1::WatchJobResponse phase;
  phase.mutable_phase()->set_state(v1::JobStatus::STATE_WAITING_FOR_MESH);
  phase.mutable_phase()->set_detail("meshing\x1b[2J");
  progress.apply(phase);
  EXPECT_EQ(progress.state, v1::JobStatus::STATE_WAITING_FOR_MESH);
  EXPECT_EQ(progress.detail, "meshing?[2J");
  progress.apply(snapshot(1));
  EXPECT_EQ(progress.detail, "");
}

TEST(JobProgress, SurvivesNonsense) {
  JobProgress progress;
  progress.apply(snapshot(1));
  progress.apply(sample(5, 1, 1, 1));
  progress.apply(sample(-1, 1, 1, 1));
  progress.apply(load_ended(5, 1, 1));
  progress.apply(load_ended(-1, 1, 1));
  v1::WatchJobResponse ragged = sample(0, 3, 0.5, 1);
  ragged.mutable_samples()->add_load_case(0);
  progress.apply(ragged);
  progress.apply(v1::WatchJobResponse());
  EXPECT_EQ(progress.cases[0].iteration, 3);
  EXPECT_EQ(progress.ended_count, 0U);
}

TEST(JobProgress, ForgetsANoticeWithTheNextEvent) {
  JobProgress progress;
  progress.notice = "no connection";
  progress.apply(snapshot(1));
  EXPECT_EQ(progress.notice, "");
}

TEST(JobProgress, BeginsItsLoadCasesAgainInEachStage) {
  JobProgress progress;
  progress.apply(staged_snapshot(2));
  progress.apply(sample(0, 3, 0, 12));
  progress.apply(load_ended(0, 4, 0));
  progress.apply(load_ended(1, 4, 0));
  progress.apply(stage_ended(stage(1, 900, 0.1, 2)));
  EXPECT_EQ(progress.ended_count, 2U) << "the next stage has not begun";
  ASSERT_EQ(progress.stages.size(), 1U);

  progress.apply(sample(0, 1, 0, 7));
  EXPECT_EQ(progress.ended_count, 0U);
  EXPECT_EQ(progress.cases[0].name, "load-0");
  EXPECT_EQ(progress.cases[0].iteration, 1);
  EXPECT_EQ(progress.cases[1].status, v1::LoadCaseAnswer::STATUS_PENDING);
  progress.apply(load_ended(1, 6, 0, v1::LoadCaseAnswer::STATUS_NOT_CONVERGED));
  progress.apply(load_ended(0, 5, 0));
  EXPECT_EQ(progress.ended_count, 2U);
  EXPECT_EQ(progress.cases[0].iteration, 5) << "the last one counts";
}

/// What a log has of a job of one load case that is in its third stage.
std::vector<v1::WatchJobResponse> three_stages() {
  return {sample(0, 1, 0, 5), load_ended(0, 4, 0), stage_ended(stage(1, 900, 0.1)),
          sample(0, 1, 0, 5), load_ended(0, 5, 0), stage_ended(stage(2, 5000, 0.01)),
          sample(0, 2, 0, 6)};
}

TEST(JobProgress, OfStagesIsTheSameForWhoComesLate) {
  v1::WatchJobResponse late = staged_snapshot(1);
  v1::Job& job = *late.mutable_snapshot()->mutable_job();
  *job.mutable_status()->add_stages() = stage(1, 900, 0.1);
  *job.mutable_status()->add_stages() = stage(2, 5000, 0.01);
  job.mutable_status()->add_stages()->set_mesh("meshes/3");
  const auto events = three_stages();
  // From the earliest event, from one in the middle of a log that was trimmed, and from the last.
  for (std::size_t first = 0; first <= events.size(); ++first) {
    JobProgress progress;
    progress.apply(late);
    for (std::size_t i = first; i < events.size(); ++i) progress.apply(events[i]);
    ASSERT_EQ(progress.stages.size(), 2U) << first;
    EXPECT_EQ(progress.stages[1].triangles(), 5000U);
    EXPECT_EQ(progress.ended_count, 0U) << first;
    EXPECT_EQ(progress.cases[0].iteration, first < events.size() ? 2 : 0) << first;
  }
  // The watch of who lost the connection between two stages goes on as if nothing had been.
  JobProgress resumed;
  resumed.apply(staged_snapshot(1));
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (i == 3) resumed.apply(late);
    resumed.apply(events[i]);
  }
  EXPECT_EQ(resumed.stages.size(), 2U);
  EXPECT_EQ(resumed.cases[0].iteration, 2);
  EXPECT_EQ(resumed.ended_count, 0U);
}

TEST(JobProgress, BetweenStagesKeepsTheAnswersUntilTheNextBegins) {
  v1::WatchJobResponse between = staged_snapshot(1);
  v1::Job& job = *between.mutable_snapshot()->mutable_job();
  *job.mutable_status()->add_stages() = stage(1, 900, 0.1);
  *job.mutable_status()->mutable_answers(0) = load_ended(0, 4, 0).load_cases_ended(0).answer();
  JobProgress progress;
  progress.apply(between);
  EXPECT_EQ(progress.cases[0].status, v1::LoadCaseAnswer::STATUS_CONVERGED);
  progress.apply(sample(0, 1, 0, 5));
  EXPECT_EQ(progress.cases[0].status, v1::LoadCaseAnswer::STATUS_RUNNING);
}

TEST(JobProgress, AfterARestartOfTheServerGoesOnInTheStageItHadReached) {
  JobProgress progress;
  progress.apply(staged_snapshot(1));
  for (const auto& event : three_stages()) progress.apply(event);
  progress.apply(load_ended(0, 3, 0));
  v1::WatchJobResponse again = staged_snapshot(1);
  v1::Job& job = *again.mutable_snapshot()->mutable_job();
  job.mutable_status()->set_attempt(2);
  *job.mutable_status()->add_stages() = stage(1, 900, 0.1);
  *job.mutable_status()->add_stages() = stage(2, 5000, 0.01);
  job.mutable_status()->add_stages()->set_mesh("meshes/3");
  progress.apply(again);
  EXPECT_EQ(progress.stages.size(), 2U);
  EXPECT_EQ(progress.cases[0].status, v1::LoadCaseAnswer::STATUS_PENDING) << "it is solved again";
  progress.apply(load_ended(0, 3, 0));
  progress.apply(stage_ended(stage(3, 20000, 0.001)));
  EXPECT_EQ(progress.stages.size(), 3U);
  EXPECT_EQ(progress.ended_count, 1U);

  v1::WatchJobResponse end;
  v1::Job& ended = *end.mutable_ended() = job;
  *ended.mutable_status()->mutable_stages(2) = stage(3, 20000, 0.001);
  ended.mutable_status()->set_state(v1::JobStatus::STATE_SUCCEEDED);
  *ended.mutable_status()->mutable_answers(0) = load_ended(0, 3, 0).load_cases_ended(0).answer();
  progress.apply(end);
  EXPECT_EQ(progress.stages.size(), 3U);
  EXPECT_EQ(progress.cases[0].status, v1::LoadCaseAnswer::STATUS_CONVERGED);
}

TEST(BarFraction, IsLogarithmic) {
  EXPECT_EQ(bar_fraction(1, 1e-12), 0);
  EXPECT_NEAR(bar_fraction(1e-6, 1e-12), 0.5, 1e-12);
  EXPECT_EQ(bar_fraction(1e-12, 1e-12), 1);
  EXPECT_EQ(bar_fraction(1e-13, 1e-12), 1);
}

TEST(BarFraction, StaysInsideForOddNumbers) {
  EXPECT_EQ(bar_fraction(2.7, 1e-12), 0);
  EXPECT_EQ(bar_fraction(0, 1e-12), 1);
  EXPECT_EQ(bar_fraction(std::numeric_limits<double>::quiet_NaN(), 1e-12), 0);
  EXPECT_EQ(bar_fraction(std::numeric_limits<double>::infinity(), 1e-12), 0);
  EXPECT_EQ(bar_fraction(0.5, 0), 0);
  EXPECT_EQ(bar_fraction(0.5, 2), 1);
}

}  // namespace
}  // namespace anticrack::cli
