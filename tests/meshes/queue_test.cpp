// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/queue.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace anticrack::meshes {
namespace {

using records::Priority;
using namespace std::chrono_literals;

class QueueTest : public ::testing::Test {
 protected:
  std::uint64_t add(const std::string& owner = {}, int size_class = 0,
                    Priority priority = Priority::normal) {
    return queue.add(owner, size_class, priority, now);
  }
  /// As add(), for somebody who holds the operators until he has begun with them.
  std::uint64_t awaited(const std::string& owner = {}, int size_class = 0,
                        Priority priority = Priority::normal) {
    const std::uint64_t number = add(owner, size_class, priority);
    queue.await(number, priority, now);
    return number;
  }
  /// The next one, which is done at once; 0: none.
  std::uint64_t pass() {
    const auto number = queue.next(now);
    if (number) queue.done(*number);
    return number.value_or(0);
  }
  std::uint64_t next() { return queue.next(now).value_or(0); }
  void made(std::uint64_t number) {
    queue.hold(number);
    queue.done(number);
  }

  Queue::Time now = std::chrono::steady_clock::time_point(1000h);
  Queue queue;
};

TEST_F(QueueTest, GivesThreadsToTwoOfASizeInTheirOrder) {
  const std::uint64_t first = add(), second = add(), third = add();
  EXPECT_EQ(next(), first);
  EXPECT_EQ(next(), second);
  EXPECT_EQ(next(), 0U);
  const std::uint64_t small = add({}, 5);
  EXPECT_EQ(next(), small) << "meshes of one size hold up none of another";
  queue.done(first);
  EXPECT_EQ(next(), third);
  const std::uint64_t given_up = add();
  queue.remove(given_up);
  queue.done(second);
  EXPECT_EQ(next(), 0U);
}

TEST_F(QueueTest, MeshesOfOneOwnerHoldUpNoneOfAnother) {
  for (int i = 0; i < 4; ++i) add("greedy");
  EXPECT_TRUE(next() && next());
  EXPECT_FALSE(next());
  const std::uint64_t modest = add("modest");
  add("modest");
  EXPECT_EQ(next(), modest);
  EXPECT_FALSE(next()) << "a newcomer has one place";
  const std::uint64_t third = add("third");
  EXPECT_EQ(next(), third);
  add("fourth");
  EXPECT_FALSE(next()) << "twice the limit is all";
}

TEST_F(QueueTest, MakesNoMoreAheadThanArePinned) {
  std::vector<std::uint64_t> all;
  for (int i = 0; i < 5; ++i) all.push_back(awaited("greedy"));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(next(), all[static_cast<std::size_t>(i)]);
    made(all[static_cast<std::size_t>(i)]);
  }
  EXPECT_EQ(next(), 0U) << "nobody has begun with these";
  const std::uint64_t background = add("greedy");
  EXPECT_EQ(next(), background) << "which nobody awaits, so nothing is pinned";
  const std::uint64_t modest = awaited("modest");
  EXPECT_EQ(next(), modest);
  queue.done(modest);
  queue.let_go(all[1]);
  EXPECT_EQ(next(), all[3]);
  EXPECT_EQ(next(), 0U);
}

TEST_F(QueueTest, APlaceIsHeldUntilTheLastLetsGo) {
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t number = awaited();
    EXPECT_EQ(next(), number);
    queue.hold(number);
    made(number);
    if (i == 0) queue.let_go(number);
  }
  const std::uint64_t last = awaited();
  EXPECT_EQ(next(), 0U);
  queue.let_go(1);
  EXPECT_EQ(next(), last);
}

TEST_F(QueueTest, TheMoreUrgentGoesFirstAndWaitingIsWorthAClass) {
  const std::uint64_t bulk = awaited({}, 0, Priority::bulk);
  now += 29s;
  const std::uint64_t normal = awaited(), urged = awaited();
  queue.await(urged, Priority::interactive, now);
  EXPECT_EQ(pass(), urged);
  now += 1s;
  EXPECT_EQ(pass(), normal) << "the bulk one has waited since the last start only";
  now += 30s;
  awaited();
  EXPECT_EQ(pass(), bulk);
}

TEST_F(QueueTest, OwnersTakeTurnsHoweverLongTheirsHaveWaited) {
  for (int i = 0; i < 4; ++i) awaited("greedy");
  now += 10min;
  EXPECT_EQ(pass(), 1U);
  const std::uint64_t modest = awaited("modest");
  EXPECT_EQ(pass(), modest);
  EXPECT_EQ(pass(), 2U);
}

}  // namespace
}  // namespace anticrack::meshes
