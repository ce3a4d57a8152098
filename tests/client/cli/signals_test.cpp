// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/signals.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include "support/eventually.hpp"

namespace anticrack::cli {
namespace {

using anticrack::testing::eventually;

TEST(Signals, CountCtrlC) {
  Signals signals;
  EXPECT_FALSE(signals.first().stop_requested());
  kill(getpid(), SIGINT);
  EXPECT_TRUE(eventually([&] { return signals.first().stop_requested(); }));
  EXPECT_FALSE(signals.second().stop_requested());
  EXPECT_FALSE(signals.second_within(std::chrono::milliseconds(0)));
  kill(getpid(), SIGINT);
  EXPECT_TRUE(signals.second_within(std::chrono::minutes(2)));
  EXPECT_TRUE(eventually([&] { return signals.second().stop_requested(); }));
}

TEST(Signals, OfAnAbsentUserAreNotWaitedForTwice) {
  Signals signals;
  kill(getpid(), SIGTERM);
  EXPECT_TRUE(eventually([&] { return signals.first().stop_requested(); }));
  // Would outlast the time limit of the test if it waited.
  EXPECT_FALSE(signals.second_within(std::chrono::hours(10)));
}

TEST(Signals, AreGivenBack) {
  { const Signals signals; }
  sigset_t blocked;
  sigemptyset(&blocked);
  pthread_sigmask(SIG_BLOCK, nullptr, &blocked);
  EXPECT_EQ(sigismember(&blocked, SIGINT), 0);
}

}  // namespace
}  // namespace anticrack::cli
