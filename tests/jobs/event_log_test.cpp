// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/event_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <future>
#include <mutex>
#include <thread>

#include "jobs/event_log_support.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::throws;
using errors::Reason;
using ::testing::IsEmpty;

TEST(EventLog, IsEmptyAtFirst) {
  const EventLog log(roomy);
  EXPECT_EQ(log.earliest(), 1U);
  EXPECT_EQ(log.latest(), 0U);
  EXPECT_THAT(log.read(0, 10), IsEmpty());
  EXPECT_TRUE(throws([&] { log.read(1, 10); }, Reason::sequence_trimmed));
}

TEST(EventLog, GivesBackEveryValueOfASample) {
  EventLog log(roomy);
  log.append(sample(7, 41));
  const auto events = log.read(0, 10);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].sequence, 1U);
  const auto& read = std::get<SampleEvent>(events[0].event);
  EXPECT_EQ(read.load_case, 7);
  EXPECT_EQ(read.sample.iteration, 41);
  EXPECT_EQ(read.sample.contact_count, 41 % 7);
  EXPECT_EQ(read.sample.criterion, 1.0 / 41);
  EXPECT_EQ(read.sample.energy, -41);
  EXPECT_EQ(read.sample.kkt.equilibrium, 41 + 0.1);
  EXPECT_EQ(read.sample.kkt.gap, 41 + 0.2);
  EXPECT_EQ(read.sample.kkt.sign, 41 + 0.3);
  EXPECT_EQ(read.sample.kkt.complementarity, 41 + 0.4);
}

TEST(EventLog, ReadsMixedEventsInOrderFromAnywhere) {
  EventLog log(roomy);
  for (int i = 1; i <= 1000; ++i) {
    log.append(mixed(i));
  }
  for (const std::uint64_t after : {0, 1, 4, 5, 6, 255, 256, 257, 998, 999, 1000}) {
    const auto events = log.read(after, 300);
    ASSERT_EQ(events.size(), std::min<std::size_t>(300, 1000 - after)) << after;
    for (std::size_t i = 0; i < events.size(); ++i) {
      ASSERT_EQ(events[i].sequence, after + 1 + i);
      ASSERT_EQ(number_of(events[i].event), static_cast<int>(after + 1 + i));
    }
  }
}

TEST(EventLog, DropsTheOldestAndSaysSo) {
  constexpr std::size_t limit = 4096;
  EventLog log(limit);
  for (int i = 1; i <= 1000; ++i) {
    log.append(mixed(i));
    ASSERT_LE(log.bytes(), limit);
  }
  const std::uint64_t earliest = log.earliest();
  EXPECT_EQ(log.latest(), 1000U);
  EXPECT_GT(earliest, 900U);
  EXPECT_LT(earliest, 1000U);

  const auto events = log.read(earliest - 1, 1000);
  ASSERT_EQ(events.size(), 1001 - earliest);
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(number_of(events[i].event), static_cast<int>(earliest + i));
  }
  const auto error = error_of([&] { log.read(earliest - 2, 10); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::sequence_trimmed);
  EXPECT_EQ(error->metadata().at("earliest_sequence"), std::to_string(earliest));
  EXPECT_EQ(error->metadata().at("latest_sequence"), "1000");
  EXPECT_TRUE(throws([&] { log.read(0, 10); }, Reason::sequence_trimmed));
  EXPECT_TRUE(throws([&] { log.read(1001, 10); }, Reason::sequence_trimmed));
  EXPECT_TRUE(throws([&] { log.read(UINT64_MAX, 10); }, Reason::sequence_trimmed));
}

TEST(EventLog, NeverDropsTheEnd) {
  EventLog log(1);
  for (int i = 1; i <= 10; ++i) {
    log.append(mixed(i));
  }
  log.append(end_event());
  EXPECT_EQ(log.earliest(), 11U);
  EXPECT_EQ(log.latest(), 11U);
  const auto events = log.read(10, 10);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(std::get<EndEvent>(events[0].event).job->id, "job");
}

TEST(EventLog, TakesNothingAfterTheEnd) {
  EventLog log(roomy);
  log.append(sample(0, 1));
  EXPECT_FALSE(log.complete());
  log.append(end_event());
  EXPECT_TRUE(log.complete());
  log.append(sample(0, 2));
  EXPECT_EQ(log.latest(), 2U);
}

TEST(EventLog, NumbersItsEventsAboveItsBase) {
  constexpr std::uint64_t base = std::uint64_t{1} << 40U;
  EventLog log(roomy, base);
  EXPECT_EQ(log.earliest(), base + 1);
  EXPECT_EQ(log.latest(), base);
  EXPECT_THAT(log.read(base, 10), IsEmpty());
  EXPECT_TRUE(throws([&] { log.read(5, 10); }, Reason::sequence_trimmed));
  for (int i = 1; i <= 9; ++i) {
    log.append(mixed(i));
  }
  const auto events = log.read(base + 3, 10);
  ASSERT_EQ(events.size(), 6U);
  EXPECT_EQ(events[0].sequence, base + 4);
  EXPECT_EQ(number_of(events[0].event), 4);
}

