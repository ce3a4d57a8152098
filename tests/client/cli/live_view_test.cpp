// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/live_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/text.hpp"
#include "client/cli/sample_stages.hpp"

namespace anticrack::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

JobProgress three_cases() {
  JobProgress progress;
  progress.apply(snapshot(3));
  progress.apply(load_ended(0, 291, 8e-13));
  progress.apply(sample(1, 120, 1e-6, 41));
  return progress;
}

TEST(Frame, HasALinePerLoadCaseWithABar) {
  EXPECT_THAT(
      frame(three_cases(), 101, 24),
      ElementsAre("jobs/1: running, 1 of 3 load cases ended",
                  "  load-0  converged      iteration   291  criterion 8.0e-13     0.0125 s  "
                  "[########################]",
                  "  load-1  running        iteration   120  criterion 1.0e-06  contact  41  "
                  "[############------------]",
                  "  load-2  waiting"));
}

TEST(Frame, DropsTheLabelsBeforeTheBar) {
  const std::vector<std::string> lines = frame(three_cases(), 80, 24);
  EXPECT_EQ(lines[1],
            "  load-0  converged      it   291  8.0e-13     0.0125 s  [####################]");
  EXPECT_EQ(lines[2],
            "  load-1  running        it   120  1.0e-06  contact  41  [##########----------]");
  EXPECT_EQ(frame(three_cases(), 60, 24)[2],
            "  load-1  running        it   120  1.0e-06  contact  41");
}

TEST(Frame, FitsEveryWidth) {
  JobProgress progress = three_cases();
  progress.cases[1].name = std::string(64, 'x');
  progress.notice = "no connection to localhost:7433, trying again";
  for (const std::size_t width : {0, 1, 2, 10, 40, 60, 79, 80, 120, 400}) {
    for (const std::string& line : frame(progress, width, 24)) {
      EXPECT_LT(columns_of(line), std::max<std::size_t>(width, 2)) << width << ": " << line;
    }
  }
}

TEST(Frame, FitsEveryHeight) {
  JobProgress progress;
  progress.apply(snapshot(100));
  for (const std::size_t height : {3, 5, 24, 100, 101}) {
    EXPECT_LE(frame(progress, 80, height).size(), height);
  }
  EXPECT_EQ(frame(progress, 80, 200).size(), 101U);
}

TEST(Frame, OfManyLoadCasesShowsThoseRunningAndTheLastThatEnded) {
  JobProgress progress;
  progress.apply(snapshot(100));
  for (int i = 0; i < 50; ++i) {
    progress.apply(load_ended(i, 300, 1e-13));
  }
  progress.apply(sample(60, 10, 0.1, 3));
  progress.apply(sample(61, 10, 0.1, 3));
  const std::vector<std::string> lines = frame(progress, 80, 8);
  ASSERT_EQ(lines.size(), 8U);
  EXPECT_THAT(lines[0], HasSubstr("50 of 100 load cases ended"));
  EXPECT_THAT(lines[1], HasSubstr("load-47 "));
  EXPECT_THAT(lines[2], HasSubstr("load-48 "));
  EXPECT_THAT(lines[3], HasSubstr("load-49 "));
  EXPECT_THAT(lines[4], HasSubstr("load-50 "));
  EXPECT_THAT(lines[5], HasSubstr("load-60 "));
  EXPECT_THAT(lines[6], HasSubstr("load-61 "));
  EXPECT_EQ(lines[7], "  and 94 more: 47 waiting, 47 converged");
}

TEST(Frame, TellsThePhaseTheTimeAndALostConnection) {
  JobProgress progress = three_cases();
  progress.detail = "factorising";
  progress.elapsed = 185.7;
  progress.notice = "no connection, trying again";
  progress.prompt = "Cancelling";
  const std::vector<std::string> lines = frame(progress, 200, 24);
  EXPECT_EQ(lines[0], "jobs/1: running (factorising), 3 min 5 s, 1 of 3 load cases ended");
  EXPECT_EQ(lines[1], "  no connection, trying again");
  EXPECT_EQ(lines[2], "  Cancelling");
  EXPECT_THAT(lines[3], HasSubstr("load-0"));
}

