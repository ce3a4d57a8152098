// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "client/cli/sample_progress.hpp"

namespace anticrack::cli {
namespace {

TEST(JobProgress, FollowsALoadCaseFromSnapshotToEnd) {
  JobProgress progress;
  progress.apply(snapshot(2));
  ASSERT_EQ(progress.cases.size(), 2U);
  EXPECT_EQ(progress.cases[1].name, "load-1");
  EXPECT_EQ(progress.cases[1].status, results::Status::pending);

  progress.apply(sample(1, 7, 1e-3, 12));
  EXPECT_EQ(progress.cases[1].status, results::Status::running);
  EXPECT_EQ(progress.cases[1].iteration, 7);
  EXPECT_EQ(progress.cases[1].contact_count, 12);

  progress.apply(load_ended(1, 9, 1e-13));
  EXPECT_EQ(progress.cases[1].status, results::Status::converged);
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
  EXPECT_EQ(progress.cases[0].status, results::Status::converged);
  EXPECT_EQ(progress.ended_count, 1U);
}

TEST(JobProgress, OfAJobThatHasEndedIsNotRunningAgain) {
  JobProgress progress;
  v1::WatchJobResponse late = snapshot(1);
  late.mutable_snapshot()->mutable_job()->set_state(v1::Job::STATE_SUCCEEDED);
  progress.apply(late);
  v1::WatchJobResponse phase;
  phase.mutable_phase()->set_state(v1::Job::STATE_RUNNING);
  phase.mutable_phase()->set_detail("writing the result");
  progress.apply(phase);
  EXPECT_EQ(progress.state, v1::Job::STATE_SUCCEEDED);
  EXPECT_EQ(progress.detail, "");
}

TEST(JobProgress, BeginsAnewWithAnotherAttempt) {
  JobProgress progress;
  v1::WatchJobResponse first = snapshot(2);
  first.mutable_snapshot()->mutable_job()->set_attempt(1);
  progress.apply(first);
  progress.apply(sample(0, 7, 1e-3, 12));
  progress.apply(load_ended(1, 9, 1e-13));
  progress.apply(first);
  EXPECT_EQ(progress.cases[0].iteration, 7) << "the same attempt, watched again";

  v1::WatchJobResponse second = snapshot(2);
  second.mutable_snapshot()->mutable_job()->set_attempt(2);
  progress.apply(second);
  EXPECT_EQ(progress.ended_count, 0U);
  progress.apply(sample(0, 1, 0.5, 1));
  EXPECT_EQ(progress.cases[0].iteration, 1);
}

TEST(JobProgress, TellsThePhaseUntilTheStateChanges) {
  JobProgress progress;
  v1::WatchJobResponse phase;
  phase.mutable_phase()->set_state(v1::Job::STATE_WAITING_FOR_MESH);
  phase.mutable_phase()->set_detail("meshing\x1b[2J");
  progress.apply(phase);
  EXPECT_EQ(progress.state, v1::Job::STATE_WAITING_FOR_MESH);
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
