// SPDX-License-Identifier: GPL-3.0-or-later
//
// The queue of several servers in a real PostgreSQL; each server is a Queue of its own here.
#include "group/queue.hpp"

#include <gtest/gtest.h>

#include <future>
#include <map>
#include <set>
#include <thread>

#include "group/store.hpp"
#include "records/case_record.hpp"
#include "support/database.hpp"
#include "support/errors.hpp"
#include "support/eventually.hpp"

namespace anticrack::group {
namespace {

using anticrack::testing::eventually;
using anticrack::testing::shared_database;
using anticrack::testing::TemporaryFolder;
using anticrack::testing::throws;
using errors::Reason;
using records::JobRecord;
using records::JobState;
using Claims = std::vector<store::Queue::Claim>;

/// The name of the database in an address of Database::fresh().
std::string database_of(const std::string& url) {
  const std::size_t end = url.find('?'), begin = url.rfind('/', end) + 1;
  return url.substr(begin, end - begin);
}

JobRecord job(const std::string& id, const std::string& owner = "a",
              const std::string& mesh = "m") {
  JobRecord record;
  record.id = id;
  record.owner = owner;
  record.spec.mesh = mesh;
  record.spec.loads = {{"pull", fem::Expression{"1"}, ""}};
  return record;
}

JobRecord ended(JobRecord record) {
  record.state = JobState::succeeded;
  record.ended = records::Clock::now();
  return record;
}

class GroupQueue : public ::testing::Test {
 protected:
  void SetUp() override {
    url = shared_database().fresh();
    a = std::make_unique<Store>(store::StoreOptions{folder_a.path(), 0, url});
    b = std::make_unique<Store>(store::StoreOptions{folder_b.path(), 0, url});
  }

  static void submit(Store& to, const JobRecord& record) {
    to.queue()->create(record, "print", {1, 10}, [](const auto&) {});
  }
  /// Claims with a mesh that is held, so that nothing has to wait.
  static Claims claim(Store& by, std::size_t count = 1,
                      const std::vector<std::string>& held = {"m"}) {
    return by.queue()->claim(count, held, {});
  }

  /// A sweep of 10 rows that `by` runs, in portions of 4, 4 and 2.
  JobRecord spread(Store& by, const std::string& id, const std::string& owner = "a") {
    submit(by, job(id, owner));
    const JobRecord record = claim(by).at(0).record;
    by.queue()->spread(id, record.attempt, portions(4));
    return record;
  }
  /// 10 rows in portions of so many.
  static std::vector<store::Portion> portions(std::uint64_t rows) {
    std::vector<store::Portion> result;
    for (std::uint64_t first = 0; first < 10; first += rows)
      result.push_back({first / rows, first, std::min(rows, 10 - first)});
    return result;
  }
  /// By number; checks that each has its rows.
  static std::vector<std::uint64_t> take(Store& by, const std::string& job, std::size_t count) {
    std::vector<std::uint64_t> numbers;
    for (const store::Portion& one : by.queue()->take_portions(job, count)) {
      EXPECT_EQ(one.first, 4 * one.number);
      EXPECT_EQ(one.count, one.number == 2 ? 2U : 4U);
      numbers.push_back(one.number);
    }
    return numbers;
  }
  static std::map<std::uint64_t, std::string> solved(Store& by, const std::string& job,
                                                     const std::vector<std::int64_t>& missing = {
                                                         0, 1, 2}) {
    std::map<std::uint64_t, std::string> bodies;
    for (const store::SolvedPortion& one : by.queue()->solved_portions(job, missing))
      bodies[one.number] = one.body;
    return bodies;
  }
  /// What happens when the server's beats have stopped for long.
  void declare_dead(const std::string& epoch) const {
    shared_database().sql("UPDATE anticrack.servers SET dead = true WHERE epoch = " + epoch,
                          database_of(url));
  }

