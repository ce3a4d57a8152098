// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/accuracy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "records/case_record.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::error_of;
using records::CaseRecord;
using records::JobSpec;
using records::StageRecord;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

JobSpec energy_to(double accuracy) {
  JobSpec spec;
  spec.mesh = "mesh";
  spec.loads = {{"pull", 1.0, ""}};
  spec.accuracy.emplace().energy = accuracy;
  return spec;
}

CaseRecord answer_between(double lower, double upper) {
  CaseRecord record;
  record.status = contact::Status::converged;
  record.answer.energy = upper;
  record.answer.energy_lower = lower;
  record.answer.energy_upper = upper;
  return record;
}

contact::InclusionAnswer inclusion(double displacement, double lower, double upper) {
  contact::InclusionAnswer one;
  one.displacement = displacement;
  one.displacement_lower = lower;
  one.displacement_upper = upper;
  return one;
}

Verdict judge_one(const CaseRecord& record, const JobSpec& spec,
                  std::vector<StageRecord> before = {}, std::uint64_t most = 1000,
                  double seconds = 0) {
  before.push_back({"mesh", 100, 0, {stage_answer(record)}});
  return judge(before, {&record}, spec, most, seconds);
}

TEST(Accuracy, IsTheWidthOfTheBracketOverTheEnergy) {
  const JobSpec spec = energy_to(0.1);
  EXPECT_NEAR(excess(stage_answer(answer_between(-2.2, -2)), *spec.accuracy), 1, 1e-12);
  EXPECT_NEAR(excess(stage_answer(answer_between(-3, -2)), *spec.accuracy), 5, 1e-12);
  EXPECT_EQ(excess(stage_answer(answer_between(0, 0)), *spec.accuracy), 0) << "nothing acts";
  EXPECT_TRUE(std::isinf(excess({}, *spec.accuracy))) << "no bracket";
}

TEST(Accuracy, OfADisplacementIsRelativeToItselfUnlessTheLargestIsAskedFor) {
  JobSpec spec = energy_to(1);
  spec.accuracy->displacement = 0.01;
  CaseRecord record = answer_between(-1, -1);
  record.answer.inclusions = {inclusion(2, 1.9, 2.1), inclusion(0.5, 0.46, 0.54)};
  EXPECT_NEAR(*stage_answer(record).displacement_error, 0.08, 1e-12) << "its own";
  EXPECT_NEAR(excess(stage_answer(record), *spec.accuracy), 8, 1e-12);
  EXPECT_NEAR(*stage_answer(record, true).displacement_error, 0.05, 1e-12);
  record.answer.inclusions[1].displacement_lower.reset();
  EXPECT_FALSE(stage_answer(record).displacement_error) << "one has no bounds";
  EXPECT_TRUE(std::isinf(excess(stage_answer(record), *spec.accuracy)));
}

TEST(Accuracy, ByEstimateIsReachedBeforeTheProof) {
  JobSpec spec = energy_to(1);
  spec.accuracy->energy.reset();
  spec.accuracy->displacement_estimated = 0.01;
  CaseRecord record = answer_between(-1, -1);
  record.answer.inclusions = {inclusion(2, 1.9, 2.1)};
  record.answer.inclusions[0].displacement_mesh = 1.99;
  EXPECT_THAT(judge_one(record, spec).not_reached, HasSubstr("no estimate of the error of A"));
  record.answer.inclusions[0].displacement_estimated_error = 0.014;
  contact::take_middles(record.answer);
  EXPECT_NEAR(*record.answer.inclusions[0].displacement_error_probable, 0.007, 1e-12);
  EXPECT_NEAR(excess(stage_answer(record), *spec.accuracy), 0.35, 1e-12);
  EXPECT_EQ(judge_one(record, spec).not_reached, "");
  EXPECT_TRUE(judge_one(record, spec).over);
  spec.accuracy->displacement = 0.01;
  EXPECT_FALSE(judge_one(record, spec).over) << "the proof is asked for too";
  record.answer.inclusions[0].displacement_estimated_error = 0.1;
  contact::take_middles(record.answer);
  EXPECT_NEAR(*record.answer.inclusions[0].displacement_error_probable, 0.05, 1e-12);
  record.answer.inclusions[0].displacement_mesh = 2.1;
  contact::take_middles(record.answer);
  EXPECT_NEAR(*record.answer.inclusions[0].displacement_error_probable, 0.1, 1e-12) << "refuted";
  EXPECT_THAT(judge_one(record, spec, {}, 100).not_reached,
              HasSubstr("A 5 % (asked 1 %), A by estimate 5 % (asked 1 %) on 100 triangles"));
  record.answer.inclusions[0] = inclusion(0, -0.01, 0.01);
  record.answer.inclusions[0].displacement_scale = 2;
  record.answer.inclusions[0].displacement_estimated_error = 0.002;
  contact::take_middles(record.answer);
  EXPECT_NEAR(*stage_answer(record).displacement_error_probable, 0.0005, 1e-12) << "of its scale";
}

