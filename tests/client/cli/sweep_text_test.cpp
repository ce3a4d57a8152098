// SPDX-License-Identifier: GPL-3.0-or-later

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "cli/tables.hpp"
#include "client/sample_sweep.hpp"

namespace anticrack::cli {
namespace {

using anticrack::testing::sample_sweep;
using anticrack::testing::tilting_sweep;
using anticrack::testing::values_of;
using ::testing::HasSubstr;
using ::testing::Not;

void set_status(results::Result& result, std::size_t row, v1::LoadCaseAnswer::Status status) {
  values_of<std::int32_t>(result.sweep->columns, "status")[row] = status;
  anticrack::testing::count_rows(*result.sweep);
}

TEST(SweepTable, SumsUp) {
  EXPECT_EQ(answers_table(sample_sweep(5)),
            "5 rows of ratio.csv: 4 converged, 1 did not converge (row 3)\n"
            "at most 5 steps, KKT residuals at most 1e-13\n"
            "\n"
            "                least  most\n"
            "A                -0.1   0.1\n"
            "contact length      0   0.9\n"
            "energy             -2    -1\n"
            "traces of 2 rows\n");
}

TEST(SweepTable, NamesTheFirstRowsThatWentWrong) {
  results::Result result = sample_sweep(20);
  for (const std::size_t row : {0, 1, 2, 3, 4, 5, 6, 7, 13})
    set_status(result, row, v1::LoadCaseAnswer::STATUS_FAILED);
  EXPECT_THAT(answers_table(result), HasSubstr(" (rows 0, 1, 2, 3, 4 and 5 more)\n"));
}

TEST(SweepTable, NamesUnits) {
  results::Result result = sample_sweep(5);
  result.units = anticrack::testing::units_of("mm", "N");
  EXPECT_THAT(answers_table(result), HasSubstr("                     least  most\n"
                                               "A [mm]                -0.1   0.1\n"
                                               "contact length [mm]      0   0.9\n"
                                               "energy [N mm]           -2    -1\n"));
}

TEST(SweepTable, HasTheSlopesOfWhatTilts) {
  EXPECT_THAT(answers_table(tilting_sweep(5)), HasSubstr("A                -0.1   0.1\n"
                                                         "Bx               -0.2   0.2\n"
                                                         "By               -0.5  -0.5\n"
                                                         "contact length"));
  results::Result level = sample_sweep(5);
  level.sweep->columns["slope"] = results::array_of(std::vector<double>(10, 0.0), {1, 2});
  EXPECT_EQ(answers_table(level), answers_table(sample_sweep(5)));
}

TEST(SweepTable, SaysHowWideBoundsAre) {
  results::Result result = anticrack::testing::bounded_sweep(5);
  EXPECT_THAT(answers_table(result),
              HasSubstr("-1\nbounds of 3 rows: of the energy at most 0.5 % wide, of A at most +- "
                        "0.01; none of row 4\ntraces of 2 rows\n"));
  std::ranges::fill(values_of(result.sweep->columns, "energy_lower"), results::unknown);
  EXPECT_THAT(answers_table(result), HasSubstr("no row has bounds\n"));
}

TEST(SweepTable, SpansTheMembranesOwnWhereThereAreBounds) {
  results::Result result = anticrack::testing::bounded_sweep(5);
  EXPECT_THAT(answers_table(result), HasSubstr("                least  most\n"
                                               "A               -0.11   0.1\n"
                                               "contact length      0   0.9\n"
                                               "energy          -2.01    -1\n"))
      << "of the last row, without bounds, A = 0.1 on the mesh";
  values_of(result.sweep->columns, "displacement_lower")[0] = -0.123412;
  values_of(result.sweep->columns, "displacement_upper")[2] = 0.123412;
  values_of(result.sweep->columns, "contact_length")[0] = 20.3125;
  EXPECT_THAT(answers_table(result), HasSubstr("A               -0.1235  0.1235\n"
                                               "contact length        0    20.3\n"));
  values_of(result.sweep->columns, "displacement_lower")[0] = -1.23476e5;
  values_of(result.sweep->columns, "displacement_upper")[2] = -1e-7 + 1;
  values_of(result.sweep->columns, "contact_length")[0] = 1234.5;
  EXPECT_THAT(answers_table(result), HasSubstr("A               -123500     1\n"
                                               "contact length        0  1230\n"));
}

TEST(SweepTable, TellsOfManyInclusionsWhoseTheEndsAre) {
  results::Result result = sample_sweep(3);
  results::Sweep& sweep = *result.sweep;
  sweep.inclusions.clear();
  std::vector<double> displacement;
  for (int i = 0; i < 7; ++i) sweep.inclusions.push_back("rod" + std::to_string(i));
  for (int row = 0; row < 3; ++row)
    for (int i = 0; i < 7; ++i) displacement.push_back((i == 3 ? -2 : i) * (row + 1));
  sweep.columns["displacement"] = results::array_of(displacement, {7});
  EXPECT_THAT(answers_table(result), HasSubstr("                   least  of    most  of\n"
                                               "A of 7 inclusions     -6  rod3    18  rod6\n"));
  EXPECT_THAT(answers_table(result),
              HasSubstr("all inclusions: anticrack show RESULT --inclusions, or --csv FILE\n"));
  EXPECT_THAT(sweep_inclusions(sweep, {}), HasSubstr("A rod5      5    15\n"));
}

TEST(SweepTable, NamesSeveralInclusionsAndWhatWentWrong) {
  results::Result result = sample_sweep(3);
  results::Sweep& sweep = *result.sweep;
  sweep.inclusions = {"left", "ri\x1bght"};
  sweep.columns["displacement"] = results::array_of(std::vector<double>{1, 2, 3, 4, 5, 6}, {2});
  sweep.error = "row 1: \x1b[2J";
  set_status(result, 1, v1::LoadCaseAnswer::STATUS_FAILED);
  const std::string text = answers_table(result);
  EXPECT_THAT(text, HasSubstr("2 converged, 1 failed"));
  EXPECT_THAT(text, HasSubstr("A left"));
  EXPECT_THAT(text, HasSubstr("A ri?ght"));
  EXPECT_THAT(text, HasSubstr("row 1: ?[2J\n"));
}

TEST(SweepTable, HasNoNumbersWhereNothingConverged) {
  results::Result result = sample_sweep(3);
  for (std::size_t row = 0; row < 3; ++row) {
    set_status(result, row, v1::LoadCaseAnswer::STATUS_CANCELLED);
  }
  EXPECT_EQ(answers_table(result),
            "3 rows of ratio.csv: 0 converged, 3 were not solved\ntraces of 2 rows\n");
}

TEST(SweepJson, IsADocumentWithTheSameNumbers) {
  google::protobuf::Struct document;
  ASSERT_TRUE(
      google::protobuf::util::JsonStringToMessage(answers_json(tilting_sweep(5), "a.h5"), &document)
          .ok());
  const auto& sweep = document.fields().at("sweep").struct_value().fields();
  EXPECT_EQ(sweep.at("rows").number_value(), 5);
  EXPECT_EQ(sweep.at("converged").number_value(), 4);
  EXPECT_EQ(sweep.at("not_converged").number_value(), 1);
  EXPECT_EQ(sweep.at("source").string_value(), "ratio.csv");
  EXPECT_EQ(sweep.at("loads").list_value().values(1).string_value(), "opening");
  const auto& inclusion = sweep.at("inclusions").list_value().values(0).struct_value().fields();
  EXPECT_EQ(inclusion.at("name").string_value(), "fibre");
  EXPECT_EQ(inclusion.at("A").struct_value().fields().at("max").number_value(), 0.1);
  EXPECT_EQ(inclusion.at("By").struct_value().fields().at("min").number_value(), -0.5);
  EXPECT_EQ(document.fields().at("answers").list_value().values_size(), 2) << "the kept rows";
}

TEST(SweepJson, HasNullWhereNothingConverged) {
  results::Result result = sample_sweep(3);
  for (std::size_t row = 0; row < 3; ++row) {
    set_status(result, row, v1::LoadCaseAnswer::STATUS_FAILED);
  }
  EXPECT_THAT(answers_json(result, "a.h5"), HasSubstr("\"min\": null"));
}

TEST(SweepCsv, HasALinePerRow) {
  std::istringstream lines(sweep_csv(*sample_sweep(5).sweep));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "row,skew,opening,A,energy,contact_length,steps,status");
  std::getline(lines, line);
  EXPECT_THAT(line, ::testing::StartsWith("0,1,-1,-0.1,-2,"));
  EXPECT_THAT(line, ::testing::EndsWith(",2,converged"));
  for (int row = 1; row <= 3; ++row) {
    std::getline(lines, line);
  }
  EXPECT_EQ(line, "3,1,0.5,,,,5,not_converged") << "numbers that are not right are left out";
  std::getline(lines, line);
  EXPECT_FALSE(line.empty());
  EXPECT_FALSE(std::getline(lines, line));
}

TEST(SweepCsv, HasSlopesWhereAnInclusionTilts) {
  const std::string text = sweep_csv(*tilting_sweep(5).sweep);
  EXPECT_THAT(text, ::testing::StartsWith("row,skew,opening,A,Bx,By,energy,contact_length,steps,"
                                          "status\n0,1,-1,-0.1,-0.2,-0.5,-2,"));
  EXPECT_THAT(text, HasSubstr("\n3,1,0.5,,,,,,5,not_converged\n"));
}

TEST(SweepCsv, HasBoundsBesideWhatTheyAreOf) {
  results::Result result = anticrack::testing::bounded_sweep(5);
  values_of(result.sweep->columns, "displacement_lower")[0] = -0.125;
  values_of(result.sweep->columns, "displacement_upper")[0] = -0.0625;
  const std::string text = sweep_csv(*result.sweep);
  EXPECT_THAT(text, ::testing::StartsWith("row,skew,opening,A,A_lower,A_upper,A_mesh,energy,"
                                          "energy_lower,energy_upper,energy_mesh,contact_length,"
                                          "steps,status\n"
                                          "0,1,-1,-0.1,-0.125,-0.0625,-0.101,"));
  EXPECT_THAT(text, HasSubstr("\n3,1,0.5,,,,,,,,,,5,not_converged\n"));
  EXPECT_THAT(text, HasSubstr("\n4,1,1,0.1,,,0.099,-2,,,-2,"));
}

TEST(SweepCsv, GivesNumbersBackExactly) {
  results::Result result = sample_sweep(3);
  values_of(result.sweep->columns, "energy")[0] = 1.0 / 3;
  EXPECT_THAT(sweep_csv(*result.sweep), HasSubstr(",0.3333333333333333,"));
}

TEST(SweepCsv, LeavesCoefficientsOutThatAreNotKnown) {
  results::Result result = sample_sweep(3);
  result.sweep->columns.erase("coefficients");
  EXPECT_THAT(sweep_csv(*result.sweep), ::testing::StartsWith("row,A,energy,"));
}

}  // namespace
}  // namespace anticrack::cli
