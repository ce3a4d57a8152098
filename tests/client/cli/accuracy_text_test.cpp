// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cli/live_view.hpp"
#include "cli/tables.hpp"
#include "cli/text.hpp"
#include "client/cli/sample_stages.hpp"

namespace anticrack::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

v1::Accuracy asked(double energy) {
  v1::Accuracy accuracy;
  accuracy.set_energy(energy);
  return accuracy;
}

TEST(ErrorsOf, AreTheLargestOfAllLoadCases) {
  const StageErrors errors = errors_of(stage(1, 900, 0.02, 2));
  EXPECT_NEAR(errors.energy, 0.02, 1e-12);
  EXPECT_NEAR(errors.displacement, 0.2, 1e-12);
}

TEST(ErrorsOf, AreUnknownWhereALoadCaseHasNoBounds) {
  for (const int load : {0, 1}) {
    v1::Stage ended = stage(1, 900, 0.02, 2);
    ended.mutable_answers(load)->clear_energy_lower();
    ended.mutable_answers(load)->clear_displacement_error();
    EXPECT_TRUE(std::isnan(errors_of(ended).energy));
    EXPECT_TRUE(std::isnan(errors_of(ended).displacement));
  }
}

TEST(ErrorsOf, OfNoLoadIsZero) {
  v1::Stage ended = stage(1, 900, 0);
  ended.mutable_answers(0)->set_energy(0);
  ended.mutable_answers(0)->set_energy_lower(0);
  ended.mutable_answers(0)->set_energy_upper(0);
  EXPECT_EQ(errors_of(ended).energy, 0);
}

TEST(StageLines, HaveABarOfTheLogarithmOfTheError) {
  const std::vector<v1::Stage> stages{stage(1, 900, 0.032), stage(2, 12345, 0.0009)};
  EXPECT_THAT(
      stage_lines(stages, asked(1e-3), 96, 9),
      ElementsAre("  stage  1       900 triangles   energy    3.2 % (asked 0.1 %)   A 32 %   "
                  "[#########-----------]",
                  "  stage  2     12345 triangles   energy   0.09 % (asked 0.1 %)   A 0.9 %  "
                  "[####################]"));
  EXPECT_THAT(stage_lines(stages, asked(1e-3), 95, 1), ElementsAre(HasSubstr("stage  2")));
  EXPECT_THAT(stage_lines(stages, asked(1e-3), 95, 0), ElementsAre());
  EXPECT_THAT(stage_lines({}, asked(1e-3), 95, 9), ElementsAre());
  EXPECT_THAT(
      stage_lines(stages, asked(1e-3), 72, 1),
      ElementsAre("  stage  2     12345 triangles   energy   0.09 % (asked 0.1 %)   A 0.9 %"));
  for (const std::string& line : stage_lines(stages, asked(1e-3), 20, 9))
    EXPECT_EQ(columns_of(line), 20U);
}

TEST(StageLines, AreFullWhereAllThatIsAskedForIsReached) {
  v1::Accuracy both = asked(0.01);
  both.set_displacement(0.05);
  const auto line = [&both](double error) {
    return stage_lines({stage(1, 900, error)}, both, 120, 1).at(0);
  };
  EXPECT_THAT(line(0.01), HasSubstr("energy      1 % (asked 1 %)   A     10 % (asked 5 %)"));
  EXPECT_THAT(line(0.01), HasSubstr("#-")) << "not yet A";
  EXPECT_THAT(line(0.004), HasSubstr("##]"));
  v1::Stage unknown = stage(1, 900, 0.004);
  unknown.mutable_answers(0)->clear_displacement_error();
  EXPECT_THAT(stage_lines({unknown}, both, 120, 1).at(0), HasSubstr("A      - % (asked 5 %)  [--"));
}

TEST(StageLines, HaveTheEstimateAndWhatCannotBeProved) {
  v1::Accuracy wanted = asked(0.01);
  wanted.set_displacement_estimated(0.001);
  v1::Stage ended = stage(1, 900, 0.004);
  ended.mutable_answers(0)->set_displacement_error_probable(0.002);
  EXPECT_THAT(stage_lines({ended}, wanted, 120, 1).at(0),
              HasSubstr("A 4 %   probably    0.2 % (asked 0.1 %)  [#"));
  EXPECT_THAT(stage_text(1, ended, wanted), HasSubstr(", probably 0.2 % (asked 0.1 %)"));
  ended.set_forecast("A to 1 % needs about 1e+07 triangles");
  EXPECT_THAT(stage_lines({ended}, wanted, 120, 2),
              ElementsAre(HasSubstr("stage  1"), "  A to 1 % needs about 1e+07 triangles"));
  EXPECT_THAT(stage_text(1, ended, wanted), HasSubstr("; A to 1 % needs about 1e+07"));
}

TEST(AccuracyText, TellsWhatWasReachedAndWhatNot) {
  v1::Job job;
  EXPECT_EQ(accuracy_text(job), "");
  *job.mutable_spec()->mutable_accuracy() = asked(1e-3);
  EXPECT_EQ(accuracy_text(job), "");
  *job.mutable_status()->add_stages() = stage(1, 900, 0.02);
  *job.mutable_status()->add_stages() = stage(2, 12345, 0.0009);
  job.mutable_status()->add_stages()->set_mesh("meshes/3");  // was stopped
  EXPECT_EQ(accuracy_text(job),
            "accuracy: energy 0.09 % (asked 0.1 %), A 0.9 %; 2 stages, 12345 triangles, 0.5 s\n");
  for (int i = 0; i < 2; ++i) job.mutable_status()->mutable_answers()->Add()->add_inclusions();
  EXPECT_THAT(accuracy_text(job), HasSubstr(", A 0.9 %; ")) << "one inclusion, two load cases";
  job.mutable_status()->mutable_answers(1)->add_inclusions();
  EXPECT_THAT(accuracy_text(job), HasSubstr(", A 0.9 % of each A; "));
  job.mutable_spec()->mutable_accuracy()->set_displacement(0.01);
  job.mutable_spec()->mutable_accuracy()->set_largest(true);
  EXPECT_THAT(accuracy_text(job), HasSubstr(", A 0.9 % of the largest A (asked 1 %); "));
  job.mutable_status()->clear_answers();
  *job.mutable_spec()->mutable_accuracy() = asked(1e-3);
  job.mutable_status()->mutable_stages()->DeleteSubrange(1, 2);
  job.mutable_status()->mutable_stages(0)->mutable_answers(0)->clear_displacement_error();
  job.mutable_status()->set_not_reached("no\x1bmore");
  EXPECT_EQ(accuracy_text(job),
            "accuracy: energy 2 % (asked 0.1 %); 1 stage, 900 triangles, 0.25 s\n"
            "not reached: no?more\n");
}

}  // namespace
}  // namespace anticrack::cli
