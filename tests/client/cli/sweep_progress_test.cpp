// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cli/live_view.hpp"
#include "cli/text.hpp"

namespace anticrack::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

v1::SweepRows rows(std::uint64_t first, int count,
                   v1::LoadCaseAnswer::Status status = v1::LoadCaseAnswer::STATUS_CONVERGED) {
  v1::SweepRows message;
  message.set_first_row(first);
  for (int i = 0; i < count; ++i) {
    message.add_status(status);
  }
  return message;
}

SweepProgress of_rows(std::uint64_t total) {
  SweepProgress progress;
  progress.total = total;
  return progress;
}

TEST(SweepProgress, CountsRowsInAnyOrder) {
  SweepProgress progress = of_rows(100);
  progress.apply(rows(50, 50), 0);
  progress.apply(rows(0, 20, v1::LoadCaseAnswer::STATUS_NOT_CONVERGED), 1);
  progress.apply(rows(20, 5, v1::LoadCaseAnswer::STATUS_FAILED), 2);
  EXPECT_EQ(progress.done(), 75U);
  EXPECT_EQ(progress.not_converged(), 20U);
  EXPECT_EQ(progress.failed(), 5U);
}

TEST(SweepProgress, CountsRowsOnceThatComeAgain) {
  SweepProgress progress = of_rows(100);
  progress.apply(rows(0, 20, v1::LoadCaseAnswer::STATUS_NOT_CONVERGED), 0);
  progress.apply(rows(10, 20, v1::LoadCaseAnswer::STATUS_NOT_CONVERGED), 1);
  EXPECT_EQ(progress.done(), 30U);
  EXPECT_EQ(progress.not_converged(), 30U);
}

TEST(SweepProgress, BelievesTheServerAboutRowsItDidNotSee) {
  SweepProgress progress;
  v1::SweepAnswer answer;
  answer.set_rows(100);
  answer.set_converged(60);
  answer.set_not_converged(3);
  answer.set_failed(1);
  progress.apply(answer);
  EXPECT_EQ(progress.total, 100U);
  EXPECT_EQ(progress.done(), 64U);
  progress.apply(rows(0, 10), 0);
  EXPECT_EQ(progress.done(), 64U) << "these may be among them";
  answer.set_converged(1);
  progress.apply(answer);
  EXPECT_EQ(progress.done(), 64U) << "an old count";
}