  using Numbers = std::vector<std::uint64_t>;
  TemporaryFolder folder_a, folder_b;
  std::string url;
  std::unique_ptr<Store> a, b;
};

TEST_F(GroupQueue, GivesEachJobToOneServer) {
  constexpr int jobs = 200;
  for (int i = 0; i < jobs; ++i) submit(*a, job("j" + std::to_string(i)));
  const auto drain = [](Store& by) {
    std::multiset<std::string> ids;
    for (;;) {
      const Claims claims = claim(by, 3);
      for (const auto& one : claims) {
        EXPECT_EQ(one.record.attempt, 1);
        ids.insert(one.record.id);
        by.finish(ended(one.record), nullptr);
      }
      if (claims.empty() && by.unfinished().empty()) return ids;
    }
  };
  auto others = std::async(std::launch::async, drain, std::ref(*b));
  std::multiset<std::string> ids = drain(*a);
  ids.merge(others.get());
  EXPECT_EQ(ids.size(), static_cast<std::size_t>(jobs));
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
}

TEST_F(GroupQueue, AnswersARequestThatItKnows) {
  JobRecord first = job("one"), second = job("two");
  first.request_id = second.request_id = "request";
  submit(*a, first);
  EXPECT_EQ(b->queue()->create(second, "print", {1, 1}, [](const auto&) { FAIL(); }).id, "one");
  EXPECT_TRUE(throws(
      [&] {
        b->queue()->create(second, "other", {1, 1}, [](const auto&) {});
      },
      Reason::request_id_reused));
  EXPECT_EQ(claim(*a, 9).size(), 1U);
}

TEST_F(GroupQueue, CountsOverAllServersAndTakesNothingThatIsRefused) {
  submit(*a, job("one", "a", "m"));
  submit(*b, job("two", "b", "m"));
  submit(*b, job("three", "a", "n"));
  store::QueueTotals held;
  const auto refuse = [&](const store::QueueTotals& totals) {
    held = totals;
    throw errors::Error(Reason::busy, "full");
  };
  EXPECT_TRUE(throws([&] { a->queue()->create(job("four"), "", {1, 1}, refuse); }, Reason::busy));
  EXPECT_EQ(held.jobs, 3U);
  EXPECT_EQ(held.bytes, 30U);
  EXPECT_EQ(held.own_jobs, 2U);
  EXPECT_EQ(held.own_bytes, 20U);
  EXPECT_EQ(held.mesh_cases, 2U);
  EXPECT_FALSE(a->job("four"));
}

TEST_F(GroupQueue, LetsJobsOnHeldMeshesJumpAheadButNotForEver) {
  constexpr int greedy = 300, modest = 10;
  for (int i = 0; i < greedy; ++i) submit(*a, job("g" + std::to_string(i), "greedy", "m"));
  for (int i = 0; i < modest; ++i) submit(*a, job("m" + std::to_string(i), "modest", "n"));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // others may have them now
  int taken = 0, last_modest = 0, first_modest = 0;
  for (Claims claims = claim(*a); !claims.empty(); claims = claim(*a)) {
    ++taken;
    if (claims[0].record.owner != "modest") continue;
    last_modest = taken;
    if (first_modest == 0) first_modest = taken;
  }
  EXPECT_EQ(taken, greedy + modest);
  EXPECT_GT(first_modest, 1 + modest) << "the mesh that is held goes first for a while";
  EXPECT_LT(last_modest, 5 * modest) << "a modest owner does not wait for all of a greedy one";
}

TEST_F(GroupQueue, LeavesAJobToAServerThatHoldsItsMeshForAWhile) {
  submit(*a, job("one"));
  EXPECT_TRUE(claim(*a, 1, {}).empty());
  EXPECT_TRUE(eventually([&] { return claim(*a, 1, {}).size() == 1; }));
}

TEST_F(GroupQueue, AcceptsNothingFromAServerThatHasLostTheJob) {
  submit(*a, job("one"));
  JobRecord old = claim(*a).at(0).record;
  old.state = JobState::running;
  a->put(old);
  shared_database().sql(
      "UPDATE anticrack.servers SET dead = true WHERE epoch = (SELECT runner FROM anticrack.queue)",
      database_of(url));
  b->queue()->beat({});
  const Claims again = claim(*b);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0].record.attempt, 2);
  EXPECT_THROW(a->put(old), store::JobTaken);
  EXPECT_THROW(a->finish(ended(old), nullptr), store::JobTaken);
  a->queue()->append({{"one", 1, 5, "old"}});
  EXPECT_TRUE(b->queue()->events({{"one", 0}}).empty());
  EXPECT_TRUE(a->queue()->beat({"one"}).lost);
  EXPECT_FALSE(a->queue()->beat({}).lost) << "it is a server again";

