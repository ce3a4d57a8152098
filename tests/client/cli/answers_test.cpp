// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/tables.hpp"

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "results/entries.hpp"
#include "support/sample_result.hpp"

namespace anticrack::cli {
namespace {

v1::InclusionAnswer inclusion(const std::string& name, double a, double resultant = 0,
                              double contact_length = 0) {
  v1::InclusionAnswer made;
  made.set_name(name);
  made.set_displacement(a);
  made.set_resultant(resultant);
  made.set_contact_length(contact_length);
  return made;
}

results::Result two_loads() {
  results::Result result;
  result.title = "A plate";
  result.job_name = "jobs/1";
  result.loads.resize(2);
  v1::LoadCaseAnswer& opening = result.loads[0].answer;
  opening.set_name("opening");
  opening.set_status(v1::LoadCaseAnswer::STATUS_CONVERGED);
  opening.set_iterations(346);
  opening.set_criterion(9.92e-13);
  *opening.add_inclusions() = inclusion("fibre", 0.086569, 1e-16);
  opening.set_energy(-0.163945);
  opening.set_theta(2);
  opening.set_theta_star(1.7432);
  opening.mutable_solve_time()->set_nanos(12'000'000);
  v1::LoadCaseAnswer& failed = result.loads[1].answer;
  results::forget_numbers(failed);
  failed.set_name("failed");
  failed.set_status(v1::LoadCaseAnswer::STATUS_FAILED);
  failed.mutable_error()->set_message("the expression is not finite at\x1b (0, 0)");
  return result;
}

TEST(AnswersTable, HasUnitsAndSaysWhatIsUnknown) {
  EXPECT_EQ(
      answers_table(two_loads()),
      "load     status     iterations  criterion         A     energy  contact length  theta  "
      "theta*  wall time\n"
      "                             -          -         -          -               -      -       "
      "-          s\n"
      "opening  converged         346   9.92e-13  0.086569  -0.163945               0      2   "
      "1.743      0.012\n"
      "failed   failed              0          -         -          -               -      -       "
      "-          0\n"
      "failed: the expression is not finite at? (0, 0)\n");
}

TEST(AnswersTable, NamesUnits) {
  results::Result result = two_loads();
  result.units = anticrack::testing::units_of("mm", "N");
  EXPECT_THAT(answers_table(result),
              ::testing::HasSubstr("-          -        mm       N mm              mm"));
  EXPECT_THAT(inclusions_table(result),
              ::testing::HasSubstr("A  resultant  contact length\n"
                                   "                          mm          N              mm\n"));
}

TEST(AnswersTable, NamesTheCureOfAnErrorAboveOnePerCentThatNobodyChose) {
  results::Result result = two_loads();
  result.loads.resize(1);
  results::Load& load = result.loads[0];
  load.answer.set_energy_lower(-0.18);
  load.answer.set_energy_upper(-0.17);
  load.answer.set_error_bound(0.1);
  load.answer.set_error_bound_relative(0.17);
  EXPECT_THAT(answers_table(result),
              ::testing::EndsWith("opening: u is within 17 % of the membrane's in the energy norm; "
                                  "for less write [accuracy] energy = 1e-3, or smaller\n"));
  load.stages.resize(1);
  EXPECT_THAT(answers_table(result), ::testing::Not(::testing::HasSubstr("[accuracy]")));
  load.stages = {};
  load.answer.set_error_bound_relative(0.01);
  EXPECT_THAT(answers_table(result), ::testing::Not(::testing::HasSubstr("[accuracy]")));
}

TEST(AnswersTable, TellsTheRelativeErrorOfEachAAndOfOneNear0AgainstWhat) {
  results::Result result = two_loads();
  const auto told = [&result](double a, double half, double error) {
    v1::InclusionAnswer& fibre = *result.loads[0].answer.mutable_inclusions(0);
    fibre.set_displacement(a);
    fibre.set_displacement_mesh(0.086569);
    fibre.set_displacement_lower(a - half);
    fibre.set_displacement_upper(a + half);
    fibre.set_displacement_error_relative(error);
    fibre.set_displacement_scale(2);
    return answers_table(result);
  };
  EXPECT_THAT(told(0.5, 0.03125, 0.0625), ::testing::HasSubstr("  0.500 +- 0.032 (6.2 %)  "));
  EXPECT_THAT(told(0, 0.03, 0.015), ::testing::HasSubstr("  0.000 +- 0.030 (1.5 % of 2)  "));
  EXPECT_THAT(told(0.125, 0.0125, 0.055),
              ::testing::HasSubstr("  0.125 +- 0.013 (10 %; 5.5 % of 2)  "));
  EXPECT_THAT(told(0, 0, 0), ::testing::HasSubstr("  0 +- 0  ")) << "it is held";
  v1::LoadCaseAnswer& answer = result.loads[0].answer;
  answer.mutable_inclusions(0)->set_displacement_geometry_error(0.00123);
  answer.set_energy_lower(-2);
  answer.set_energy_upper(-1.5);
  answer.set_energy_geometry_error(4.5e-6);
  EXPECT_THAT(told(0.5, 0.03125, 0.0625),
              ::testing::HasSubstr("  0.500 +- 0.032 (6.2 %), chords +- 0.0012  "));
  EXPECT_THAT(answers_table(result), ::testing::HasSubstr(", chords +- 4.5e-06  "));
}

TEST(AnswersTable, SaysThatUOf0HasNoRelativeError) {
  results::Result result = two_loads();
  v1::LoadCaseAnswer& answer = result.loads[0].answer;
  answer.set_error_bound(0.1);
  answer.set_energy(-0.0);
  const std::string text = answers_table(result);
  EXPECT_THAT(text, ::testing::HasSubstr("opening: u is 0 on this mesh, but need not be"));
  EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("within")));
  EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("-0 ")));
  answer.set_error_bound(0);  // nothing acts
  EXPECT_THAT(answers_table(result), ::testing::Not(::testing::HasSubstr("u is 0")));
}

