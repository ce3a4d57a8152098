// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "results/result.hpp"

namespace anticrack::results {
namespace {

TEST(Units, follow_from_those_of_length_and_force) {
  const Units units{"mm", "N"};
  EXPECT_EQ(units.of("L"), "mm");
  EXPECT_EQ(units.of("F/L^2"), "N/mm^2");
  EXPECT_EQ(units.of("F L"), "N mm");
  EXPECT_EQ(units.of("s"), "s");
  EXPECT_EQ(labelled("x", units.label("L")), "x [mm]");
}

TEST(Units, are_not_made_up) {
  EXPECT_EQ((Units{"mm", ""}).of("F/L"), "-");
  EXPECT_EQ((Units{"", "N"}).of("F L"), "-");
  EXPECT_EQ(Units{}.of(""), "-");
  EXPECT_EQ(labelled("x", Units{}.label("L")), "x");
}

}  // namespace
}  // namespace anticrack::results
