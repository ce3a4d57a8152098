// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/signals.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>

#include "support/eventually.hpp"

namespace anticrack::cli {
namespace {

using anticrack::testing::eventually;

TEST(Signals, CountCtrlC) {
  Signals signals;
  EXPECT_FALSE(signals.first().stop_requested());
  kill(getpid(), SIGINT);
  EXPECT_TRUE(eventually([&] { return signals.first().stop_requested(); }));
  EXPECT_TRUE(signals.wait_for_first({}));
  EXPECT_TRUE(signals.interactive());
  EXPECT_FALSE(signals.second_within(std::chrono::milliseconds(0)));
  kill(getpid(), SIGINT);
  EXPECT_TRUE(signals.second_within(std::chrono::minutes(2)));
}

TEST(Signals, AreWaitedForNoLongerThanAskedFor) {
  Signals signals;
  std::stop_source over;
  over.request_stop();
  // Either would outlast the time limit of the test.
  EXPECT_FALSE(signals.wait_for_first(over.get_token()));
  EXPECT_FALSE(signals.second_within(std::chrono::hours(10), over.get_token()));
}

TEST(Signals, ThatWereIgnoredStayIgnored) {
  signal(SIGHUP, SIG_IGN);  // as nohup does
  Signals signals;
  kill(getpid(), SIGHUP);
  kill(getpid(), SIGINT);
  EXPECT_TRUE(signals.wait_for_first({}));
  EXPECT_TRUE(signals.interactive()) << "only Ctrl-C was heard";
  signal(SIGHUP, SIG_DFL);
}

TEST(Signals, TellOfTheScreen) {
  std::atomic<int> resized = 0;
  std::atomic<int> back = 0;
  Signals signals;
  signals.tell_screen(
      [&](Signals::Screen event) { ++(event == Signals::Screen::resized ? resized : back); });
  kill(getpid(), SIGWINCH);
  EXPECT_TRUE(eventually([&] { return resized == 1; }));
  kill(getpid(), SIGCONT);
  EXPECT_TRUE(eventually([&] { return back == 1; }));
  signals.tell_screen({});
}

TEST(Signals, OfAnAbsentUserAreNotWaitedForTwice) {
  Signals signals;
  kill(getpid(), SIGTERM);
  EXPECT_TRUE(eventually([&] { return signals.first().stop_requested(); }));
  // Would outlast the time limit of the test if it waited.
  EXPECT_FALSE(signals.second_within(std::chrono::hours(10)));
  EXPECT_FALSE(signals.interactive());
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
