// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/answers.hpp"

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace anticrack::cli {
namespace {

using results::Status;

results::Result two_loads() {
  results::Result result;
  result.title = "A plate";
  result.job_name = "jobs/1";
  results::Load opening;
  opening.name = "opening";
  opening.status = Status::converged;
  opening.iterations = 346;
  opening.criterion = 9.92e-13;
  opening.inclusions = {{"fibre", 0.086569, 1e-16, 0}};
  opening.energy = -0.163945;
  opening.theta = 2;
  opening.theta_star = 1.7432;
  opening.solve_seconds = 0.012;
  results::Load failed;
  failed.name = "failed";
  failed.status = Status::failed;
  failed.error = "the expression is not finite at\x1b (0, 0)";
  result.loads = {opening, failed};
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
  result.units = {"mm", "N"};
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
  load.energy_lower = -0.18;
  load.energy_upper = -0.17;
  load.error_bound = 0.1;
  load.error_bound_relative = 0.17;
  EXPECT_THAT(answers_table(result),
              ::testing::EndsWith("opening: u is within 17 % of the membrane's in the energy norm; "
                                  "for less write [accuracy] energy = 1e-3, or smaller\n"));
  load.stages = {{900}, {-0.17}, {-0.18}, {-0.17}, {0.17}, {results::unknown}, {0.1}};
  EXPECT_THAT(answers_table(result), ::testing::Not(::testing::HasSubstr("[accuracy]")));
  load.stages = {};
  load.error_bound_relative = 0.01;
  EXPECT_THAT(answers_table(result), ::testing::Not(::testing::HasSubstr("[accuracy]")));
}

TEST(AnswersTable, SaysThatUOf0HasNoRelativeError) {
  results::Result result = two_loads();
  results::Load& load = result.loads[0];
  load.error_bound = 0.1;
  load.energy = -0.0;
  const std::string text = answers_table(result);
  EXPECT_THAT(text, ::testing::HasSubstr("opening: u is 0 on this mesh, but need not be"));
  EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("within")));
  EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("-0 ")));
  load.error_bound = 0;  // nothing acts
  EXPECT_THAT(answers_table(result), ::testing::Not(::testing::HasSubstr("u is 0")));
}

TEST(AnswersTable, OfTheActiveSetHasTheLargestKktResidual) {
  results::Result result = two_loads();
  result.loads[0].theta = result.loads[0].theta_star = results::unknown;
  result.loads[0].kkt_relative = {1e-15, 0, 3e-14, 2e-16};
  EXPECT_THAT(answers_table(result), ::testing::HasSubstr("iterations       KKT         A"));
  EXPECT_THAT(answers_table(result), ::testing::HasSubstr("346  3.00e-14  0.086569"));
  result.loads[0].kkt_relative.gap = results::unknown;
  EXPECT_THAT(answers_table(result), ::testing::HasSubstr("346    -  0.086569"));
}

TEST(AnswersTable, SaysWhatJustTouchesAndWarns) {
  results::Result result = two_loads();
  result.loads[0].weakly_active = 1;
  result.loads[0].warnings = {"f is rough"};
  EXPECT_THAT(answers_table(result),
              ::testing::HasSubstr("opening: 1 node just touches: neither jump nor pressure\n"
                                   "opening: warning: f is rough\n"));
}

TEST(AnswersTable, NamesInclusionsWhereThereAreSeveral) {
  results::Result result = two_loads();
  result.loads[0].inclusions.push_back({"rod", -0.5, 0, 0});
  const std::string text = answers_table(result);
  EXPECT_THAT(text, ::testing::HasSubstr("A fibre"));
  EXPECT_THAT(text, ::testing::HasSubstr("A rod"));
  EXPECT_THAT(text, ::testing::HasSubstr("-0.5"));
}

TEST(AnswersTable, HasSlopeAndMomentOfWhatTilts) {
  results::Result result = two_loads();
  result.loads[0].inclusions = {{"fibre", 0.25, 0, 0, 0, 0, 7, 7},
                                {"rod", -0.5, 0, 0, 0.125, 0, 3, -4}};
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
  auto& inclusions = result.loads[0].inclusions;
  inclusions.clear();
  for (int i = 0; i < 7; ++i)
    inclusions.push_back({"rod, \x1b" + std::to_string(i), i == 4 ? -3.0 : 0.5 * i, 0.25, 0.125});
  inclusions[2].slope_x = -0.75;
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
  none.loads[0].inclusions.clear();
  EXPECT_EQ(inclusions_table(none), "no inclusions\n");
}

TEST(AnswersCsv, HasALineForEachAndQuotesNames) {
  results::Result result = two_loads();
  result.loads[0].name = "a \"b\", c";
  result.loads[0].inclusions[0].displacement = 0.1;
  EXPECT_EQ(answers_csv(result),
            "load,inclusion,A,resultant,contact_length,Bx,By,Mx,My,A_lower,A_upper,A_estimated_"
            "error,Bx_lower,Bx_upper,By_lower,"
            "By_upper\n"
            "\"a \"\"b\"\", c\",fibre,0.1,1e-16,0,0,0,0,0,,,,,,,\n");
}

TEST(AnswersJson, IsOneDocumentWithEveryLoad) {
  google::protobuf::Struct parsed;
  results::Result result = two_loads();
  result.loads[0].inclusions[0].slope_y = -0.25;
  result.loads[0].inclusions[0].moment_y = 4;
  result.mesh.xy = {0, 0, 1, 0, 0, 1};
  result.mesh.triangles = {0, 1, 2};
  result.interfaces.resize(2);
  result.interfaces[1].name = "seam";
  result.loads[0].contact_intervals = {{1, 0.25, 0.5}};
  ASSERT_TRUE(
      google::protobuf::util::JsonStringToMessage(answers_json(result, "out.h5"), &parsed).ok());
  EXPECT_EQ(parsed.fields().at("title").string_value(), "A plate");
  EXPECT_EQ(parsed.fields().at("file").string_value(), "out.h5");
  EXPECT_EQ(parsed.fields().at("triangle_count").number_value(), 1);
  EXPECT_EQ(parsed.fields().at("node_count").number_value(), 3);
  const auto& answers = parsed.fields().at("answers").list_value();
  ASSERT_EQ(answers.values_size(), 2);
  const auto& opening = answers.values(0).struct_value().fields();
  EXPECT_EQ(opening.at("status").string_value(), "converged");
  EXPECT_EQ(opening.at("iterations").number_value(), 346);
  const auto& contact = opening.at("contact_intervals").list_value();
  ASSERT_EQ(contact.values_size(), 1);
  const auto& closed = contact.values(0).struct_value().fields();
  EXPECT_EQ(closed.at("interface").string_value(), "seam");
  EXPECT_EQ(closed.at("begin").number_value(), 0.25);
  EXPECT_EQ(closed.at("end").number_value(), 0.5);
  const auto& inclusion = opening.at("inclusions").list_value().values(0).struct_value().fields();
  EXPECT_EQ(inclusion.at("A").number_value(), 0.086569);
  EXPECT_EQ(inclusion.at("By").number_value(), -0.25);
  EXPECT_EQ(inclusion.at("My").number_value(), 4);
  const auto& failed = answers.values(1).struct_value().fields();
  EXPECT_EQ(failed.at("energy").kind_case(), google::protobuf::Value::kNullValue);
}

}  // namespace
}  // namespace anticrack::cli