TEST(Frame, TellsTheExactTimeOnceItIsOver) {
  JobProgress progress;
  v1::WatchJobResponse event = snapshot(1);
  v1::Job& job = *event.mutable_snapshot()->mutable_job();
  job.mutable_status()->set_state(v1::JobStatus::STATE_SUCCEEDED);
  job.mutable_status()->mutable_create_time()->set_seconds(100);
  job.mutable_status()->mutable_end_time()->set_seconds(102);
  job.mutable_status()->mutable_end_time()->set_nanos(250'000'000);
  progress.apply(event);
  EXPECT_EQ(frame(progress, 80, 24)[0], "jobs/1: done, 2.2 s");
}

TEST(Frame, InANarrowTerminalKeepsStateProgressAndCriterion) {
  const JobProgress progress = three_cases();
  EXPECT_THAT(frame(progress, 40, 24),
              ElementsAre("running, 1 of 3 load cases ended",  //
                          "  load-0  converged  8.0e-13",      //
                          "  load-1  running    1.0e-06",      //
                          "  load-2  waiting"));
  EXPECT_THAT(frame(progress, 22, 24), ElementsAre("running, 1/3 ended",   //
                                                   "  load-0  converged",  //
                                                   "  load-1  running",    //
                                                   "  load-2  waiting"));
}

TEST(Frame, CutsNamesBeforeNumbers) {
  JobProgress progress = three_cases();
  progress.cases[1].name = "a load with a long name";
  EXPECT_EQ(frame(progress, 62, 24)[2],
            "  a load with a l~  running    it   120  1.0e-06  contact  41");
  EXPECT_EQ(frame(progress, 62, 24)[1],
            "  load-0            converged  it   291  8.0e-13     0.0125 s");
}

TEST(Frame, KeepsColumnsWhereIterationsAreMany) {
  JobProgress progress = three_cases();
  progress.cases[1].iteration = 1234567;
  const std::vector<std::string> lines = frame(progress, 80, 24);
  EXPECT_EQ(lines[1].find("8.0e-13"), lines[2].find("1.0e-06"));
}

TEST(Frame, BeforeTheFirstEventIsOneLine) {
  EXPECT_THAT(frame(JobProgress(), 80, 24), ElementsAre("job: submitted"));
}

JobProgress active_set() {
  v1::WatchJobResponse event = snapshot(2);
  event.mutable_snapshot()->mutable_job()->mutable_spec()->mutable_solver()->mutable_active_set();
  JobProgress progress;
  progress.apply(event);
  return progress;
}

TEST(Frame, OfTheActiveSetHasStepsAndNoBar) {
  JobProgress progress = active_set();
  progress.apply(load_ended(0, 4, 0));
  progress.apply(sample(1, 2, 0, 41));
  EXPECT_THAT(frame(progress, 101, 24),
              ElementsAre("jobs/1: running, 1 of 2 load cases ended",
                          "  load-0  converged      step     4     0.0125 s",
                          "  load-1  running        step     2  contact  41"));
}

JobProgress staged(int stages) {
  JobProgress progress;
  progress.apply(staged_snapshot(2));
  double error = 0.1;
  for (int i = 1; i <= stages; ++i, error /= 4) {
    progress.apply(load_ended(0, 4, 0));
    progress.apply(load_ended(1, 4, 0));
    progress.apply(stage_ended(stage(i, 1000 * static_cast<std::uint64_t>(i), error, 2)));
  }
  progress.apply(sample(1, 2, 0, 41));
  return progress;
}

TEST(Frame, HasALinePerStageAboveTheLoadCasesOfTheNewest) {
  EXPECT_THAT(
      frame(staged(2), 97, 24),
      ElementsAre("jobs/1: running, 0 of 2 load cases ended",
                  "  stage  1      1000 triangles   energy     10 % (asked 0.1 %)   A 100 %  "
                  "[######--------------]",
                  "  stage  2      2000 triangles   energy    2.5 % (asked 0.1 %)   A 25 %   "
                  "[##########----------]",
                  "  load-0  waiting",  //
                  "  load-1  running        step     2  contact  41"));
}

TEST(Frame, ShowsTheLastStagesWhereTheyDoNotFit) {
  const JobProgress many = staged(30);
  for (const std::size_t height : {3, 4, 5, 9, 24})
    EXPECT_LE(frame(many, 80, height).size(), height);
  const std::vector<std::string> lines = frame(many, 80, 6);
  EXPECT_THAT(lines.at(1), HasSubstr("stage 28"));
  EXPECT_THAT(lines.at(3), HasSubstr("stage 30"));
  EXPECT_THAT(lines.at(5), HasSubstr("load-1"));
}

