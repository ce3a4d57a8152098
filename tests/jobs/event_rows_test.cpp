// SPDX-License-Identifier: GPL-3.0-or-later
//
// Logs whose numbers jump, and events on their way through rows of the store.
#include <gtest/gtest.h>

#include <map>
#include <span>

#include "anticrack/v1/solve.pb.h"
#include "contact/answer.hpp"
#include "contact/sweep_columns.hpp"
#include "jobs/event_codec.hpp"
#include "jobs/event_log_support.hpp"
#include "records/case_record.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::throws;
using errors::Reason;

/// A log with the events 11 to 20 and 101 to 110, which say their number.
void fill(EventLog& log) {
  for (const int first : {11, 101}) {
    log.jump(static_cast<std::uint64_t>(first) - 1);
    for (int number = first; number < first + 10; ++number) log.append(mixed(number));
  }
}

TEST(EventLogJump, ReadersGetWhatComesAfterTheirNumber) {
  EventLog log(roomy);
  log.jump(0);
  fill(log);
  EXPECT_EQ(log.earliest(), 11U);
  EXPECT_EQ(log.latest(), 110U);
  for (std::uint64_t after = 0; after <= 120; ++after) {
    std::vector<std::uint64_t> expected;
    for (std::uint64_t number = after + 1; number <= 110; ++number)
      if ((number > 10 && number <= 20) || number > 100) expected.push_back(number);
    std::vector<std::uint64_t> seen;
    for (const NumberedEvent& one : log.read(after, 1000)) {
      EXPECT_EQ(one.sequence, static_cast<std::uint64_t>(number_of(one.event)));
      seen.push_back(one.sequence);
    }
    EXPECT_EQ(seen, expected) << after;
    std::uint64_t cursor = after;
    std::size_t batches = 0;
    for (NumberedBatch batch = log.batch(cursor, 3); batch.last != cursor;
         batch = log.batch(cursor, 3), ++batches) {
      EXPECT_GT(batch.last, cursor);
      EXPECT_GE(log.read(batch.last, 1000).size() + 3, log.read(cursor, 1000).size());
      cursor = batch.last;
    }
    EXPECT_EQ(cursor, std::max<std::uint64_t>(after, 110)) << "a batch without events moves nobody";
    EXPECT_GE(3 * batches, expected.size());
  }
}

TEST(EventLogJump, WhoIsAheadWaitsForWhatIsNew) {
  EventLog log(roomy);
  log.jump(10);
  EXPECT_EQ(log.earliest(), 11U);
  EXPECT_TRUE(log.read(15, 10).empty());
  for (int number = 11; number <= 17; ++number) log.append(mixed(number));
  EXPECT_EQ(log.read(15, 10).size(), 2U);
}

TEST(EventLogJump, SaysWhatIsNoLongerKept) {
  EventLog log(1);  // keeps the newest event alone
  fill(log);
  EXPECT_EQ(log.earliest(), 110U);
  EXPECT_TRUE(throws([&] { log.read(50, 1); }, Reason::sequence_trimmed));
  EXPECT_EQ(log.read(109, 5).size(), 1U);
}

TEST(EventLogJump, NeverGoesBack) {
  EventLog log(roomy);
  fill(log);
  log.jump(50);
  log.append(mixed(111));
  EXPECT_EQ(log.latest(), 111U);
}

/// Samples of two load cases, in turns, with other events between; the numbers are consecutive.
std::vector<NumberedEvent> a_job(std::uint64_t first) {
  std::vector<Event> events{PhaseEvent{records::JobState::running, "stage 1"}};
  for (int i = 1; i <= 1000; ++i) events.emplace_back(sample(i % 3 == 0 ? 1 : 0, i));
  auto answer = std::make_shared<records::CaseRecord>();
  answer->status = contact::Status::converged;
  answer->answer.energy = -0.1;
  events.emplace_back(CaseEvent{1, answer});
  for (int i = 1; i <= 5; ++i) events.emplace_back(sample(0, 1000 + i));
  auto columns = std::make_shared<contact::SweepColumns>(3, 2, 0);
  columns->status.assign(3, contact::Status::converged);
  columns->energy = {1, 2, 3};
  columns->displacement = {1, 2, 3, 4, 5, 6};
  events.emplace_back(RowsEvent{7, columns});
  auto stage = std::make_shared<records::StageRecord>();
  stage->mesh = "0123456789abcdef";
  stage->triangles = 12;
  events.emplace_back(StageEvent{stage});
  auto row = std::make_shared<contact::GrowthRow>();
  row->g1 = 0.5;
  events.emplace_back(GrowthEvent{1, 4, row});
  std::vector<NumberedEvent> numbered;
  for (Event& event : events) numbered.push_back({first++, std::move(event)});
  return numbered;
}

