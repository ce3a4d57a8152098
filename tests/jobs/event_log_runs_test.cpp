// SPDX-License-Identifier: GPL-3.0-or-later
//
// What comes many at a time, and how it is read: in runs, without a copy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <span>
#include <thread>

#include "contact/sweep_columns.hpp"
#include "jobs/event_log_support.hpp"
#include "records/case_record.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::throws;
using errors::Reason;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// The numbers of a batch's events.
std::vector<int> numbers_of(const Batch& batch) {
  std::vector<int> numbers;
  if (const auto* progress = std::get_if<ProgressEvents>(&batch)) {
    for (const SampleRun& run : progress->samples) {
      const auto column = run.column(&SamplePage::iteration);
      numbers.insert(numbers.end(), column.begin(), column.end());
    }
  } else {
    numbers.push_back(std::stoi(std::get<PhaseEvent>(batch).detail));
  }
  return numbers;
}

TEST(EventLogRuns, TakesManySamplesAtOnce) {
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

TEST(EventLogRuns, GivesSamplesAsRunsUpToTheNextOtherEvent) {
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

TEST(EventLogRuns, GivesAnEmptyBatchWhereThereIsNothingOrNothingIsWanted) {
  EventLog log(roomy);
  EXPECT_EQ(log.batch(0, 10).last, 0U);
  EXPECT_THAT(numbers_of(log.batch(0, 10).events), IsEmpty());
  log.append(mixed(5));
  EXPECT_EQ(log.batch(0, 0).last, 0U);
  EXPECT_THAT(numbers_of(log.batch(0, 0).events), IsEmpty());
  EXPECT_EQ(log.batch(1, 10).last, 1U);
  EXPECT_TRUE(throws([&] { log.batch(2, 0); }, Reason::sequence_trimmed));
}

TEST(EventLogRuns, LeavesARunWhatItIsWhileTheLogMovesOn) {
  EventLog log(4096);
  log.append(samples(1, 10));
  const NumberedBatch before = log.batch(0, 10);
  for (int i = 0; i < 50; ++i) {
    log.append(samples(11 + 20 * i, 20));
  }
  EXPECT_GT(log.earliest(), 11U);
  EXPECT_THAT(numbers_of(before.events), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10));
}

TEST(EventLogRuns, TrimsInTheMidstOfWhatCameAtOnce) {
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

TEST(EventLogRuns, KeepsTheNewestSampleOfWhatIsTooLarge) {
  EventLog log(1);
  log.append(samples(1, 1000));
  EXPECT_EQ(log.earliest(), 1000U);
  EXPECT_THAT(numbers_of(log.batch(999, 10).events), ElementsAre(1000));
}

/// The end of a load case that took `steps` iterations and is some `bytes` large.
CaseEvent case_ended(int load_case, int steps, std::size_t bytes = 0) {
  auto record = std::make_shared<records::CaseRecord>();
  record->answer.iterations = steps;
  record->answer.reason.assign(bytes, 'x');
  return {load_case, record};
}

std::vector<int> ended_in(const Batch& batch) {
  std::vector<int> load_cases;
  for (const CaseEvent& ended : std::get<ProgressEvents>(batch).ended) {
    load_cases.push_back(ended.load_case);
  }
  return load_cases;
}

TEST(EventLogRuns, GivesEndsOfLoadCasesWithTheSamplesAroundThem) {
  EventLog log(roomy);
  log.append(samples(1, 2));
  log.append(case_ended(0, 2));
  log.append(samples(4, 3));
  log.append(case_ended(1, 3));
  log.append(case_ended(2, 0));
  log.append(mixed(10));
  log.append(case_ended(3, 0));
  const NumberedBatch all = log.batch(0, 100);
  EXPECT_EQ(all.last, 8U);
  EXPECT_THAT(numbers_of(all.events), ElementsAre(1, 2, 4, 5, 6));
  EXPECT_THAT(ended_in(all.events), ElementsAre(0, 1, 2));
  EXPECT_EQ(log.batch(8, 100).last, 9U);
  EXPECT_THAT(ended_in(log.batch(9, 100).events), ElementsAre(3));
  // However it is parted, each event comes once, and an end after the samples before it.
  for (const std::size_t count : {1, 2, 3, 4, 5, 6, 7}) {
    std::vector<int> numbers, ended;
    for (std::uint64_t after = 0; after < 8;) {
      const NumberedBatch batch = log.batch(after, count);
      EXPECT_EQ(batch.last, std::min<std::uint64_t>(after + count, 8));
      for (const int number : numbers_of(batch.events)) numbers.push_back(number);
      for (const int load_case : ended_in(batch.events)) {
        ended.push_back(load_case);
        EXPECT_GE(numbers.size(), load_case == 0 ? 2U : 5U);
      }
      after = batch.last;
    }
    EXPECT_THAT(numbers, ElementsAre(1, 2, 4, 5, 6));
    EXPECT_THAT(ended, ElementsAre(0, 1, 2));
  }
}

TEST(EventLogRuns, GivesFewLargeEndsOfLoadCasesAtOnce) {
  EventLog log(roomy);
  for (int i = 0; i < 10; ++i) {
    log.append(case_ended(i, 0, EventLog::batch_bytes / 3));
  }
  const NumberedBatch first = log.batch(0, 100);
  EXPECT_THAT(ended_in(first.events), ElementsAre(0, 1, 2));
  EXPECT_THAT(ended_in(log.batch(first.last, 100).events), ElementsAre(3, 4, 5));
}

/// Rows of a sweep on a mesh of 2 inclusions and 30 crack nodes.
RowsEvent rows_event(std::uint64_t first, std::size_t count) {
  return {first, std::make_shared<const contact::SweepColumns>(count, 2, 30)};
}

TEST(EventLogRuns, GivesTheRowsOfASweepOneEventAtATimeAndCountsThem) {
  EventLog log(roomy);
  log.append(rows_event(0, 256));
  const std::size_t one = log.bytes();
  EXPECT_GE(one, 256 * (2 * sizeof(std::int32_t) + 5 * sizeof(double) + 30));
  log.append(rows_event(256, 100));
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
    small.append(rows_event(256 * i, 256));
  }
  EXPECT_EQ(small.earliest(), 8U);
  EXPECT_EQ(std::get<RowsEvent>(small.batch(7, 10).events).first_row, 256U * 7);
}

TEST(EventLogRuns, IsReadInRunsWhileItIsWrittenAndTrimmed) {
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
        const auto* progress = std::get_if<ProgressEvents>(&batch.events);
        if (progress == nullptr) {
          continue;
        }
        for (const SampleRun& run : progress->samples) {
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
          log.append(PhaseEvent{records::JobState::running, "phase"});
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

}  // namespace
}  // namespace anticrack::jobs