TEST(EventLog, WakesItsListenersUntilTheyAreGone) {
  EventLog log(roomy);
  int first = 0;
  int second = 0;
  auto a = log.listen([&] { ++first; });
  log.append(sample(0, 1));
  auto b = log.listen([&] { ++second; });
  log.append(sample(0, 2));
  a.reset();
  log.append(sample(0, 3));
  EXPECT_EQ(first, 2);
  EXPECT_EQ(second, 2);
}

TEST(EventLog, MayBeReadAndLeftByItsListener) {
  EventLog log(roomy);
  std::shared_ptr<EventLog::Listener> listener;
  std::uint64_t seen = 0;
  listener = log.listen([&] {
    seen = log.read(seen, 10).back().sequence;
    if (seen == 2) {
      listener.reset();
    }
  });
  for (int i = 1; i <= 4; ++i) {
    log.append(sample(0, i));
  }
  EXPECT_EQ(seen, 2U);
}

TEST(EventLog, MayBeAppendedToByItsListener) {
  EventLog log(roomy);
  int woken = 0;
  const auto listener = log.listen([&] {
    if (++woken < 3) log.append(sample(0, woken));
  });
  log.append(sample(0, 0));
  EXPECT_EQ(woken, 3);
  EXPECT_EQ(log.latest(), 3U);
}

TEST(EventLog, MayBeLeftAfterItIsGone) {
  auto log = std::make_unique<EventLog>(roomy);
  auto listener = log->listen([] {});
  log.reset();
  EXPECT_NO_THROW(listener.reset());
}

TEST(EventLog, WaitsForAWakeUnderWayWhenAListenerLeaves) {
  EventLog log(roomy);
  std::promise<void> inside;
  std::promise<void> leave;
  std::atomic<bool> returned{false};
  auto listener = log.listen([&] {
    inside.set_value();
    leave.get_future().wait();
    returned = true;
  });
  std::thread writer([&] { log.append(sample(0, 1)); });
  inside.get_future().wait();
  std::atomic<bool> left{false};
  std::thread leaver([&] {
    listener.reset();
    EXPECT_TRUE(returned);
    left = true;
  });
  EXPECT_FALSE(left);
  leave.set_value();
  leaver.join();
  writer.join();
}

TEST(EventLog, LosesNothingBetweenManyWritersAndReaders) {
  constexpr int writers = 3;
  constexpr int readers = 3;
  constexpr int each = 3000;
  EventLog log(roomy);
  std::vector<std::thread> threads;
  std::atomic<int> wrong{0};
  for (int r = 0; r < readers; ++r) {
    threads.emplace_back([&] {
      std::mutex mutex;
      std::condition_variable changed;
      bool woken = false;
      const auto listener = log.listen([&] {
        const std::lock_guard lock(mutex);
        woken = true;
        changed.notify_one();
      });
      std::uint64_t after = 0;
      std::vector<int> last(writers, 0);
      while (after < writers * each) {
        const auto events = log.read(after, 64);
        for (const NumberedEvent& event : events) {
          wrong += event.sequence == ++after ? 0 : 1;
          const auto& read = std::get<SampleEvent>(event.event);
          wrong +=
              read.sample.iteration == ++last[static_cast<std::size_t>(read.load_case)] ? 0 : 1;
        }
        if (events.empty()) {
          std::unique_lock lock(mutex);
          changed.wait(lock, [&] { return woken; });
          woken = false;
        }
      }
    });
  }
  for (int w = 0; w < writers; ++w) {
    threads.emplace_back([&, w] {
      for (int i = 1; i <= each; ++i) {
        log.append(sample(w, i));
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
}

TEST(EventLog, LetsListenersComeAndGoWhileItIsWritten) {
  EventLog log(4096);
  std::atomic<bool> done{false};
  std::atomic<int> woken{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t) {
    threads.emplace_back([&] {
      while (!done) {
        bool alive = true;
        auto listener = log.listen([&] {
          EXPECT_TRUE(alive);
          ++woken;
        });
        try {
          log.read(log.earliest() - 1, 16);
        } catch (const errors::Error& error) {
          EXPECT_EQ(error.reason(), Reason::sequence_trimmed);
        }
        listener.reset();
        alive = false;
      }
    });
  }
  for (int i = 1; i <= 2000 || woken == 0; ++i) {
    log.append(mixed(i));
  }
  done = true;
  for (std::thread& thread : threads) {
    thread.join();
  }
}

}  // namespace
}  // namespace anticrack::jobs