TEST(EventRows, KeepWhatTheyAreAndTheirNumbers) {
  const std::vector<NumberedEvent> events = a_job((std::uint64_t{1} << 40U) + 1);
  EventLog log(roomy);
  log.jump(0);
  for (const store::EventRow& row : pack("job", 2, events)) {
    EXPECT_EQ(row.attempt, 2);
    unpack(row, log);
  }
  EXPECT_EQ(log.latest(), events.back().sequence);
  std::map<std::uint64_t, const Event*> sent;
  for (const NumberedEvent& one : events) sent[one.sequence] = &one.event;
  std::map<int, int> samples_of, last_of;
  std::size_t others = 0;
  for (const NumberedEvent& one : log.read(0, events.size())) {
    if (const auto* kept = std::get_if<SampleEvent>(&one.event)) {
      ++samples_of[kept->load_case];
      EXPECT_GT(kept->sample.iteration, last_of[kept->load_case]);
      last_of[kept->load_case] = kept->sample.iteration;
      EXPECT_EQ(kept->sample.energy, -kept->sample.iteration);
      EXPECT_EQ(kept->sample.kkt.sign, kept->sample.iteration + 0.3);
      EXPECT_LE(static_cast<std::uint64_t>(kept->sample.iteration) + events[0].sequence,
                one.sequence)
          << "a sample does not come before its number";
    } else {
      ++others;
      EXPECT_EQ(one.event.index(), sent.at(one.sequence)->index());
    }
  }
  EXPECT_EQ(others, 5U);
  EXPECT_EQ(last_of, (std::map<int, int>{{0, 1005}, {1, 999}}));
  EXPECT_LE(samples_of[0], static_cast<int>(samples_a_row) + 5);
  EXPECT_LE(samples_of[1], static_cast<int>(samples_a_row));
  EXPECT_GE(samples_of[1], static_cast<int>(samples_a_row) / 2);

  const auto of = [&](std::size_t back) {
    return log.read(events[events.size() - back].sequence - 1, 1).at(0).event;
  };
  EXPECT_EQ(std::get<GrowthEvent>(of(1)).row->g1, 0.5);
  EXPECT_EQ(std::get<GrowthEvent>(of(1)).number, 4);
  EXPECT_EQ(std::get<StageEvent>(of(2)).stage->triangles, 12U);
  EXPECT_EQ(std::get<RowsEvent>(of(3)).first_row, 7U);
  EXPECT_EQ(std::get<RowsEvent>(of(3)).rows->inclusions, 2U);
  EXPECT_EQ(std::get<RowsEvent>(of(3)).rows->displacement, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(std::get<CaseEvent>(of(9)).record->answer.energy, -0.1);
}

/// What readers with each cursor get of events of which `lost` have no row.
void expect_told(const std::vector<NumberedEvent>& events, std::span<const store::EventRow> rows,
                 std::size_t lost) {
  EventLog log(roomy);
  log.jump(0);
  for (const store::EventRow& row : rows) unpack(row, log);
  EXPECT_EQ(log.latest(), events.back().sequence);
  const std::uint64_t first = events[lost].sequence;
  EXPECT_EQ(log.earliest(), first);
  for (const NumberedEvent& event : events) {
    const std::uint64_t after = event.sequence - 1;
    if (after + 1 < first) {
      const auto error = anticrack::testing::error_of([&] { log.read(after, 1); });
      ASSERT_TRUE(error) << after;
      EXPECT_EQ(error->reason(), Reason::sequence_trimmed);
      EXPECT_EQ(error->metadata().at("earliest_sequence"), std::to_string(first));
      EXPECT_EQ(error->metadata().at("latest_sequence"), std::to_string(log.latest()));
    } else {
      EXPECT_EQ(log.read(after, events.size()).size(), events.back().sequence - after);
    }
  }
}

/// The runner's log may have dropped events before they were written.
TEST(EventRows, TellWhoseEventsWereLost) {
  for (const int attempt : {1, 2}) {
    const auto base = static_cast<std::uint64_t>(attempt - 1) << 40U;
    std::vector<NumberedEvent> events;
    for (int number = 1; number <= 30; ++number)
      events.push_back({base + static_cast<std::uint64_t>(number), mixed(number)});
    for (std::size_t from = 0; from < 20; from += 7) {
      std::vector<store::EventRow> rows = pack("job", attempt, std::span(events).first(from));
      for (store::EventRow& row : pack("job", attempt, std::span(events).subspan(20)))
        rows.push_back(std::move(row));
      expect_told(events, rows, 20);
    }
  }
}

TEST(EventRows, OfAnotherAttemptTellOfNoLoss) {
  EventLog log(roomy);
  log.jump(0);
  for (const std::uint64_t base : {std::uint64_t{0}, std::uint64_t{3} << 40U})
    for (const store::EventRow& row : pack("job", 1, a_job(base + 1))) unpack(row, log);
  EXPECT_EQ(log.read(0, 1).at(0).sequence, 1U);
  EXPECT_FALSE(log.read(a_job(1).back().sequence, 1).empty());
}

TEST(EventRows, ThatAreDamagedAreLost) {
  const std::vector<NumberedEvent> events = a_job(1);
  const std::vector<store::EventRow> sound = pack("job", 1, events);
  v1::WatchJobResponse heartbeat;
  heartbeat.set_sequence(1);
  heartbeat.mutable_heartbeat();
  for (std::size_t i = 0; i + 1 < sound.size(); ++i)
    for (const std::string& body :
         {std::string("not a message"), std::string(), heartbeat.SerializeAsString()}) {
      std::vector<store::EventRow> rows = sound;
      rows[i].body = body;
      EventLog log(roomy);
      for (const store::EventRow& row : rows) unpack(row, log);
      EXPECT_TRUE(throws([&] { log.read(sound[i].last - 1, 1); }, Reason::sequence_trimmed));
      EXPECT_EQ(log.read(sound[i].last, SIZE_MAX).back().sequence, events.back().sequence);
    }
}

/// What other servers have not yet been told is dropped for the log's own limit only.
TEST(EventLogHold, KeepsWhatIsNotWritten) {
  const auto budget = std::make_shared<MemoryBudget>(1);
  const MemoryShare much(budget, 2);
  EventLog log(roomy, 0, budget);
  log.hold(0);
  constexpr int many = 20'000;
  log.append(samples(1, many));
  EXPECT_EQ(log.earliest(), 1U);
  log.hold(5);
  log.append(sample(0, many + 1));
  EXPECT_EQ(log.earliest(), 5U);
  log.hold(UINT64_MAX);
  log.append(sample(0, many + 2));
  EXPECT_LE(log.bytes(), EventLog::least_bytes);
}

}  // namespace
}  // namespace anticrack::jobs