TEST(Accuracy, IsReachedWithWhatChordsMayChange) {
  JobSpec spec = energy_to(0.1);
  spec.accuracy->displacement = 0.01;
  CaseRecord record = answer_between(-1, -0.98);
  record.answer.energy_geometry_error = 0.00098;
  record.answer.inclusions = {inclusion(2, 1.99, 2.01)};
  record.answer.inclusions[0].displacement_geometry_error = 0.008;
  EXPECT_NEAR(*stage_answer(record).energy_geometry_error, 0.001, 1e-12);
  EXPECT_NEAR(*stage_answer(record).displacement_geometry_error, 0.004, 1e-12);
  EXPECT_NEAR(excess(stage_answer(record), *spec.accuracy), 0.005 / (0.01 - 0.004), 1e-12);
  EXPECT_EQ(judge_one(record, spec).not_reached, "");
  record.answer.inclusions[0] = inclusion(2, 1.986, 2.014);
  record.answer.inclusions[0].displacement_geometry_error = 0.008;
  EXPECT_FALSE(judge_one(record, spec).over) << "0.7 % and 0.4 % are more than 1 %";
  record.answer.inclusions[0] = inclusion(2, 1.991, 2.009);
  record.answer.inclusions[0].displacement_geometry_error = 0.016;
  const Verdict verdict = judge_one(record, spec);
  EXPECT_TRUE(verdict.over);
  // a fifth of the accuracy in place of 0.8 of it: a quarter, the third power of 0.63
  EXPECT_THAT(verdict.not_reached,
              HasSubstr("A 0.45 % (asked 1 %) on 100 triangles: curves in place of their chords of "
                        "5 degrees may change A by about 0.8 %: set mesh.chord_angle = 3.1"));
  record.answer.inclusions[0].displacement_geometry_error = 0.2;
  record.answer.inclusions[0].displacement_upper = 2.11;
  EXPECT_TRUE(judge_one(record, spec).over) << "no finer mesh helps";
  record.answer.inclusions[0].displacement_upper = 2.5;
  EXPECT_FALSE(judge_one(record, spec).over) << "an estimate on so coarse a mesh says little";
}

TEST(Accuracy, SaysEarlyWhatCannotBeProved) {
  JobSpec spec = energy_to(1);
  spec.accuracy->displacement = 0.01;
  std::vector<StageRecord> stages(2);
  stages[0].triangles = 1000;
  stages[1].triangles = 8000;
  for (StageRecord& stage : stages) stage.answers.push_back({-1, -1, -1, 0, 0.4});
  EXPECT_EQ(forecast({stages[0]}, spec, 1000000), "");
  EXPECT_EQ(forecast(stages, spec, 10000), "") << "it does not fall at all";
  stages[1].answers[0].displacement_error = 0.1;
  EXPECT_EQ(forecast(stages, spec, 100000),
            "A to 1 % needs about 2.5e+05 triangles; the limit is 100000, where about 1.9 % can be "
            "proved (the error falls as triangles^-0.67)");
  EXPECT_EQ(forecast(stages, spec, 260000), "") << "it can be reached";
  stages[1].answers[0].displacement_error = 0.009;
  EXPECT_EQ(forecast(stages, spec, 8000), "") << "it is reached";
  stages[0].answers[0].displacement_error.reset();
  stages[1].answers[0].displacement_error = 0.1;
  EXPECT_EQ(forecast(stages, spec, 8000), "") << "no rate is known";
}

