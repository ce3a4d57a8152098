// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "words/duration.hpp"

namespace anticrack::words {
namespace {

using std::chrono::milliseconds;

TEST(Duration, IsSecondsOrHasAUnit) {
  EXPECT_EQ(parse_duration("90"), milliseconds(90'000));
  EXPECT_EQ(parse_duration("0.5 s"), milliseconds(500));
  EXPECT_EQ(parse_duration("250ms"), milliseconds(250));
  EXPECT_EQ(parse_duration("1.5min"), milliseconds(90'000));
  EXPECT_EQ(parse_duration("2 h"), milliseconds(7'200'000));
  EXPECT_EQ(parse_duration("1d"), milliseconds(86'400'000));
}

TEST(Duration, IsAboveZeroAndBounded) {
  for (const char* bad :
       {"", "s", "0", "-1", "nan", "inf", "1e300", "400d", "5 minutes", "1h30", "0.0001", " 1"}) {
    EXPECT_FALSE(parse_duration(bad).has_value()) << bad;
  }
}

}  // namespace
}  // namespace anticrack::words