  const JobRecord end = ended(again[0].record);
  b->finish(end, nullptr);
  EXPECT_NO_THROW(b->finish(end, nullptr)) << "the reply to the first was lost";
  EXPECT_THROW(a->finish(ended(old), nullptr), store::JobTaken);
  EXPECT_EQ(a->job("one")->attempt, 2);
  EXPECT_EQ(a->queue()->ended({"one"}).size(), 1U);
}

TEST_F(GroupQueue, ClaimsNoJobThatIsLeftOut) {
  for (const char* id : {"one", "two", "three"}) submit(*a, job(id));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // others may have them now
  std::set<std::string> ids;
  for (const char* held : {"m", "another"})
    for (const auto& one : a->queue()->claim(1, {held}, {"one"})) ids.insert(one.record.id);
  EXPECT_EQ(ids, (std::set<std::string>{"two", "three"}));
  EXPECT_TRUE(a->queue()->claim(3, {"m"}, {"one"}).empty());
  submit(*a, job("four"));
  EXPECT_EQ(a->queue()->claim(3, {"m"}, {"one"}).size(), 1U) << "nor as a mate of another";
  EXPECT_EQ(claim(*b).at(0).record.attempt, 1);
}

/// Else it would lose with its next beat what it takes now.
TEST_F(GroupQueue, ClaimsNothingOnceItsLeaseIsLost) {
  submit(*a, job("one"));
  declare_dead("(SELECT min(epoch) FROM anticrack.servers)");
  EXPECT_TRUE(claim(*a).empty());
  EXPECT_TRUE(a->queue()->beat({}).lost);
  EXPECT_EQ(claim(*a).at(0).record.attempt, 1);
}

TEST_F(GroupQueue, CountsACrashOnlyOfAProcessThatDiedWhileTheJobRan) {
  for (const char* id : {"ran", "waited"}) submit(*b, job(id));
  Claims claims = claim(*a, 2);
  ASSERT_EQ(claims.size(), 2U);
  for (auto& one : claims) {
    if (one.record.id != "ran") continue;
    one.record.state = JobState::running;
    a->put(one.record);
  }
  a = std::make_unique<Store>(store::StoreOptions{folder_a.path(), 0, url});  // it did not leave
  b->queue()->beat({});
  claims = claim(*b, 2);
  ASSERT_EQ(claims.size(), 2U);
  for (const auto& one : claims) {
    EXPECT_EQ(one.record.attempt, 2);
    EXPECT_EQ(one.record.crashes, one.record.id == "ran" ? 1 : 0);
  }
}

TEST_F(GroupQueue, GivesBackWhatTheServerDoesNotKnow) {
  submit(*a, job("one"));
  submit(*a, job("two"));
  ASSERT_EQ(claim(*a, 2).size(), 2U);
  a->queue()->beat({"one"});
  EXPECT_TRUE(claim(*b, 2).empty()) << "a claim may be on its way";
  a->queue()->give_back({"one"});
  const Claims claims = claim(*b, 2);
  ASSERT_EQ(claims.size(), 1U);
  EXPECT_EQ(claims[0].record.id, "two");
  a->queue()->leave();
  EXPECT_EQ(claim(*b, 2).size(), 1U);
}

