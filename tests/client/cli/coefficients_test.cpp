// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_input.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

namespace anticrack::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<double> parse_rows(const std::string& text,
                               const std::vector<std::string>& loads = {"skew", "opening"}) {
  std::istringstream stream(text);
  return parse_coefficients(stream, "c.csv", loads);
}

TEST(Coefficients, AreInTheOrderOfTheLoadsWithoutAHeader) {
  EXPECT_THAT(parse_rows("1,2\n3,4\n"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(parse_rows("1,2\n3,4"), ElementsAre(1, 2, 3, 4)) << "no line end at the end";
}

TEST(Coefficients, FollowTheirHeader) {
  EXPECT_THAT(parse_rows("opening,skew\n1,2\n"), ElementsAre(2, 1));
  EXPECT_THAT(parse_rows("\"opening\" , \"skew\"\r\n1 , \"2\"\r\n"), ElementsAre(2, 1));
}

TEST(Coefficients, OfLoadsThatAreCalledLikeNumbersHaveAHeaderToo) {
  EXPECT_THAT(parse_rows("90,0\n1,2\n", {"0", "90"}), ElementsAre(2, 1));
  EXPECT_THAT(parse_rows("1,2\n", {"0", "90"}), ElementsAre(1, 2));
}

TEST(Coefficients, TakeNumbersAsPeopleAndProgramsWriteThem) {
  EXPECT_THAT(parse_rows("+1,-2e-3\n.5,1E3\n\t0 , 1e-400\n"),
              ElementsAre(1, -2e-3, 0.5, 1000, 0, 0));
}

TEST(Coefficients, MayHaveSemicolonsBetween) {
  EXPECT_THAT(parse_rows("1;2\n3.5;-4e-1\n"), ElementsAre(1, 2, 3.5, -0.4));
  EXPECT_THAT(parse_rows("opening;skew\r\n1 ; \"2\"\r\n"), ElementsAre(2, 1));
}

TEST(Coefficients, MayHaveDecimalCommasBetweenSemicolons) {
  EXPECT_THAT(parse_rows("1,5;2\n-3,25e-1;\"4,5\"\n"), ElementsAre(1.5, 2, -0.325, 4.5));
  EXPECT_THAT(parse_rows("opening;skew\n1,5;,5\n"), ElementsAre(0.5, 1.5));
}

TEST(Coefficients, PassOverBlankLinesCommentsAndAByteOrderMark) {
  EXPECT_THAT(parse_rows("\xEF\xBB\xBF# made by a script\n\nskew,opening\n  \n1,2\n# the end\n"),
              ElementsAre(1, 2));
}

TEST(Coefficients, MayBeOfOneLoad) {
  EXPECT_THAT(parse_rows("opening\n1\n2\n", {"opening"}), ElementsAre(1, 2));
}

struct Bad {
  std::string text;
  std::vector<std::string> complaint;  ///< parts of it
};

TEST(Coefficients, RefuseWhatIsNoMatrixWithLineColumnValueAndCure) {
  const std::vector<Bad> table{
      {"", {"c.csv: there is no row; write a line of 2 coefficients"}},
      {"skew,opening\n", {"c.csv: there is no row"}},
      {"# nothing\n", {"there is no row"}},
      {"1,2\n1,x\n", {"c.csv:2: column 2: ", "\"x\" is not a number; write one as 1.5 or -2e-3"}},
      {"1,2\n1,\n", {"c.csv:2: column 2: ", "\"\" is not a number"}},
      {"1,2\n1,2,3\n", {"c.csv:2: 3 values in this line, the case has 2 loads", "skew, opening"}},
      {"1,2\n1\n", {"c.csv:2: 1 value in this line"}},
      {"1,2\n1;2\n", {"c.csv:2: 1 value in this line", "with commas between"}},
      {"1,2\n1,2;3\n", {"c.csv:2: column 2: \"2;3\" is not a number; the first line has no sem"}},
      {"1;2\n1,2\n", {"c.csv:2: 1 value in this line", "with semicolons between"}},
      {"1;2;3\n", {"c.csv:1: 3 values in this line", "with semicolons between"}},
      {"1;2;\n", {"c.csv:1: 3 values in this line"}},
      {"1;x\n", {"c.csv:1: column 2: \"x\" is not a number; write one as 1.5"}},
      {"1,5;2\n3;4.5\n",
       {"c.csv:2: column 2: \"4.5\" has a decimal point, line 1 has decimal commas; write all"}},
      {"1.5;2,5\n", {"c.csv:1: column 2: \"2,5\" has a decimal comma, line 1 has decimal points"}},
      {"1;1.234,5\n", {"c.csv:1: column 2: \"1.234,5\" is not a number"}},
      {"1;1,234,5\n", {"\"1,234,5\" is not a number"}},
      {"skew;openig\n1;2\n", {"c.csv:1: column 2: \"openig\" is not a load of the case; did you"}},
      {"1,nan\n", {"c.csv:1: column 2: ", "\"nan\" is not finite; write a finite number"}},
      {"1,inf\n", {"\"inf\" is not finite"}},
      {"1,1e999\n", {"\"1e999\" is not finite"}},
      {"1,0x10\n", {"\"0x10\" is not a number"}},
      {"1,2 3\n", {"\"2 3\" is not a number"}},
      {"skew,openig\n1,2\n",
       {"c.csv:1: column 2: ", "\"openig\" is not a load of the case; did you mean opening?"}},
      {"skew,skew\n1,2\n", {"c.csv:1: column 2: ", "load skew is named twice"}},
      {"skew\n1\n", {"c.csv:1: there is no column for load opening; add one"}},
      {"\n# x\n1,2\n3,y\n", {"c.csv:4: column 2: "}},
      {"1," + std::string(1000, 'z') + "\n", {"zzz...\" is not a number"}},
      {std::string("1,\0002\n", 5), {"is not a number"}},
  };
  for (const Bad& bad : table) {
    try {
      parse_rows(bad.text);
      ADD_FAILURE() << "accepted " << bad.text;
    } catch (const CaseError& error) {
      for (const std::string& part : bad.complaint) {
        EXPECT_THAT(error.what(), HasSubstr(part)) << bad.text;
      }
    }
  }
}

}  // namespace
}  // namespace anticrack::cli
