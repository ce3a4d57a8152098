// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/result.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

namespace anticrack::results {
namespace {

TEST(Interval, is_the_text_that_python_writes) {
  std::ifstream cases(ANTICRACK_SAME "/intervals.txt");
  int count = 0;
  for (std::string line; std::getline(cases, line);) {
    if (line.starts_with("#")) continue;
    std::istringstream numbers(line);
    double lower = 0, upper = 0;
    ASSERT_TRUE(numbers >> lower >> upper) << line;
    EXPECT_EQ(interval(lower + 0.5 * (upper - lower), lower, upper),
              line.substr(line.find("| ") + 2))
        << line;
    ++count;
  }
  EXPECT_GT(count, 10);
}

TEST(Interval, is_a_dash_where_an_end_is_not_known) {
  EXPECT_EQ(interval(0, std::nan(""), 1), "-");
  EXPECT_EQ(interval(0, 0, HUGE_VAL), "-");
}

}  // namespace
}  // namespace anticrack::results
