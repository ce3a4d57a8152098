// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/deadlines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace anticrack::jobs {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using namespace std::chrono_literals;

const Deadlines::Time now{1'000h};

TEST(Deadlines, ComeInTheirOrder) {
  Deadlines deadlines;
  EXPECT_FALSE(deadlines.next());
  deadlines.set(1, Due::queue_time, now + 3s);
  deadlines.set(2, Due::run_time, now + 1s);
  deadlines.set(3, Due::start, now + 2s);
  EXPECT_EQ(deadlines.next(), now + 1s);
  EXPECT_THAT(deadlines.take(now), IsEmpty());
  EXPECT_THAT(deadlines.take(now + 2s), ElementsAre(Pair(2, Due::run_time), Pair(3, Due::start)));
  EXPECT_EQ(deadlines.next(), now + 3s);
}

TEST(Deadlines, AreReplacedAndCleared) {
  Deadlines deadlines;
  deadlines.set(1, Due::queue_time, now + 1s);
  deadlines.set(1, Due::queue_time, now + 5s);
  EXPECT_EQ(deadlines.next(), now + 5s);
  deadlines.set(1, Due::start, now + 2s);
  deadlines.clear(1, Due::queue_time);
  EXPECT_EQ(deadlines.next(), now + 2s);
  deadlines.set(2, Due::run_time, now + 3s);
  deadlines.clear(1);
  EXPECT_THAT(deadlines.take(now + 1h), ElementsAre(Pair(2, Due::run_time)));
  EXPECT_FALSE(deadlines.next());
}

}  // namespace
}  // namespace anticrack::jobs