TEST_F(GroupQueue, TellsTheRunnerThatAClientCancels) {
  submit(*a, job("one"));
  submit(*a, job("two"));
  const std::string mine = claim(*a).at(0).record.id;
  EXPECT_FALSE(b->queue()->claim_to_cancel(mine));
  EXPECT_EQ(a->queue()->beat({mine}).cancelled, std::vector<std::string>{mine});
  const std::string free = mine == "one" ? "two" : "one";
  const auto claimed = b->queue()->claim_to_cancel(free);
  ASSERT_TRUE(claimed);
  EXPECT_TRUE(claimed->cancelled);
  EXPECT_FALSE(b->queue()->claim_to_cancel("none"));
}

TEST_F(GroupQueue, GivesEachPortionOfASweepToOneServer) {
  const JobRecord record = spread(*a, "one");
  EXPECT_EQ(take(*a, "one", 1), Numbers{0});
  EXPECT_EQ(take(*b, "one", 5), (Numbers{1, 2}));
  EXPECT_EQ(take(*a, "one", 5), Numbers{0}) << "what it has comes again, as a reply may be lost";
  b->queue()->solved("one", {1, std::string("b\0dy", 4)});
  b->queue()->solved("one", {1, "again"});
  b->queue()->solved("one", {0, "of another"});
  EXPECT_EQ(take(*b, "one", 0), Numbers{2});
  EXPECT_EQ(solved(*a, "one"),
            (std::map<std::uint64_t, std::string>{{1, std::string("b\0dy", 4)}}));
  EXPECT_TRUE(solved(*a, "one", {0, 2}).empty());
  b->queue()->give_back_portions("one");
  EXPECT_EQ(take(*a, "one", 5), (Numbers{0, 2}));
  a->finish(ended(record), nullptr);
  EXPECT_TRUE(take(*b, "one", 5).empty());
  EXPECT_EQ(shared_database().sql("SELECT count(*) FROM anticrack.portions", database_of(url)),
            "0\n");
}

TEST_F(GroupQueue, KeepsTheSolvedPortionsOfAnEarlierAttempt) {
  spread(*a, "one");
  take(*a, "one", 2);
  a->queue()->solved("one", {1, "body"});
  declare_dead("(SELECT runner FROM anticrack.queue)");
  b->queue()->beat({});
  const JobRecord again = claim(*b).at(0).record;
  EXPECT_THROW(a->queue()->spread("one", 1, portions(4)), store::JobTaken);
  a->queue()->solved("one", {0, "late"});
  a->queue()->withdraw_portions("one", 1, {});
  EXPECT_TRUE(take(*a, "one", 0).empty());
  b->queue()->spread("one", again.attempt, portions(4));
  EXPECT_EQ(solved(*b, "one").size(), 1U);
  EXPECT_EQ(take(*b, "one", 5), (Numbers{0, 2}));
  b->queue()->spread("one", again.attempt, portions(5));
  EXPECT_TRUE(solved(*b, "one").empty()) << "other rows are another portion";
  b->queue()->withdraw_portions("one", again.attempt, {0, 2});
  EXPECT_EQ(b->queue()->take_portions("one", 5).size(), 1U);
  b->queue()->withdraw_portions("one", again.attempt, {});
  EXPECT_TRUE(b->queue()->take_portions("one", 5).empty());
}

