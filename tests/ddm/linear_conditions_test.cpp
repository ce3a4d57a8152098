// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small algebra that can be followed by hand.
#include "ddm/linear_conditions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

namespace anticrack::ddm {

bool operator==(const Term& a, const Term& b) {
  return a.index == b.index && std::abs(a.factor - b.factor) < 1e-15;
}
void PrintTo(const Term& term, std::ostream* out) { *out << term.factor << " of " << term.index; }

namespace {

void expect_row(const Row& row, const Terms& free, const Terms& jumps, const Terms& held) {
  EXPECT_EQ(row.free, free);
  EXPECT_EQ(row.jumps, jumps);
  EXPECT_EQ(row.held, held);
}

/// x_1 = x_0, x_2 = x_1 + d_0: what is free is x_0 and x_3, the second of q.
TEST(LinearConditions, FollowersAndJumpsGoThroughOneAnother) {
  LinearConditions conditions(4, 1);
  conditions.follow(1, {{0, 1}});
  EXPECT_EQ(conditions.part(2, 1, 0), std::nullopt);
  std::size_t free = 0;
  const std::vector<Row> rows = conditions.rows(free);
  ASSERT_EQ(free, 2U);
  expect_row(rows[0], {{0, 1}}, {}, {});
  expect_row(rows[1], {{0, 1}}, {}, {});
  expect_row(rows[2], {{0, 1}}, {{0, 1}}, {});
  expect_row(rows[3], {{1, 1}}, {}, {});
}

/// Of two unknowns the last is eliminated, whichever side it is on; of motions the first.
TEST(LinearConditions, MotionsAreEliminatedLast) {
  LinearConditions conditions(3, 2);
  EXPECT_EQ(conditions.part(1, 2, 0), std::nullopt);  // x_2 = x_1 - d_0
  EXPECT_EQ(conditions.part(0, 2, 1), std::nullopt);  // x_0 - x_1 + d_0 = d_1
  std::size_t free = 0;
  const std::vector<Row> rows = conditions.rows(free);
  ASSERT_EQ(free, 1U);
  expect_row(rows[0], {{0, 1}}, {{0, -1}, {1, 1}}, {});
  expect_row(rows[1], {{0, 1}}, {}, {});
  expect_row(rows[2], {{0, 1}}, {{0, -1}}, {});
}

/// The larger factor is the pivot: A + 0.25 C = p gives A, 0.25 A + C = p gives C.
TEST(LinearConditions, AHeldMotionIsSolvedForTheLargestFactor) {
  for (const bool first : {true, false}) {
    LinearConditions conditions(2, 2);
    const double of_first = first ? 1 : 0.25, of_second = first ? 0.25 : 1;
    EXPECT_EQ(conditions.hold({{0, of_first}, {1, of_second}}, 0), Terms{});
    std::size_t free = 0;
    const std::vector<Row> rows = conditions.rows(free);
    ASSERT_EQ(free, 1U);
    expect_row(rows[first ? 0 : 1], {{0, -0.25}}, {}, {{0, 1}});
    expect_row(rows[first ? 1 : 0], {{0, 1}}, {}, {});
  }
}

/// A body with A and C held in three places: two decide, the third must agree.
TEST(LinearConditions, WhatIsHeldOnceMoreMustAgree) {
  LinearConditions conditions(3, 2);
  conditions.follow(2, {{0, 1}, {1, 0.5}});
  EXPECT_EQ(conditions.hold({{0, 1}, {1, -1}}, 0), Terms{});
  EXPECT_EQ(conditions.hold({{0, 1}, {1, 1}}, 1), Terms{});
  // A = (p_0 + p_1) / 2 in the middle
  EXPECT_EQ(conditions.hold({{0, 1}}, 2), (Terms{{0, 0.5}, {1, 0.5}, {2, -1}}));
  std::size_t free = 0;
  const std::vector<Row> rows = conditions.rows(free);
  EXPECT_EQ(free, 0U);
  expect_row(rows[1], {}, {}, {{0, -0.5}, {1, 0.5}});
  expect_row(rows[2], {}, {}, {{0, 0.25}, {1, 0.75}});
}

/// Four faces round a cross point: three jumps are their own, the fourth is minus their sum.
TEST(LinearConditions, TheLastJumpRoundAPointDependsOnTheOthers) {
  LinearConditions conditions(4, 0);
  EXPECT_EQ(conditions.part(1, 0, 0), std::nullopt);
  EXPECT_EQ(conditions.part(2, 1, 1), std::nullopt);
  EXPECT_EQ(conditions.part(2, 3, 2), std::nullopt);
  EXPECT_EQ(conditions.part(3, 0, 3), (Terms{{0, 1}, {1, 1}, {2, -1}}));
  std::size_t free = 0;
  EXPECT_EQ(conditions.rows(free)[3].jumps, (Terms{{0, 1}, {1, 1}, {2, -1}}));
  EXPECT_EQ(free, 1U);
}

/// Two unknowns that follow the same motion cannot part.
TEST(LinearConditions, AJumpBetweenFollowersOfOneMotionIsNone) {
  LinearConditions conditions(4, 2);
  conditions.follow(2, {{0, 1}, {1, 0.1 + 0.2}});
  conditions.follow(3, {{0, 1}, {1, 0.3}});  // another rounding
  EXPECT_EQ(conditions.part(3, 2, 0), Terms{});
}

}  // namespace
}  // namespace anticrack::ddm