TEST(AnswersTable, OfTheActiveSetHasTheLargestKktResidual) {
  results::Result result = two_loads();
  v1::LoadCaseAnswer& answer = result.loads[0].answer;
  answer.clear_theta();
  answer.mutable_kkt()->set_equilibrium_relative(1e-15);
  answer.mutable_kkt()->set_sign_relative(3e-14);
  EXPECT_THAT(answers_table(result), ::testing::HasSubstr("iterations       KKT         A"));
  EXPECT_THAT(answers_table(result), ::testing::HasSubstr("346  3.00e-14  0.086569"));
  answer.mutable_kkt()->set_gap_relative(results::unknown);
  EXPECT_THAT(answers_table(result), ::testing::HasSubstr("346    -  0.086569"));
}

TEST(AnswersTable, SaysWhatJustTouchesAndWarns) {
  results::Result result = two_loads();
  result.loads[0].answer.set_weakly_active(1);
  result.loads[0].answer.add_warnings("f is rough");
  EXPECT_THAT(answers_table(result),
              ::testing::HasSubstr("opening: 1 node just touches: neither jump nor pressure\n"
                                   "opening: warning: f is rough\n"));
}

TEST(AnswersTable, HasSlopeAndMomentOfWhatTilts) {
  results::Result result = two_loads();
  v1::LoadCaseAnswer& answer = result.loads[0].answer;
  answer.mutable_inclusions(0)->set_displacement(0.25);
  answer.mutable_inclusions(0)->set_moment_x(7);
  v1::InclusionAnswer& rod = *answer.add_inclusions() = inclusion("rod", -0.5);
  rod.set_slope_x(0.125);
  rod.set_moment_x(3);
  rod.set_moment_y(-4);
  EXPECT_EQ(answers_table(result),
            "load     status     iterations  criterion  A fibre  A rod  Bx rod  By rod  Mx rod  "
            "My rod     energy  contact length  theta  theta*  wall time\n"
            "                             -          -        -      -       -       -       -  "
            "     -          -               -      -       -          s\n"
            "opening  converged         346   9.92e-13     0.25   -0.5   0.125       0       3  "
            "    -4  -0.163945               0      2   1.743      0.012\n"
            "failed   failed              0          -        -      -       -       -       -  "
            "     -          -               -      -       -          0\n"
            "failed: the expression is not finite at? (0, 0)\n");
}

results::Result many_inclusions() {
  results::Result result = two_loads();
  v1::LoadCaseAnswer& answer = result.loads[0].answer;
  answer.clear_inclusions();
  for (int i = 0; i < 7; ++i)
    *answer.add_inclusions() =
        inclusion("rod, \x1b" + std::to_string(i), i == 4 ? -3.0 : 0.5 * i, 0.25, 0.125);
  answer.mutable_inclusions(2)->set_slope_x(-0.75);
  return result;
}

TEST(AnswersTable, TellsOfManyInclusionsHowFarTheyMove) {
  EXPECT_EQ(
      answers_table(many_inclusions()),
      "load     status     iterations  criterion  inclusions  least A  of       greatest A  of     "
      " "
      " greatest |B|  of          energy  contact length  theta  theta*  wall time\n"
      "                             -          -           -        -                    -         "
      "             -                   -               -      -       -          s\n"
      "opening  converged         346   9.92e-13           7       -3  rod, ?4           3  rod, ?6"
      "          0.75  rod, ?2  -0.163945               0      2   1.743      0.012\n"
      "failed   failed              0          -           -        -                    -         "
      "             -                   -               -      -       -          0\n"
      "all 7 inclusions: anticrack show RESULT --inclusions, or --csv FILE\n"
      "failed: the expression is not finite at? (0, 0)\n");
}

