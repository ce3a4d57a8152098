// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/signals.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <thread>

namespace anticrack::app {
namespace {

TEST(Signals, AreWaitedForWhicheverThreadGetsThem) {
  const Signals signals;
  std::thread([] { ::raise(SIGTERM); }).join();
  EXPECT_EQ(signals.wait(), SIGTERM);
  ::raise(SIGINT);
  EXPECT_EQ(signals.wait(), SIGINT);
  ::raise(SIGPIPE);  // ignored
  EXPECT_EQ(signals.wait_for(std::chrono::milliseconds(1)), std::nullopt);
  ::raise(SIGHUP);
  EXPECT_EQ(signals.wait(), SIGHUP);
  ::raise(SIGTERM);
  EXPECT_EQ(signals.wait_for(std::chrono::hours(1)), SIGTERM);
}

TEST(Signals, LetWorkEnd) {
  const Signals signals;
  bool done = false;
  signals.run_unless_interrupted([&] {
    ::raise(SIGHUP);  // there is nothing to read again any more
    done = true;
  });
  EXPECT_TRUE(done);
}

TEST(SignalsDeathTest, EndTheProcessWhenTheyComeDuringWork) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        const Signals signals;
        signals.run_unless_interrupted([] {
          ::raise(SIGINT);
          std::this_thread::sleep_for(std::chrono::hours(1));
        });
      },
      ::testing::ExitedWithCode(128 + SIGINT), "");
}

}  // namespace
}  // namespace anticrack::app
