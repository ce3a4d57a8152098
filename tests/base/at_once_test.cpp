// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/at_once.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <latch>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace anticrack::base {
namespace {

using ::testing::Each;
using ::testing::SizeIs;

void count_each(int threads, std::vector<int>& times) {
  at_once(times.size(), threads, [&] { return [&](std::size_t i) { ++times[i]; }; });
}

/// What `tell` says on each of so many threads that work at the same time.
template <class Tell>
auto together(std::size_t threads, const Tell& tell) {
  std::vector<decltype(tell())> told(threads);
  std::latch all(static_cast<std::ptrdiff_t>(threads));
  at_once(threads, static_cast<int>(threads), [&] {
    return [&](std::size_t i) {
      all.arrive_and_wait();
      told[i] = tell();
    };
  });
  return told;
}

TEST(AtOnce, DoesEachIndexOnce) {
  for (const std::size_t count : {0, 1, 2, 7, 1000}) {
    std::vector<int> times(count);
    for (int round = 0; round < 200; ++round) count_each(1 + round % 5, times);
    EXPECT_THAT(times, Each(200)) << count;
  }
}

TEST(AtOnce, ServesManyCallersAndLoopsInLoops) {
  std::array<std::vector<int>, 4> times;
  {
    std::vector<std::jthread> callers;
    for (std::vector<int>& own : times) {
      own.resize(3 * 50);
      callers.emplace_back([&own] {
        for (int round = 0; round < 100; ++round)
          at_once(3, 3, [&] {
            return [&](std::size_t i) {
              at_once(50, 2, [&] { return [&](std::size_t k) { ++own[50 * i + k]; }; });
            };
          });
      });
    }
  }
  for (const std::vector<int>& own : times) EXPECT_THAT(own, Each(100));
}

TEST(AtOnce, RethrowsAndServesTheNextLoop) {
  for (int round = 0; round < 100; ++round) {
    const auto fail = [](std::size_t i) {
      if (i == 3) throw std::runtime_error("the third");
    };
    EXPECT_THROW(at_once(8, 3, [&] { return fail; }), std::runtime_error);
    std::vector<int> times(8);
    count_each(3, times);
    EXPECT_THAT(times, Each(1));
  }
}

TEST(AtOnce, UsesItsThreadsAgain) {
  std::set<pid_t> threads;
  for (int round = 0; round < 50; ++round)
    for (const pid_t one : together(2, [] { return ::gettid(); })) threads.insert(one);
  // The caller's, and those that waited when it began.
  EXPECT_THAT(threads, SizeIs(::testing::Le(1 + 2 * std::thread::hardware_concurrency())));
}

TEST(AtOnce, HelpsWithThePriorityOfTheCaller) {
  const auto niceness = [] { return ::getpriority(PRIO_PROCESS, 0); };
  const int own = niceness(), lower = own + 1;
  EXPECT_THAT(together(2, niceness), Each(own));
  std::jthread([&] {
    ASSERT_EQ(::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), lower), 0);
    EXPECT_THAT(together(2, niceness), Each(lower));
  }).join();
  EXPECT_THAT(together(2, niceness), Each(own));
}

}  // namespace
}  // namespace anticrack::base
