// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "access/share.hpp"
#include "access/turn_queue.hpp"

namespace anticrack::access {
namespace {

/// What each of them gets who takes all that is given, one after the other.
std::vector<std::uint64_t> taken(std::size_t users, std::uint64_t all) {
  std::vector<std::uint64_t> own(users);
  std::uint64_t used = 0;
  for (std::uint64_t& mine : own)
    for (; may_have(mine, 1, used, all); ++used) ++mine;
  return own;
}

TEST(Share, LeavesAsMuchFreeAsEachHas) {
  using ::testing::ElementsAre;
  EXPECT_THAT(taken(1, 64), ElementsAre(32));
  EXPECT_THAT(taken(3, 64), ElementsAre(32, 16, 8));
  EXPECT_THAT(taken(2, 1), ElementsAre(1, 0));
  EXPECT_THAT(taken(3, 2), ElementsAre(1, 1, 0));
  EXPECT_EQ(share(6, 6, 12), 6U);
  EXPECT_EQ(share(1, 9, 12), 2U);
  EXPECT_EQ(share(0, 20, 12), 0U);
  EXPECT_FALSE(may_have(0, 3, 0, 2));
  EXPECT_FALSE(may_have(0, 1, 5, 2));  // more is used than there is
}

TEST(TurnQueue, GoesRoundItsUsers) {
  TurnQueue<int> queue;
  for (int i = 0; i < 3; ++i) queue.push("greedy", i);
  queue.push("modest", 10);
  EXPECT_EQ(queue.size_of("greedy"), 3U);
  EXPECT_EQ(queue.size_of("nobody"), 0U);
  EXPECT_EQ(queue.pop(), 0);
  EXPECT_EQ(queue.pop(), 10);
  queue.push("modest", 11);
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), 11);
  EXPECT_EQ(queue.pop(), 2);
  EXPECT_TRUE(queue.empty());
}

}  // namespace
}  // namespace anticrack::access
