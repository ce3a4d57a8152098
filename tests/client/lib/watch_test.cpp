// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "client/jobs.hpp"
#include "client/lib/scripted_server.hpp"

namespace anticrack::client {
namespace {

using ::testing::ElementsAre;

/// Sequence numbers of the numbered events that reached the caller.
struct Seen {
  std::vector<std::uint64_t> numbers;
  int snapshots = 0;

  void operator()(const v1::WatchJobResponse& event) {
    if (event.has_snapshot()) {
      ++snapshots;
    } else {
      numbers.push_back(event.sequence());
    }
  }
};

std::vector<std::uint64_t> asked_after(const ScriptedServer& server) {
  std::vector<std::uint64_t> numbers;
  for (const v1::WatchJobRequest& request : server.watched()) {
    numbers.push_back(request.after_sequence());
  }
  return numbers;
}

TEST(Watch, PassesOnEveryEventAndReturnsTheEndedJob) {
  ScriptedServer server;
  server.watches = {{{snapshot_event(0), sample_event(1), sample_event(2), ended_event(3)}, {}}};
  Connection connection(server.options());
  Seen seen;
  const v1::Job job = watch_job(connection, "jobs/1", 0, std::ref(seen));
  EXPECT_EQ(job.status().state(), v1::JobStatus::STATE_SUCCEEDED);
  EXPECT_THAT(seen.numbers, ElementsAre(1, 2, 3));
  EXPECT_EQ(seen.snapshots, 1);
}

class LostConnections : public ::testing::TestWithParam<Ending> {};

TEST_P(LostConnections, AreResumedBehindTheLastEvent) {
  ScriptedServer server;
  server.watches = {{{snapshot_event(0), sample_event(1), sample_event(2)}, GetParam()},
                    {{}, GetParam()},
                    {{snapshot_event(2), sample_event(3), ended_event(4)}, {}}};
  Connection connection(server.options());
  Seen seen;
  watch_job(connection, "jobs/1", 0, std::ref(seen));
  EXPECT_THAT(seen.numbers, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(asked_after(server), ElementsAre(0, 2, 2));
}

INSTANTIATE_TEST_SUITE_P(Watch, LostConnections,
                         ::testing::Values(Ending{Code::unavailable, "draining"},
                                           Ending{Code::unknown, "Stream removed"},
                                           Ending{Code::internal,
                                                  "Received RST_STREAM with error code 2"},
                                           Ending{Code::ok, ""}),
                         [](const auto& ending) { return std::string(name(ending.param.code)); });

TEST(Watch, SkipsEventsItHasSeen) {
  ScriptedServer server;
  server.watches = {{{sample_event(1), sample_event(2)}, {Code::unavailable, ""}},
                    {{sample_event(2), sample_event(3), ended_event(4)}, {}}};
  Connection connection(server.options());
  Seen seen;
  watch_job(connection, "jobs/1", 0, std::ref(seen));
  EXPECT_THAT(seen.numbers, ElementsAre(1, 2, 3, 4));
}

TEST(Watch, StartsOverWhereTheServerKeepsTheEventNoLonger) {
  ScriptedServer server;
  server.watches = {{{}, {Code::out_of_range, "trimmed"}},
                    {{snapshot_event(0), sample_event(9), ended_event(10)}, {}}};
  ConnectionOptions options = server.options();
  std::vector<std::string> notices;
  options.notice = [&notices](const std::string& message) { notices.push_back(message); };
  Connection connection(options);
  Seen seen;
  watch_job(connection, "jobs/1", 5, std::ref(seen));
  EXPECT_THAT(asked_after(server), ElementsAre(5, 0));
  EXPECT_THAT(seen.numbers, ElementsAre(9, 10));
  EXPECT_THAT(notices, ElementsAre(::testing::HasSubstr("starting again from the earliest")));
  EXPECT_EQ(seen.snapshots, 1);
}

TEST(Watch, DoesNotAskForTheBeginningForEver) {
  ScriptedServer server;
  server.watches = {{{}, {Code::out_of_range, "never"}}};
  Connection connection(server.options());
  EXPECT_THROW(watch_job(connection, "jobs/1", 5, Seen()), Error);
  EXPECT_EQ(server.watched().size(), 2U);
}

TEST(Watch, ReportsARefusalAtOnce) {
  ScriptedServer server;
  server.watches = {{{}, {Code::not_found, "no such job"}}};
  Connection connection(server.options());
  try {
    watch_job(connection, "jobs/1", 0, Seen());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Code::not_found);
    EXPECT_STREQ(error.what(), "no such job");
  }
  EXPECT_EQ(server.watched().size(), 1U);
}

TEST(Watch, IsInterruptedInTheMiddle) {
  ScriptedServer server;
  server.watches = {{{sample_event(1)}, {}, true}};
  Connection connection(server.options());
  std::stop_source stop;
  EXPECT_THROW(watch_job(
                   connection, "jobs/1", 0,
                   [&stop](const v1::WatchJobResponse&) { stop.request_stop(); }, stop.get_token()),
               Interrupted);
}

TEST(Watch, IsInterruptedWhileItWaitsToTryAgain) {
  ScriptedServer server;
  server.watches = {{{}, {Code::unavailable, "gone"}}};
  ConnectionOptions options = server.options();
  options.retry.first = options.retry.longest = options.first_contact = std::chrono::hours(1);
  options.retry.patience = std::chrono::hours(10);
  options.first_contact = std::chrono::hours(10);
  std::stop_source stop;
  options.notice = [&stop](const std::string&) { stop.request_stop(); };
  Connection connection(options);
  EXPECT_THROW(watch_job(connection, "jobs/1", 0, Seen(), stop.get_token()), Interrupted);
}

}  // namespace
}  // namespace anticrack::client
