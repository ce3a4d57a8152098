// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every way to write to a store, with the connection to PostgreSQL cut at every statement.
#include <map>

#include "group/cutting_proxy.hpp"
#include "store/contract_fixture.hpp"
#include "store/operations.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::CuttingProxy;
using anticrack::testing::TemporaryFolder;

/// What is in a store after all operations.
std::string content_after_all(const StoreOptions& options) {
  std::unique_ptr<Store> store = open_any(options);
  for (const Operation& operation : operations()) operation(*store);
  return content(*store);
}

class GroupFaults : public ::testing::TestWithParam<bool> {
 protected:
  /// Calls work(options) on an empty database, each time with the connection cut at another
  /// request; returns how many there were.
  template <class Work>
  int cut_everywhere(const Work& work) {
    const std::size_t host = url.find("host=") + 5;
    open_any({TemporaryFolder().path(), 0, url});  // the tables
    int cuts = 0;
    for (bool cut = true; cut && !HasFailure(); cuts += cut ? 1 : 0) {
      ask(url, "TRUNCATE blobs, pieces, meshes, jobs, uploads, queue, portions, events, servers");
      SCOPED_TRACE(fmt::format("cut at request {}", cuts + 1));
      const CuttingProxy proxy(url.substr(host), cuts + 1, GetParam());
      const TemporaryFolder folder;
      work({folder.path(), 0, url.substr(0, host) + proxy.folder.path()});
      cut = proxy.has_cut();
    }
    return cuts;
  }

  const std::string url = fresh_database();
};

/// Nothing is lost, done twice or refused, whether it was a statement that did not arrive or an
/// answer, that of a commit included.
TEST_P(GroupFaults, ALostConnectionAtEveryStatementIsNotSeen) {
  const TemporaryFolder sqlite;
  const std::string expected = content_after_all({sqlite.path(), 0, {}});
  EXPECT_GT(cut_everywhere([&](const StoreOptions& options) {
              EXPECT_EQ(content_after_all(options), expected);
            }),
            100);
}

/// A claim whose answer is lost is given back later; all else is done once.
TEST_P(GroupFaults, JobsOfTheQueueEndOnceWhateverIsLost) {
  EXPECT_GT(cut_everywhere([&](const StoreOptions& options) {
              const auto store = open_any(options);
              Queue& queue = *store->queue();
              for (const char* id : {"one", "two"}) {
                records::JobRecord record = job_record(id);
                record.spec.mesh = "m";
                queue.create(record, "print", {1, 1}, [](const auto&) {});
              }
              while (!store->unfinished().empty()) {
                std::vector<Queue::Claim> claims = queue.claim(2, {"m"}, {});
                if (claims.empty()) queue.give_back({});
                for (auto& [record, cancelled] : claims) {
                  record.state = records::JobState::running;
                  store->put(record);
                  queue.append({{record.id, record.attempt, 5, "events"}});
                  EXPECT_EQ(queue.events({{record.id, 0}}).size(), 1U);
                  record.state = records::JobState::succeeded;
                  record.ended = records::Clock::time_point(std::chrono::seconds(7));
                  store->finish(record, block(1));
                }
                EXPECT_FALSE(queue.beat({}).lost);
              }
              for (const records::JobRecord& record : store->jobs({"", 9, {}}))
                EXPECT_EQ(record.state, records::JobState::succeeded);
              EXPECT_EQ(store->ended().size(), 2U);
              EXPECT_EQ(values(*store->result("one")), values(*store->result("two")));
              queue.leave();
              EXPECT_EQ(
                  ask(url, "SELECT (SELECT count(*) FROM queue) + (SELECT count(*) FROM servers)")
                      .integer(0, 0),
                  0);
            }),
            20);
}

/// A sweep whose portions one server solves is solved once, whatever is lost.
TEST_P(GroupFaults, PortionsOfASweepAreSolvedOnceWhateverIsLost) {
  EXPECT_GT(cut_everywhere([&](const StoreOptions& options) {
              const auto store = open_any(options);
              Queue& queue = *store->queue();
              records::JobRecord record = job_record("one");
              record.spec.mesh = "m";
              queue.create(record, "print", {1, 1}, [](const auto&) {});
              std::vector<Queue::Claim> claims;
              while ((claims = queue.claim(1, {"m"}, {})).empty()) queue.give_back({});
              record = claims[0].record;
              queue.spread("one", record.attempt, {{0, 0, 4}, {1, 4, 4}, {2, 8, 2}});
              EXPECT_FALSE(queue.to_help({}, {})) << "it runs here";
              std::map<std::uint64_t, std::string> bodies;
              for (std::size_t taken = 0; bodies.size() < 3; ++taken) {
                for (const Portion& portion : queue.take_portions("one", 1))
                  queue.solved("one", {portion.number, std::to_string(taken)});
                for (SolvedPortion& one : queue.solved_portions("one", {0, 1, 2}))
                  EXPECT_EQ(bodies.emplace(one.number, one.body).first->second, one.body)
                      << "what was solved does not change";
              }
              queue.give_back_portions("one");
              queue.withdraw_portions("one", record.attempt, {});
              EXPECT_TRUE(queue.solved_portions("one", {0, 1, 2}).empty());
              record.state = records::JobState::succeeded;
              record.ended = records::Clock::time_point(std::chrono::seconds(7));
              store->finish(record, nullptr);
            }),
            20);
}

INSTANTIATE_TEST_SUITE_P(All, GroupFaults, ::testing::Bool(), [](const auto& given) {
  return std::string(given.param ? "AnswersLost" : "StatementsLost");
});

}  // namespace
}  // namespace anticrack::store
