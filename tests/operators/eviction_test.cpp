// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/eviction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace anticrack::operators {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Optional;

constexpr bool pinned = true;

TEST(Eviction, LeavesEverythingWhereThereIsRoom) {
  EXPECT_THAT(evictions({}, 100, 100), Optional(IsEmpty()));
  EXPECT_THAT(evictions({{40, 1, false}, {20, 2, pinned}}, 40, 100), Optional(IsEmpty()));
}

TEST(Eviction, TakesTheLeastRecentlyUsedFirstAndNoMoreThanNeeded) {
  const std::vector<Candidate> candidates = {{30, 9, false}, {30, 2, false}, {30, 5, false}};
  EXPECT_THAT(evictions(candidates, 11, 100), Optional(ElementsAre(1)));
  EXPECT_THAT(evictions(candidates, 40, 100), Optional(ElementsAre(1)));
  EXPECT_THAT(evictions(candidates, 41, 100), Optional(ElementsAre(1, 2)));
  EXPECT_THAT(evictions(candidates, 100, 100), Optional(ElementsAre(1, 2, 0)));
}

TEST(Eviction, PassesOverPinnedOnes) {
  const std::vector<Candidate> candidates = {{30, 1, pinned}, {30, 2, false}, {30, 3, false}};
  EXPECT_THAT(evictions(candidates, 30, 100), Optional(ElementsAre(1)));
  EXPECT_THAT(evictions(candidates, 70, 100), Optional(ElementsAre(1, 2)));
}

TEST(Eviction, EvictsNothingWhereItWouldNotHelp) {
  EXPECT_EQ(evictions({{60, 1, pinned}, {40, 2, false}}, 41, 100), std::nullopt);
  EXPECT_EQ(evictions({{40, 1, false}}, 101, 100), std::nullopt);
  EXPECT_EQ(evictions({{40, 1, false}}, UINT64_MAX, 100), std::nullopt);
}

}  // namespace
}  // namespace anticrack::operators