TEST(Accuracy, OfADisplacementOfZeroIsRelativeToItsScale) {
  JobSpec spec = energy_to(1);
  spec.accuracy->displacement = 0.01;
  CaseRecord record = answer_between(-1, -1);
  record.answer.inclusions = {inclusion(1e-17, -0.03, 0.02)};
  EXPECT_GT(*stage_answer(record).displacement_error, 1e14) << "without a scale";
  record.answer.inclusions[0].displacement_scale = 2;
  EXPECT_NEAR(*stage_answer(record).displacement_error, 0.015, 1e-12) << "at most 0.03, not 0.025";
  EXPECT_NEAR(*stage_answer(record, true).displacement_error, 0.015, 1e-12);
  EXPECT_THAT(judge_one(record, spec, {}, 100).not_reached,
              HasSubstr("A is 0 within 0.03, 1.5 % of 2 (asked 1 %) on 100 triangles: a finer"));
  const StageRecord same{"mesh", 50, 0, {stage_answer(record)}};
  EXPECT_THAT(judge_one(record, spec, {same, same, same}).not_reached, HasSubstr("no longer help"));
  record.answer.inclusions.push_back(inclusion(0.1, 0.09, 0.11));
  record.answer.inclusions.back().displacement_scale = 2;
  EXPECT_NEAR(*stage_answer(record).displacement_error, 0.055, 1e-12)
      << "0.11 of 2, not 0.01 of 0.1";
  record.answer.inclusions.erase(record.answer.inclusions.begin());
  EXPECT_THAT(judge_one(record, spec, {}, 100).not_reached,
              HasSubstr("reached energy 0 % (asked 100 %), A 5.5 % of 2 (asked 1 %) on 100"));
  record.answer.inclusions = {inclusion(1e-17, -0.02, 0.02)};
  record.answer.inclusions[0].displacement_scale = 2;
  EXPECT_EQ(judge_one(record, spec).not_reached, "") << "1 % of the scale";
  EXPECT_TRUE(judge_one(record, spec).over);
}

TEST(Accuracy, BoundsOfTheStageBeforeHoldStill) {
  CaseRecord before = answer_between(-2, -1), now = answer_between(-2.5, -1.5);
  before.answer.inclusions = {inclusion(2, 1.9, 2.1), inclusion(1, 0.9, 1.2)};
  now.answer.inclusions = {inclusion(2, 1.8, 2.05), inclusion(1, 0.8, 1.1)};
  now.answer.inclusions[1].displacement_lower.reset();
  now.answer.inclusions[1].displacement_upper.reset();
  tighten(now, before);
  EXPECT_EQ(now.answer.energy_lower, -2);
  EXPECT_EQ(now.answer.energy_upper, -1.5);
  EXPECT_EQ(now.answer.inclusions[0].displacement_lower, 1.9);
  EXPECT_EQ(now.answer.inclusions[0].displacement_upper, 2.05);
  EXPECT_EQ(now.answer.inclusions[1].displacement_lower, 0.9) << "it has none of its own";
  EXPECT_EQ(now.answer.energy, -1.75) << "the middle of what is left";
  EXPECT_DOUBLE_EQ(now.answer.inclusions[0].displacement, 1.975);
  EXPECT_DOUBLE_EQ(now.answer.inclusions[1].displacement, 1.05);
  EXPECT_NEAR(*now.answer.inclusions[0].displacement_error_relative, 0.075 / 1.975, 1e-12);
  CaseRecord apart = answer_between(-1, -0.9), unbounded = answer_between(-9, -9);
  tighten(apart, before);
  EXPECT_EQ(apart.answer.energy_lower, -1);
  unbounded.answer.energy_lower.reset();
  tighten(unbounded, before);
  EXPECT_FALSE(unbounded.answer.energy_lower) << "it says why";
}

TEST(Accuracy, GoesOnUntilItIsReached) {
  const JobSpec spec = energy_to(0.1);
  EXPECT_FALSE(judge_one(answer_between(-3, -2), spec).over);
  const Verdict reached = judge_one(answer_between(-2.1, -2), spec);
  EXPECT_TRUE(reached.over);
  EXPECT_EQ(reached.not_reached, "");
}

