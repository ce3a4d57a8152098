// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/event_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <future>
#include <mutex>
#include <span>
#include <thread>

#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::throws;
using errors::Reason;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::size_t roomy = 16U << 20U;

SampleEvent sample(std::int32_t load_case, int iteration) {
  SampleEvent event{load_case, {}};
  event.sample.iteration = iteration;
  event.sample.criterion = 1.0 / iteration;
  event.sample.energy = -iteration;
  event.sample.contact_count = iteration % 7;
  event.sample.kkt = {iteration + 0.1, iteration + 0.2, iteration + 0.3, iteration + 0.4};
  return event;
}

EndEvent end_event() {
  auto record = std::make_shared<store::JobRecord>();
  record->id = "job";
  return {std::move(record)};
}

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

/// Every 5th event is a phase, the others samples; the number of each is in it.
Event mixed(int number) {
  return number % 5 == 0 ? Event(PhaseEvent{store::JobState::running, std::to_string(number)})
                         : Event(sample(0, number));
}

int number_of(const Event& event) {
  const auto* phase = std::get_if<PhaseEvent>(&event);
  return phase != nullptr ? std::stoi(phase->detail)
                          : std::get<SampleEvent>(event).sample.iteration;
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

/// The numbers of a batch's events.
std::vector<int> numbers_of(const Batch& batch) {
  std::vector<int> numbers;
  if (const auto* runs = std::get_if<std::vector<SampleRun>>(&batch)) {
    for (const SampleRun& run : *runs) {
      const auto column = run.column(&SamplePage::iteration);
      numbers.insert(numbers.end(), column.begin(), column.end());
    }
  } else {
    numbers.push_back(std::stoi(std::get<PhaseEvent>(batch).detail));
  }
  return numbers;
}

std::vector<SampleEvent> samples(int first, int count) {
  std::vector<SampleEvent> result;
  for (int i = first; i < first + count; ++i) {
    result.push_back(sample(0, i));
  }
  return result;
}

TEST(EventLog, TakesManySamplesAtOnce) {
  EventLog log(roomy);
  int woken = 0;
  const auto listener = log.listen([&] { ++woken; });
  log.append(samples(1, 700));
  log.append(std::span<const SampleEvent>());
  log.append(mixed(5));
  log.append(samples(702, 1));
  EXPECT_EQ(woken, 3);
  EXPECT_EQ(log.latest(), 702U);
  const auto events = log.read(0, 1000);
  ASSERT_EQ(events.size(), 702U);
  for (std::size_t i = 0; i < events.size(); ++i) {
    ASSERT_EQ(events[i].sequence, i + 1);
    ASSERT_EQ(number_of(events[i].event), i == 700 ? 5 : static_cast<int>(i) + 1);
  }
}

TEST(EventLog, GivesSamplesAsRunsUpToTheNextOtherEvent) {
  EventLog log(roomy);
  log.append(samples(1, 599));
  log.append(mixed(600));
  log.append(samples(601, 9));
  for (const std::size_t count : {1, 2, 255, 256, 257, 599, 600, 1000}) {
    for (const std::uint64_t after : {0, 1, 255, 256, 300, 598}) {
      const NumberedBatch batch = log.batch(after, count);
      const std::size_t expected = std::min<std::size_t>(count, 599 - after);
      EXPECT_EQ(batch.last, after + expected);
      const std::vector<int> numbers = numbers_of(batch.events);
      ASSERT_EQ(numbers.size(), expected);
      EXPECT_EQ(numbers.front(), static_cast<int>(after) + 1);
      EXPECT_EQ(numbers.back(), static_cast<int>(after + expected));
    }
  }
  EXPECT_EQ(log.batch(599, 10).last, 600U);
  EXPECT_THAT(numbers_of(log.batch(599, 10).events), ElementsAre(600));
  EXPECT_THAT(numbers_of(log.batch(600, 3).events), ElementsAre(601, 602, 603));
  EXPECT_EQ(log.batch(600, 100).last, 609U);
}

TEST(EventLog, GivesAnEmptyBatchWhereThereIsNothingOrNothingIsWanted) {
  EventLog log(roomy);
  EXPECT_EQ(log.batch(0, 10).last, 0U);
  EXPECT_THAT(numbers_of(log.batch(0, 10).events), IsEmpty());
  log.append(mixed(5));
  EXPECT_EQ(log.batch(0, 0).last, 0U);
  EXPECT_THAT(numbers_of(log.batch(0, 0).events), IsEmpty());
  EXPECT_EQ(log.batch(1, 10).last, 1U);
  EXPECT_TRUE(throws([&] { log.batch(2, 0); }, Reason::sequence_trimmed));
}

TEST(EventLog, LeavesARunWhatItIsWhileTheLogMovesOn) {
  EventLog log(4096);
  log.append(samples(1, 10));
  const NumberedBatch before = log.batch(0, 10);
  for (int i = 0; i < 50; ++i) {
    log.append(samples(11 + 20 * i, 20));
  }
  EXPECT_GT(log.earliest(), 11U);
  EXPECT_THAT(numbers_of(before.events), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10));
}