TEST(SweepProgress, MeasuresTheRateOfTheLastSeconds) {
  SweepProgress progress = of_rows(10'000);
  EXPECT_TRUE(std::isnan(progress.rate()));
  progress.apply(rows(0, 1), 100);
  EXPECT_TRUE(std::isnan(progress.rate())) << "no time has gone by";
  progress.apply(rows(1, 199), 102);
  EXPECT_DOUBLE_EQ(progress.rate(), 100);
  EXPECT_DOUBLE_EQ(progress.seconds_left(), 98);
  for (int second = 3; second <= 60; ++second) {
    progress.apply(rows(static_cast<std::uint64_t>(100 * second - 100), 100), 100 + second);
  }
  EXPECT_NEAR(progress.rate(), 100, 20);
  // Ten times as fast from now on; the slow start is forgotten.
  for (int second = 1; second <= 4; ++second) {
    progress.apply(rows(5000 + 1000 * static_cast<std::uint64_t>(second), 1000), 160 + second);
  }
  EXPECT_GT(progress.rate(), 300);
}

TEST(SweepProgress, DoesNotKnowTheTimeLeftOfNothing) {
  SweepProgress unknown;
  unknown.apply(rows(0, 10), 0);
  unknown.apply(rows(10, 10), 1);
  EXPECT_TRUE(std::isnan(unknown.seconds_left()));
  SweepProgress stuck = of_rows(100);
  stuck.apply(rows(0, 0), 0);
  stuck.apply(rows(0, 0), 5);
  EXPECT_TRUE(std::isnan(stuck.seconds_left()));
}

TEST(SweepProgress, SurvivesNonsense) {
  SweepProgress progress = of_rows(10);
  const std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
  progress.apply(rows(last, 10), 0);
  progress.apply(rows(10, 10), 0);
  EXPECT_EQ(progress.done(), 0U);
  progress.apply(rows(5, 10), 0);
  EXPECT_EQ(progress.done(), 5U);
  SweepProgress endless;
  endless.apply(rows(last - 3, 10), 0);
  EXPECT_EQ(endless.done(), 0U);
}

TEST(SweepProgress, BeginsAnewWithAnotherAttempt) {
  SweepProgress progress = of_rows(100);
  progress.apply(rows(0, 50, v1::LoadCaseAnswer::STATUS_NOT_CONVERGED), 0);
  progress.restart();
  EXPECT_EQ(progress.done(), 0U);
  EXPECT_EQ(progress.not_converged(), 0U);
  EXPECT_EQ(progress.total, 100U);
  progress.apply(rows(0, 50), 1);
  EXPECT_EQ(progress.done(), 50U);
}

v1::WatchJobResponse sweep_snapshot(std::uint64_t total, std::int32_t attempt = 1) {
  v1::WatchJobResponse event;
  v1::Job& job = *event.mutable_snapshot()->mutable_job();
  job.set_name("jobs/1");
  job.mutable_status()->set_state(v1::JobStatus::STATE_RUNNING);
  job.mutable_status()->set_attempt(attempt);
  job.mutable_spec()->add_load_cases()->set_name("skew");
  job.mutable_spec()->add_load_cases()->set_name("opening");
  job.mutable_spec()->mutable_sweep()->mutable_coefficients()->set_upload("uploads/1");
  job.mutable_status()->mutable_sweep_answer()->set_rows(total);
  return event;
}

v1::WatchJobResponse event_of(const v1::SweepRows& message) {
  v1::WatchJobResponse event;
  *event.mutable_sweep_rows() = message;
  return event;
}

JobProgress on_its_way() {
  JobProgress progress;
  progress.apply(sweep_snapshot(100'000), 10);
  progress.apply(event_of(rows(0, 10'000)), 10);
  progress.apply(event_of(rows(10'000, 39'997)), 14);
  progress.apply(event_of(rows(49'997, 3, v1::LoadCaseAnswer::STATUS_NOT_CONVERGED)), 15);
  return progress;
}

TEST(SweepFrame, IsABarWithRateTimeLeftAndWhatDidNotConverge) {
  EXPECT_THAT(frame(on_its_way(), 100, 24),
              ElementsAre("jobs/1: running, 50000 of 100000 rows",
                          "  [####################--------------------]  10000 rows/s  5 s left  3 "
                          "not converged"));
}

TEST(SweepFrame, FitsEveryWidth) {
  const JobProgress progress = on_its_way();
  for (const std::size_t width : {0, 1, 2, 10, 40, 60, 80, 400}) {
    for (const std::string& line : frame(progress, width, 24)) {
      EXPECT_LT(columns_of(line), std::max<std::size_t>(width, 2)) << width << ": " << line;
    }
  }
}

TEST(SweepFrame, HasNoBarWhereTheNumberOfRowsIsNotKnown) {
  JobProgress progress;
  progress.apply(sweep_snapshot(0), 0);
  progress.apply(event_of(rows(0, 10)), 0);
  const std::vector<std::string> lines = frame(progress, 80, 24);
  EXPECT_EQ(lines[0], "jobs/1: running, 10 rows");
  EXPECT_EQ(lines[1], "");
}

TEST(SweepFrame, MeasuresTheRateFromWhenTheJobBegan) {
  JobProgress progress;
  progress.apply(sweep_snapshot(100), 0);
  v1::WatchJobResponse phase;
  phase.mutable_phase()->set_state(v1::JobStatus::STATE_RUNNING);
  progress.apply(phase, 5);
  progress.apply(event_of(rows(0, 50)), 7);  // all of them at once
  EXPECT_THAT(frame(progress, 80, 24)[1], HasSubstr("25 rows/s  2 s left"));
}

TEST(SweepFrame, StartsAgainWithAnotherAttempt) {
  JobProgress progress = on_its_way();
  progress.apply(sweep_snapshot(100'000, 2), 20);
  EXPECT_THAT(frame(progress, 100, 24)[0], HasSubstr("attempt 2, 0 of 100000 rows"));
}

TEST(SweepLog, TellsEachTenthOfTheRowsAndTheEnd) {
  JobProgress progress;
  PlainLog log;
  progress.apply(sweep_snapshot(105), 0);
  std::vector<std::string> lines = log.lines(progress);
  for (int i = 0; i < 21; ++i) {
    progress.apply(event_of(rows(5 * static_cast<std::uint64_t>(i), 5)), 0);
    for (const std::string& line : log.lines(progress)) {
      lines.push_back(line);
    }
  }
  EXPECT_THAT(
      lines, ElementsAre("jobs/1: running", "10 of 105 rows", "20 of 105 rows", "30 of 105 rows",
                         "40 of 105 rows", "50 of 105 rows", "60 of 105 rows", "70 of 105 rows",
                         "80 of 105 rows", "90 of 105 rows", "100 of 105 rows", "105 of 105 rows"));
  EXPECT_THAT(log.lines(progress), IsEmpty()) << "nothing is told twice";
}

TEST(SweepLog, TellsDoublingsWhereTheNumberOfRowsIsNotKnown) {
  JobProgress progress;
  PlainLog log;
  progress.apply(sweep_snapshot(0), 0);
  std::size_t count = 0;
  for (int i = 0; i < 100; ++i) {
    progress.apply(event_of(rows(100 * static_cast<std::uint64_t>(i), 100)), 0);
    count += log.lines(progress).size();
  }
  EXPECT_EQ(count, 1U + 4) << "the state; 1000, 2000, 4000, 8000 rows";
}

TEST(TimeText, IsForPeople) {
  EXPECT_EQ(time_text(0), "0 s");
  EXPECT_EQ(time_text(0.4321), "0.43 s");
  EXPECT_EQ(time_text(41.6), "42 s");
  EXPECT_EQ(time_text(59.7), "1 min 0 s");
  EXPECT_EQ(time_text(185), "3 min 5 s");
  EXPECT_EQ(time_text(7800), "2 h 10 min");
  EXPECT_EQ(time_text(-1), "-");
  EXPECT_EQ(time_text(std::numeric_limits<double>::quiet_NaN()), "-");
  EXPECT_EQ(time_text(std::numeric_limits<double>::infinity()), "-");
}

}  // namespace
}  // namespace anticrack::cli