TEST(Accuracy, TheNextStageKnowsHowFastTheLastOneConverged) {
  records::AccuracySpec wanted;
  wanted.displacement = 0.01;
  const auto stages = [](double before, double now, std::uint64_t triangles) {
    std::vector<StageRecord> both(2);
    both[0].triangles = 1000;
    both[1].triangles = triangles;
    for (StageRecord& stage : both) stage.answers.resize(1);
    both[0].answers[0].displacement_error = before;
    both[1].answers[0].displacement_error = now;
    return both;
  };
  EXPECT_NEAR(rate_of(stages(0.4, 0.1, 8000), wanted), 2.0 / 3, 1e-12);
  EXPECT_EQ(rate_of(stages(0.4, 0.1, 4000), wanted), 1);
  EXPECT_EQ(rate_of(stages(0.4, 0.11, 4000), wanted), 1);  // as good as
  EXPECT_EQ(rate_of(stages(0.4, 0.39, 4000), wanted), 0.5);
  EXPECT_EQ(rate_of(stages(0.1, 0.4, 4000), wanted), 0.5);
  EXPECT_EQ(rate_of({stages(0.4, 0.1, 8000).front()}, wanted), 1);
  std::vector<StageRecord> unbounded = stages(0.4, 0.1, 8000);
  unbounded[0].answers[0].displacement_error.reset();
  EXPECT_EQ(rate_of(unbounded, wanted), 1);
}

TEST(Accuracy, SaysWhatWasReachedAndWhatStoppedIt) {
  JobSpec spec = energy_to(0.1);
  const CaseRecord far = answer_between(-3, -2);
  const Verdict full = judge_one(far, spec, {}, 100);
  EXPECT_TRUE(full.over);
  EXPECT_THAT(full.not_reached,
              HasSubstr("load case \"pull\" reached energy 50 % (asked 10 %) on 100"));
  EXPECT_THAT(full.not_reached, HasSubstr("more than 100 triangles, mesh-triangles of the server"));
  spec.accuracy->max_triangles = 100;
  EXPECT_THAT(judge_one(far, spec, {}, 100).not_reached,
              HasSubstr("more than 100 triangles, max_triangles of the accuracy"));

  spec.accuracy->time = 2s;
  EXPECT_FALSE(judge_one(far, spec, {}, 1000, 1.9).over);
  EXPECT_THAT(judge_one(far, spec, {}, 1000, 2).not_reached, HasSubstr("time"));

  const StageRecord same{"mesh", 50, 0, {stage_answer(far)}};
  EXPECT_FALSE(judge_one(far, spec, {same, same}).over);
  EXPECT_THAT(judge_one(far, spec, {same, same, same}).not_reached, HasSubstr("no longer help"));

  CaseRecord unbounded = far;
  unbounded.answer.no_bracket = "a point force";
  EXPECT_THAT(judge_one(unbounded, spec).not_reached, HasSubstr("a point force"));
  EXPECT_FALSE(judge_one(unbounded, spec).fall_back) << "to nothing";
  const Verdict lost = judge_one(unbounded, spec, {same});
  EXPECT_TRUE(lost.fall_back) << "to the stage that has bounds";
  EXPECT_THAT(lost.not_reached, HasSubstr("on 50 triangles: on 100 there are no bounds: a point"));
}

TEST(Accuracy, OfWhatIsZeroIsSaidInItsUnit) {
  JobSpec spec = energy_to(1);
  spec.accuracy->displacement = 0.01;
  CaseRecord odd = answer_between(-1, -1);
  odd.answer.inclusions = {inclusion(1e-17, -6e-3, 5e-3)};
  StageRecord first{"mesh", 50, 0, {stage_answer(odd)}};
  odd.answer.inclusions = {inclusion(3e-17, -6e-5, 5e-5)};
  StageRecord now{"mesh", 100, 0, {stage_answer(odd)}};
  EXPECT_FALSE(judge_one(odd, spec, {first, first}).over) << "the first stages say little";
  const Verdict stopped = judge_one(odd, spec, {first, now, now});
  EXPECT_THAT(stopped.not_reached, HasSubstr("energy 0 % (asked 100 %), A is 0 within 6e-05 on"));
  EXPECT_THAT(stopped.not_reached, HasSubstr("ask for accuracy.energy"));
  EXPECT_THAT(judge_one(odd, spec, {}, 100).not_reached, HasSubstr("A is 0 within 6e-05 on 100"));

  odd.answer.inclusions.push_back(inclusion(2, 1.999, 2.001));
  odd.answer.inclusions[0].name = "left";
  const Verdict each = judge_one(odd, spec, {now, now, now});
  EXPECT_THAT(each.not_reached, HasSubstr("A of \"left\" is 0 within 6e-05"));
  EXPECT_THAT(each.not_reached, HasSubstr("set accuracy.largest, or ask for accuracy.energy"));
  spec.accuracy->largest = true;
  now.answers = {stage_answer(odd, true)};
  const Verdict largest = judge({now}, {&odd}, spec, 1000, 0);
  EXPECT_TRUE(largest.over);
  EXPECT_EQ(largest.not_reached, "") << "relative to the largest";

  spec = energy_to(0.01);
  CaseRecord balanced = answer_between(-0.02, 0.01);
  balanced.answer.energy = 1e-18;
  now.answers = {stage_answer(balanced)};
  EXPECT_THAT(judge_one(balanced, spec, {now, now, now}).not_reached,
              HasSubstr("reached energy is 0 within 0.02 on 100 triangles: an error relative to 0 "
                        "cannot be reached; ask for accuracy.A"));
}

