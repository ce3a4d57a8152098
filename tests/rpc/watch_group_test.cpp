// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/watch_group.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>

#include "support/eventually.hpp"

namespace anticrack::rpc {
namespace {

using namespace std::chrono_literals;
using anticrack::testing::eventually;

struct WatchGroupTest : ::testing::Test {
  StreamHub hub{{1, 1, 1, 10s, 60s}};
  WatchGroups groups{hub};
  std::shared_ptr<jobs::EventLog> log = std::make_shared<jobs::EventLog>(std::size_t{1} << 20);
};

TEST_F(WatchGroupTest, IsOneForAJobAndGoesWithItsLastWatch) {
  auto first = groups.of(log);
  EXPECT_EQ(groups.of(log), first);
  const auto other = std::make_shared<jobs::EventLog>(std::size_t{1} << 20);
  EXPECT_NE(groups.of(other), first);
  const std::weak_ptr<WatchGroup> gone = first;
  first.reset();
  EXPECT_TRUE(eventually([&] { return gone.expired(); }));  // the hub may hold it for a moment
  log->append(jobs::SampleEvent());
  EXPECT_EQ(groups.of(log)->target(), log->latest());
}

TEST_F(WatchGroupTest, WakesManyEventsAFewTimesAndMissesNone) {
  const auto group = groups.of(log);
  std::atomic<int> wakes = 0;
  const auto member = group->join([&] { ++wakes; });
  const int events = 10'000;
  for (int i = 0; i < events; ++i) log->append(jobs::SampleEvent());
  EXPECT_TRUE(eventually([&] { return group->target() == log->latest(); }));
  log->append(jobs::SampleEvent());
  EXPECT_TRUE(eventually([&] { return group->target() == log->latest(); }));
  EXPECT_TRUE(eventually([&] { return wakes > 0; }));
  group->leave(member);
  EXPECT_LT(wakes, events);
  const int before = wakes;
  log->append(jobs::SampleEvent());
  EXPECT_TRUE(eventually([&] { return group->target() == log->latest(); }));
  EXPECT_EQ(wakes, before);
}

}  // namespace
}  // namespace anticrack::rpc
