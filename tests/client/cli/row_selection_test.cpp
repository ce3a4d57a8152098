// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_input.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "cli/report.hpp"

namespace anticrack::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(SelectRows, TakesNumbersAndRanges) {
  EXPECT_THAT(select_rows("0,10,20-22", 100), ElementsAre(0, 10, 20, 21, 22));
  EXPECT_THAT(select_rows("7", 8), ElementsAre(7));
  EXPECT_THAT(select_rows("3-3", 8), ElementsAre(3));
}

TEST(SelectRows, GivesEachOnceAndInOrder) {
  EXPECT_THAT(select_rows("5,1-3,2-4,5,0", 100), ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(SelectRows, TakesAllAndNone) {
  EXPECT_THAT(select_rows("all", 3), ElementsAre(0, 1, 2));
  EXPECT_THAT(select_rows("none", 3), IsEmpty());
  EXPECT_THAT(select_rows("all", 0), IsEmpty());
}

TEST(SelectRows, RefusesWhatIsNoSelectionWithTheCure) {
  const std::vector<std::pair<std::string, std::string>> table{
      {"", "\"\" is not a row; write all, none, or rows, for example 0,10,20-30"},
      {"first", "\"first\" is not a row"},
      {"1,,2", "\"\" is not a row"},
      {"1,", "\"\" is not a row"},
      {"-1", "\"-1\" is not a row"},
      {"1-", "\"1-\" is not a row"},
      {"1-2-3", "\"1-2-3\" is not a row"},
      {"1.5", "\"1.5\" is not a row"},
      {" 1", "\" 1\" is not a row"},
      {"0x1", "\"0x1\" is not a row"},
      {"100", "there is no row 100; rows are 0 to 99"},
      {"5-100", "there is no row 100"},
      {"99999999999999999999", "there is no row 99999999999999999999"},
      {"0-18446744073709551615", "there is no row 18446744073709551615"},
      {"9-3", "the range 9-3 ends before it begins; write 3-9"},
  };
  for (const auto& [text, complaint] : table) {
    try {
      select_rows(text, 100);
      ADD_FAILURE() << "accepted " << text;
    } catch (const CaseError& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint));
      EXPECT_THAT(error.what(), HasSubstr("--traces " + text)) << "where it was written";
    }
  }
}

}  // namespace
}  // namespace anticrack::cli