TEST(Accuracy, OneLoadCaseWithoutHopeDoesNotStopTheOthers) {
  JobSpec spec = energy_to(0.1);
  spec.loads.push_back({"push", 1.0, ""});
  CaseRecord stuck = answer_between(-1, 1), far = answer_between(-3, -2);
  stuck.answer.energy = 0;
  const StageRecord before{"mesh", 50, 0, {stage_answer(stuck), stage_answer(far)}};
  far = answer_between(-2.5, -2);
  const StageRecord now{"mesh", 100, 0, {stage_answer(stuck), stage_answer(far)}};
  EXPECT_FALSE(judge({before, before, before, now}, {&stuck, &far}, spec, 1000, 0).over);
  EXPECT_THAT(judge({before, now, now, now, now}, {&stuck, &far}, spec, 1000, 0).not_reached,
              HasSubstr("load case \"pull\" reached energy is 0 within 1"));
}

TEST(Accuracy, AFailedLoadCaseEndsIt) {
  CaseRecord failed;
  failed.status = contact::Status::failed;
  failed.error = errors::Error(errors::Reason::limit_exceeded, "too much");
  const Verdict verdict = judge_one(failed, energy_to(0.1));
  EXPECT_TRUE(verdict.over);
  EXPECT_EQ(verdict.not_reached, "") << "the load case says why";
  const StageRecord before{"mesh", 50, 0, {stage_answer(answer_between(-3, -2))}};
  const Verdict later = judge_one(failed, energy_to(0.1), {before});
  EXPECT_TRUE(later.fall_back);
  EXPECT_THAT(later.not_reached, HasSubstr("on 100 there are no bounds: too much"));
}

std::string field_at_fault(const JobSpec& spec) {
  const auto error = error_of([&] { check_accuracy(spec); });
  return error ? error->fields().at(0).field : "";
}

TEST(Accuracy, RefusesWhatCannotBeSolvedInStages) {
  EXPECT_EQ(field_at_fault(energy_to(1e-3)), "");
  for (const double bad : {0.0, -1.0, 9e-7, 1.1, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(field_at_fault(energy_to(bad)), "accuracy.energy") << bad;
    JobSpec spec = energy_to(0.1);
    spec.accuracy->displacement = bad;
    EXPECT_EQ(field_at_fault(spec), "accuracy.displacement") << bad;
    spec = energy_to(0.1);
    spec.accuracy->displacement_estimated = bad;
    EXPECT_EQ(field_at_fault(spec), "accuracy.displacement_estimated") << bad;
  }
  JobSpec spec = energy_to(0.1);
  spec.accuracy->energy.reset();
  EXPECT_EQ(field_at_fault(spec), "accuracy");
  spec = energy_to(0.1);
  spec.accuracy->largest = true;
  EXPECT_EQ(field_at_fault(spec), "accuracy.largest");
  spec = energy_to(0.1);
  spec.solver = contact::UzawaOptions();
  EXPECT_EQ(field_at_fault(spec), "solver.uzawa");
  spec = energy_to(0.1);
  spec.without_bounds = true;
  EXPECT_EQ(field_at_fault(spec), "without_bounds");
  spec = energy_to(0.1);
  spec.loads.push_back({"array", fem::Array{"00", false, nullptr}, ""});
  EXPECT_EQ(field_at_fault(spec), "load_cases[1].force");
  spec = energy_to(0.1);
  spec.loads.resize(257, spec.loads.front());
  EXPECT_EQ(field_at_fault(spec), "load_cases");
}

}  // namespace
}  // namespace anticrack::jobs
