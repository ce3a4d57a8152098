// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/sample_result.hpp"

namespace anticrack::results {
namespace {

using anticrack::testing::units_of;

TEST(Units, follow_from_those_of_length_and_force) {
  const v1::Units units = units_of("mm", "N");
  EXPECT_EQ(unit_of(units, "L"), "mm");
  EXPECT_EQ(unit_of(units, "F/L^2"), "N/mm^2");
  EXPECT_EQ(unit_of(units, "F L"), "N mm");
  EXPECT_EQ(unit_of(units, "s"), "s");
  EXPECT_EQ(labelled("x", units, "L"), "x [mm]");
}

TEST(Units, are_not_made_up) {
  EXPECT_EQ(unit_of(units_of("mm", ""), "F/L"), "-");
  EXPECT_EQ(unit_of(units_of("", "N"), "F L"), "-");
  EXPECT_EQ(unit_of({}, ""), "-");
  EXPECT_EQ(labelled("x", {}, "L"), "x");
}

}  // namespace
}  // namespace anticrack::results