TEST(InclusionsTable, HasARowForEach) {
  const std::string text = inclusions_table(many_inclusions());
  EXPECT_THAT(text, ::testing::StartsWith(
                        "load     inclusion    A     Bx  By  Mx  My  resultant  contact length\n"));
  EXPECT_THAT(text, ::testing::HasSubstr(
                        "opening  rod, ?2      1  -0.75   0   0   0       0.25           0.125\n"));
  EXPECT_EQ(std::ranges::count(text, '\n'), 2 + 7);
  results::Result none = two_loads();
  none.loads[0].answer.clear_inclusions();
  EXPECT_EQ(inclusions_table(none), "no inclusions\n");
}

TEST(AnswersCsv, HasALineForEachAndQuotesNames) {
  results::Result result = two_loads();
  result.loads[0].answer.set_name("a \"b\", c");
  result.loads[0].answer.mutable_inclusions(0)->set_displacement(0.1);
  EXPECT_EQ(answers_csv(result),
            "load,inclusion,A,resultant,contact_length,Bx,By,Mx,My,A_lower,A_upper,A_estimated_"
            "error,Bx_lower,Bx_upper,By_lower,By_upper,A_mesh,Bx_mesh,By_mesh,A_error_relative,"
            "A_scale,A_error_probable,A_geometry_error\n"
            "\"a \"\"b\"\", c\",fibre,0.1,1e-16,0,0,0,0,0,,,,,,,,0,0,0,,,,\n");
}

TEST(NumbersTable, HasEveryNumberWithItsUnitAndMeaning) {
  results::Result result = two_loads();
  result.units = anticrack::testing::units_of("mm", "N");
  result.loads[0].answer.mutable_kkt();
  result.mesh.set_name("meshes/1");
  result.mesh.set_minimum_angle(12.5);
  const std::string text = numbers_table(result);
  EXPECT_THAT(text,
              ::testing::ContainsRegex("meshes/1, every number:\n(.*\n)*minimum_angle +12.5"));
  EXPECT_THAT(text, ::testing::HasSubstr("\nopening, every number:\n"));
  EXPECT_THAT(text, ::testing::ContainsRegex("\nenergy +-0.163945  N mm +Pi\\(u\\): the middle"));
  EXPECT_THAT(text, ::testing::ContainsRegex("\nkkt_gap +0  mm +largest violation of "));
  EXPECT_THAT(text, ::testing::ContainsRegex("\niterations +346  - +of Algorithm 2"));
}

TEST(AnswersTable, ShowsTheTipsBelow) {
  results::Result result = two_loads();
  result.units.set_length("mm");
  result.units.set_force("N");
  v1::Tip& tip = *result.loads[0].answer.add_tips();
  tip.set_x(0.5);
  tip.set_kind(v1::TIP_KIND_CRACK_TIP);
  tip.set_exponent(0.5);
  tip.set_intensity(0.8);
  tip.set_k_iii(1.0026);
  tip.set_energy_release_rate(0.5);
  tip.set_energy_release_rate_spread(0.001);
  v1::Tip& other = *result.loads[0].answer.add_tips();
  other.set_kind(v1::TIP_KIND_OTHER);
  other.set_reason("two cracks meet there");
  const std::string table =
      "\nload       x   y  tip        exponent  intensity       K_III    G  spread of G\n"
      "          mm  mm                                  N/mm^(1/2)    N            %\n"
      "opening  0.5   0  crack tip       0.5        0.8      1.0026  0.5          0.2\n"
      "opening    0   0  other             -          -           -    -            -\n"
      "tip at 0, 0: two cracks meet there\n";
  EXPECT_THAT(answers_table(result.loads, result.units), ::testing::EndsWith(table));
  for (int i = 0; i < 20; ++i) *result.loads[0].answer.add_tips() = tip;
  EXPECT_THAT(answers_table(result.loads, result.units),
              ::testing::EndsWith("\nall 22 rows of tips: anticrack show RESULT --tips\n"));
  EXPECT_THAT(tips_table(result.loads, result.units, true), ::testing::StartsWith("\nload"));
}

TEST(AnswersJson, IsOneDocumentWithEveryLoad) {
  google::protobuf::Struct parsed;
  results::Result result = two_loads();
  v1::LoadCaseAnswer& answer = result.loads[0].answer;
  answer.mutable_inclusions(0)->set_slope_y(-0.25);
  ASSERT_TRUE(
      google::protobuf::util::JsonStringToMessage(answers_json(result, "out.h5"), &parsed).ok());
  const auto& answers = parsed.fields().at("answers").list_value();
  ASSERT_EQ(answers.values_size(), 2);
  const auto& opening = answers.values(0).struct_value().fields();
  EXPECT_EQ(opening.at("iterations").number_value(), 346);
  const auto& inclusion = opening.at("inclusions").list_value().values(0).struct_value().fields();
  EXPECT_EQ(inclusion.at("A").number_value(), 0.086569);
  EXPECT_EQ(inclusion.at("By").number_value(), -0.25);
  const auto& failed = answers.values(1).struct_value().fields();
  EXPECT_EQ(failed.at("energy").kind_case(), google::protobuf::Value::kNullValue);
}

}  // namespace
}  // namespace anticrack::cli