TEST(EventLog, TrimsInTheMidstOfWhatCameAtOnce) {
  constexpr std::size_t limit = 100 * SamplePage::bytes_per_sample;
  EventLog log(limit);
  int number = 0;
  for (const int count : {1, 99, 1, 300, 5, 600, 256, 1}) {
    log.append(samples(number + 1, count));
    number += count;
    EXPECT_EQ(log.latest(), static_cast<std::uint64_t>(number));
    EXPECT_EQ(log.earliest(), static_cast<std::uint64_t>(std::max(number - 99, 1)));
    EXPECT_LE(log.bytes(), limit);
    const NumberedBatch batch = log.batch(log.earliest() - 1, 1000);
    EXPECT_EQ(numbers_of(batch.events).front(), static_cast<int>(log.earliest()));
    EXPECT_EQ(numbers_of(batch.events).back(), number);
    EXPECT_EQ(batch.last, log.latest());
  }
}

TEST(EventLog, KeepsTheNewestSampleOfWhatIsTooLarge) {
  EventLog log(1);
  log.append(samples(1, 1000));
  EXPECT_EQ(log.earliest(), 1000U);
  EXPECT_THAT(numbers_of(log.batch(999, 10).events), ElementsAre(1000));
}

/// Rows of a sweep on a mesh of 2 inclusions and 30 crack nodes.
RowsEvent rows(std::uint64_t first, std::size_t count) {
  return {first, std::make_shared<const contact::SweepColumns>(count, 2, 30)};
}

TEST(EventLog, GivesTheRowsOfASweepOneEventAtATimeAndCountsThem) {
  EventLog log(roomy);
  log.append(rows(0, 256));
  const std::size_t one = log.bytes();
  EXPECT_GE(one, 256 * (2 * sizeof(std::int32_t) + 5 * sizeof(double) + 30));
  log.append(rows(256, 100));
  EXPECT_GT(log.bytes(), one);
  EXPECT_LT(log.bytes(), 2 * one);
  const NumberedBatch first = log.batch(0, 10);
  EXPECT_EQ(first.last, 1U);
  EXPECT_EQ(std::get<RowsEvent>(first.events).rows->rows(), 256U);
  const NumberedBatch second = log.batch(1, 10);
  EXPECT_EQ(second.last, 2U);
  EXPECT_EQ(std::get<RowsEvent>(second.events).first_row, 256U);

  EventLog small(3 * one);
  for (std::uint64_t i = 0; i < 10; ++i) {
    small.append(rows(256 * i, 256));
  }
  EXPECT_EQ(small.earliest(), 8U);
  EXPECT_EQ(std::get<RowsEvent>(small.batch(7, 10).events).first_row, 256U * 7);
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

TEST(EventLog, IsReadInRunsWhileItIsWrittenAndTrimmed) {
  constexpr int writers = 2;
  constexpr int readers = 2;
  constexpr int each = 20000;
  EventLog log(200 * SamplePage::bytes_per_sample);
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int r = 0; r < readers; ++r) {
    threads.emplace_back([&] {
      std::vector<int> last(writers, 0);
      for (std::uint64_t after = 0; !(log.complete() && after == log.latest());) {
        NumberedBatch batch;
        try {
          batch = log.batch(after, 300);
        } catch (const errors::Error& error) {
          wrong += error.reason() == Reason::sequence_trimmed ? 0 : 1;
          after = log.earliest() - 1;
          continue;
        }
        if (batch.last == after) {
          std::this_thread::yield();
        }
        after = batch.last;
        const auto* runs = std::get_if<std::vector<SampleRun>>(&batch.events);
        if (runs == nullptr) {
          continue;
        }
        for (const SampleRun& run : *runs) {
          for (std::size_t i = 0; i < run.count; ++i) {
            const SampleEvent read = run[i];
            int& before = last[static_cast<std::size_t>(read.load_case)];
            const bool whole = read.sample.iteration > before &&
                               read.sample.energy == -read.sample.iteration &&
                               read.sample.kkt.gap == read.sample.iteration + 0.2;
            wrong += whole ? 0 : 1;
            before = read.sample.iteration;
          }
        }
      }
    });
  }
  std::vector<std::thread> writing;
  for (int w = 0; w < writers; ++w) {
    writing.emplace_back([&, w] {
      std::vector<SampleEvent> lot;
      for (int i = 1; i <= each; ++i) {
        lot.push_back(sample(w, i));
        if (i % 37 == 0 || i == each) {
          log.append(lot);
          lot.clear();
        }
        if (i % 1000 == 0) {
          log.append(PhaseEvent{store::JobState::running, "phase"});
        }
      }
    });
  }
  for (std::thread& thread : writing) {
    thread.join();
  }
  log.append(end_event());
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(log.latest(), std::uint64_t{writers} * (each + each / 1000) + 1);
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