TEST(PlainLog, TellsEachStageOnceAndWhatGoesWrongInIt) {
  JobProgress progress;
  PlainLog log;
  progress.apply(staged_snapshot(1));
  log.lines(progress);
  progress.apply(load_ended(0, 4, 0));
  EXPECT_THAT(log.lines(progress), IsEmpty());
  progress.apply(stage_ended(stage(1, 900, 0.02)));
  EXPECT_THAT(log.lines(progress),
              ElementsAre("stage 1: 900 triangles, energy 2 % (asked 0.1 %), A 20 %"));
  progress.apply(stage_ended(stage(1, 900, 0.02)));
  EXPECT_THAT(log.lines(progress), IsEmpty());
  progress.apply(load_ended(0, 7, 0, v1::LoadCaseAnswer::STATUS_NOT_CONVERGED));
  EXPECT_THAT(log.lines(progress), ElementsAre("load-0: not converged after 7 steps"));
}

TEST(PlainLog, OfTheActiveSetCountsSteps) {
  JobProgress progress = active_set();
  PlainLog log;
  log.lines(progress);
  progress.apply(load_ended(0, 1, 0));
  EXPECT_THAT(log.lines(progress), ElementsAre("load-0: converged after 1 step"));
}

TEST(PlainLog, TellsStatesIterationsAtTwiceAsManyAndEnds) {
  JobProgress progress;
  PlainLog log;
  progress.apply(snapshot(1));
  EXPECT_THAT(log.lines(progress), ElementsAre("jobs/1: running"));
  progress.apply(sample(0, 49, 0.1, 3));
  EXPECT_THAT(log.lines(progress), IsEmpty());
  progress.apply(sample(0, 50, 0.05, 4));
  EXPECT_THAT(log.lines(progress),
              ElementsAre("load-0: iteration 50, criterion 5.00e-02, 4 nodes in contact"));
  progress.apply(sample(0, 99, 0.01, 4));
  EXPECT_THAT(log.lines(progress), IsEmpty());
  progress.apply(sample(0, 260, 0.001, 4));
  EXPECT_THAT(log.lines(progress),
              ElementsAre("load-0: iteration 260, criterion 1.00e-03, 4 nodes in contact"));
  progress.apply(sample(0, 399, 0.001, 4));
  EXPECT_THAT(log.lines(progress), IsEmpty()) << "the next one after 200 is 400";
  progress.apply(load_ended(0, 291, 8e-13));
  EXPECT_THAT(log.lines(progress),
              ElementsAre("load-0: converged after 291 iterations, criterion 8.00e-13"));
  EXPECT_THAT(log.lines(progress), IsEmpty());
}

TEST(PlainLog, TellsOnceWhatCtrlCBringsAbout) {
  JobProgress progress;
  PlainLog log;
  progress.apply(snapshot(1));
  log.lines(progress);
  progress.prompt = "Cancelling";
  EXPECT_THAT(log.lines(progress), ElementsAre("Cancelling"));
  progress.prompt.clear();
  EXPECT_THAT(log.lines(progress), IsEmpty());
}

TEST(PlainLog, SaysWhyALoadCaseDidNotConverge) {
  JobProgress progress;
  PlainLog log;
  progress.apply(snapshot(1));
  log.lines(progress);
  v1::WatchJobResponse event = load_ended(0, 200, 2.7, v1::LoadCaseAnswer::STATUS_NOT_CONVERGED);
  event.mutable_load_cases_ended(0)->mutable_answer()->set_reason("theta = 2 is above theta*");
  progress.apply(event);
  EXPECT_THAT(log.lines(progress),
              ElementsAre("load-0: not converged after 200 iterations, criterion 2.70e+00; theta = "
                          "2 is above theta*"));
}

TEST(PlainLog, SaysWhyALoadCaseFailedBeforeItsFirstIteration) {
  JobProgress progress;
  PlainLog log;
  progress.apply(snapshot(1));
  log.lines(progress);
  v1::WatchJobResponse event = load_ended(0, 0, 0, v1::LoadCaseAnswer::STATUS_FAILED);
  event.mutable_load_cases_ended(0)->mutable_answer()->mutable_error()->set_message("not finite");
  progress.apply(event);
  EXPECT_THAT(log.lines(progress), ElementsAre("load-0: failed; not finite"));
}

}  // namespace
}  // namespace anticrack::cli