TEST_F(GroupQueue, OffersPositionsOfGrowthAsTheyCome) {
  submit(*a, job("one"));
  const int attempt = claim(*a).at(0).record.attempt;
  const auto position = [](std::uint64_t n, const std::string& request) {
    return store::Portion{n, n, 1, request};
  };
  const std::vector<store::Portion> first{position(3, "x"), position(4, std::string("y\0", 2))};
  const std::vector<store::Portion> more{position(1, "z")};
  a->queue()->spread("one", attempt, first);
  a->queue()->spread("one", attempt, more);
  EXPECT_EQ(a->queue()->take_portions("one", 1), more);
  EXPECT_EQ(b->queue()->take_portions("one", 9), first) << "those of before stay";
  for (const std::uint64_t n : {3, 4}) b->queue()->solved("one", {n, "answer"});
  const std::vector<store::Portion> other{position(3, "x"), position(4, "another")};
  a->queue()->spread("one", attempt, other);
  EXPECT_EQ(solved(*a, "one", {1, 3, 4}), (std::map<std::uint64_t, std::string>{{3, "answer"}}));
  EXPECT_EQ(b->queue()->take_portions("one", 9), std::vector{other[1]});
}

TEST_F(GroupQueue, FreesThePortionsOfAHelperThatDied) {
  spread(*a, "one");
  EXPECT_EQ(take(*b, "one", 1), Numbers{0});
  declare_dead("(SELECT max(epoch) FROM anticrack.servers)");
  a->queue()->beat({"one"});
  EXPECT_EQ(take(*a, "one", 1), Numbers{0});
  b->queue()->solved("one", {0, "late"});
  EXPECT_TRUE(solved(*a, "one").empty());
}

TEST_F(GroupQueue, OffersNoPortionOfASweepThatIsToBeCancelled) {
  spread(*a, "one");
  take(*b, "one", 1);
  EXPECT_EQ(b->queue()->to_help({}, {}).value().id, "one");
  EXPECT_FALSE(b->queue()->claim_to_cancel("one"));
  EXPECT_TRUE(take(*b, "one", 1).empty()) << "not even those that it has";
  EXPECT_FALSE(b->queue()->to_help({}, {}));
}

TEST_F(GroupQueue, HelpsTheOwnerForWhomOthersSolveLeast) {
  spread(*a, "one", "greedy");
  spread(*a, "two", "greedy");
  spread(*a, "three", "modest");
  EXPECT_FALSE(a->queue()->to_help({"m"}, {})) << "it runs them itself";
  take(*b, "one", 1);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(b->queue()->to_help({"m"}, {}).value().id, "three");
  EXPECT_EQ(b->queue()->to_help({}, {"one", "three"}).value().id, "two");
  take(*a, "three", 3);
  EXPECT_NE(b->queue()->to_help({}, {}).value().id, "three") << "nothing is left of it";
}

TEST_F(GroupQueue, KeepsAwayFromASweepWithWhichHelpersDie) {
  spread(*a, "one");
  for (int deaths = 0; deaths < 2; ++deaths) {
    ASSERT_TRUE(b->queue()->to_help({}, {}));
    b = std::make_unique<Store>(store::StoreOptions{folder_b.path(), 0, url});  // it did not leave
  }
  EXPECT_FALSE(b->queue()->to_help({}, {}));
  spread(*a, "two");
  ASSERT_TRUE(b->queue()->to_help({}, {}));
  b->queue()->give_back_portions("two");  // it does not help any more when it dies
  b = std::make_unique<Store>(store::StoreOptions{folder_b.path(), 0, url});
  ASSERT_TRUE(b->queue()->to_help({}, {}));
  EXPECT_EQ(shared_database().sql("SELECT crashes FROM anticrack.queue WHERE job = 'two'",
                                  database_of(url)),
            "0\n");
}

TEST_F(GroupQueue, OutlivesACrashOfTheDatabase) {
  submit(*a, job("one"));
  const JobRecord record = claim(*a).at(0).record;
  shared_database().stop();
  shared_database().start();
  EXPECT_FALSE(a->queue()->beat({"one"}).lost);
  a->finish(ended(record), nullptr);
  EXPECT_EQ(b->job("one")->state, JobState::succeeded);
}

}  // namespace
}  // namespace anticrack::group
