// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/schedule.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

namespace anticrack::jobs {
namespace {

using records::Priority;
using namespace std::chrono_literals;

class ScheduleTest : public ::testing::Test {
 protected:
  std::uint64_t add(const std::string& mesh, Priority priority = Priority::normal,
                    Lane lane = Lane::lumped, const std::string& owner = {}) {
    schedule.add({++_number, mesh, lane, priority, now, owner});
    return _number;
  }
  /// A mesh whose operator is in memory.
  void ready(const std::string& mesh) { schedule.prepared(mesh); }
  /// The mesh of the next turn; empty when there is none.
  std::string turn() {
    const auto turn = schedule.next_turn(now);
    return turn ? turn->mesh : "";
  }
  std::optional<std::uint64_t> next(const std::string& mesh) {
    return schedule.next_job(mesh, Lane::lumped, now);
  }

  Schedule::Time now = std::chrono::steady_clock::time_point(1000h);
  Schedule schedule;

 private:
  std::uint64_t _number = 0;
};

TEST_F(ScheduleTest, HasNoTurnWithoutWork) {
  EXPECT_FALSE(schedule.next_turn(now));
  ready("a");
  EXPECT_FALSE(schedule.next_turn(now));
  const auto job = add("a");
  EXPECT_EQ(turn(), "a");
  schedule.remove(job);
  EXPECT_FALSE(schedule.next_turn(now));
}

TEST_F(ScheduleTest, OwnersTakeTurnsHoweverManyMeshesEachHas) {
  for (int i = 0; i < 20; ++i) {
    ready("greedy-" + std::to_string(i));
    add("greedy-" + std::to_string(i), Priority::normal, Lane::lumped, "greedy");
  }
  EXPECT_TRUE(turn().starts_with("greedy"));
  now += 10min;  // the greedy one's jobs have grown old
  EXPECT_TRUE(turn().starts_with("greedy"));
  ready("modest");
  const auto job = add("modest", Priority::normal, Lane::lumped, "modest");
  EXPECT_EQ(turn(), "modest");
  EXPECT_TRUE(turn().starts_with("greedy"));
  EXPECT_EQ(turn(), "modest");
  schedule.remove(job);
  std::set<std::string> served;
  for (int i = 0; i < 20; ++i) served.insert(turn());
  EXPECT_EQ(served.size(), 20U);  // the greedy one's own meshes take turns as ever
}

TEST_F(ScheduleTest, OwnersTakeTurnsOnAMeshThatTheyShare) {
  ready("a");
  std::vector<std::uint64_t> greedy;
  for (int i = 0; i < 3; ++i) greedy.push_back(add("a", Priority::normal, Lane::lumped, "greedy"));
  now += 10min;  // they have grown old
  const auto modest = add("a", Priority::normal, Lane::lumped, "modest");
  EXPECT_EQ(next("a"), greedy[0]);
  schedule.taken(greedy[0], now);
  EXPECT_EQ(next("a"), modest);
  EXPECT_EQ(next("a"), modest);  // until a load case of it is taken
  schedule.taken(modest, now);
  schedule.remove(greedy[0]);
  EXPECT_EQ(next("a"), greedy[1]);
}

TEST_F(ScheduleTest, TheMoreUrgentClassGoesFirst) {
  for (const char* mesh : {"a", "b", "c"}) {
    ready(mesh);
  }
  add("a", Priority::bulk);
  add("b", Priority::normal);
  const auto urgent = add("c", Priority::interactive);
  EXPECT_EQ(turn(), "c");
  EXPECT_EQ(turn(), "c");
  schedule.remove(urgent);
  EXPECT_EQ(turn(), "b");
}

TEST_F(ScheduleTest, WaitingIsWorthAClass) {
  ready("a");
  ready("b");
  add("a", Priority::bulk);
  now += 29s;
  add("b", Priority::normal);
  EXPECT_EQ(turn(), "b");
  now += 1s;  // the bulk job is as urgent now, and its mesh had no turn yet
  EXPECT_EQ(turn(), "a");
}

TEST_F(ScheduleTest, NothingIsMoreUrgentThanTheFirstClass) {
  ready("old");
  ready("new");
  add("old", Priority::bulk);
  now += 1h;
  add("new", Priority::interactive);
  EXPECT_EQ(turn(), "new");  // by name: neither had a turn
  EXPECT_EQ(turn(), "old");
  EXPECT_EQ(turn(), "new");  // the bulk job has waited since its turn only
  EXPECT_EQ(turn(), "new");
  now += 1min;
  schedule.served("new", now);
  EXPECT_EQ(turn(), "old");
}

TEST_F(ScheduleTest, AThousandJobsOnOneMeshDoNotStarveOneOnAnother) {
  ready("many");
  ready("one");
  for (int i = 0; i < 1000; ++i) {
    add("many");
  }
  now += 10min;
  EXPECT_EQ(turn(), "many");
  schedule.served("many", now);
  add("one");
  EXPECT_EQ(turn(), "one");
  EXPECT_EQ(turn(), "many");
  EXPECT_EQ(turn(), "one");
  EXPECT_EQ(turn(), "many");
}

TEST_F(ScheduleTest, LanesOfAMeshTakeTurnsWithinItsTurns) {
  ready("a");
  ready("b");
  add("a", Priority::normal, Lane::active_set);
  add("a", Priority::normal, Lane::lumped);
  add("b", Priority::normal, Lane::lumped);
  std::vector<std::string> order;
  for (int i = 0; i < 4; ++i) {
    const auto turn = schedule.next_turn(now);
    ASSERT_TRUE(turn);
    order.push_back(turn->mesh + (turn->lane == Lane::lumped ? " lumped" : " exact"));
  }
  EXPECT_EQ(order, (std::vector<std::string>{"a exact", "b lumped", "a lumped", "b lumped"}));
}

TEST_F(ScheduleTest, OnAMeshTheMostUrgentJobThenTheOldest) {
  ready("a");
  const auto bulk = add("a", Priority::bulk);
  const auto older = add("a");
  const auto newer = add("a");
  EXPECT_EQ(next("a"), older);
  EXPECT_EQ(schedule.most_urgent("a", Lane::lumped), Priority::normal);
  const auto urgent = add("a", Priority::interactive);
  EXPECT_EQ(schedule.most_urgent("a", Lane::lumped), Priority::interactive);
  EXPECT_EQ(next("a"), urgent);
  schedule.remove(urgent);
  schedule.remove(older);
  EXPECT_EQ(next("a"), newer);
  now += 31s;  // normal has become the first class, bulk the second
  EXPECT_EQ(next("a"), newer);
  now += 30s;  // both the first: the oldest
  EXPECT_EQ(next("a"), bulk);
  EXPECT_EQ(schedule.next_job("a", Lane::consistent, now), std::nullopt);
  EXPECT_EQ(schedule.most_urgent("a", Lane::consistent), std::nullopt);
  EXPECT_EQ(schedule.next_job("unknown", Lane::lumped, now), std::nullopt);
}

TEST_F(ScheduleTest, AMeshThatIsPreparedHoldsUpNobody) {
  add("slow", Priority::interactive);
  ready("fast");
  add("fast", Priority::bulk);
  EXPECT_EQ(turn(), "fast");
}

TEST_F(ScheduleTest, GivesATurnToWhoIsNotExcluded) {
  ready("a");
  ready("b");
  add("a", Priority::interactive, Lane::lumped, "greedy");
  add("b", Priority::bulk, Lane::lumped, "modest");
  const auto greedy = [](const std::string&, const std::string& owner) {
    return owner == "greedy";
  };
  const auto turn = schedule.next_turn(now, greedy);
  ASSERT_TRUE(turn);
  EXPECT_EQ(turn->mesh, "b");
  EXPECT_EQ(turn->owner, "modest");
  EXPECT_FALSE(schedule.next_turn(now, [](const auto&, const auto&) { return true; }));
}

TEST_F(ScheduleTest, ForgetsAMeshThatIsLetGo) {
  ready("a");
  const auto job = add("a");
  EXPECT_EQ(turn(), "a");
  schedule.remove(job);
  schedule.let_go("a");
  add("a");
  EXPECT_FALSE(schedule.next_turn(now));
}

TEST_F(ScheduleTest, WorkThatWasPutDownHasTurns) {
  ready("a");
  schedule.park("a", Lane::lumped, Priority::normal);
  EXPECT_TRUE(schedule.others("a", Lane::lumped));
  EXPECT_TRUE(schedule.others("b", Lane::lumped));
  EXPECT_EQ(turn(), "a");
  schedule.unpark("a", Lane::lumped, Priority::normal);
  EXPECT_FALSE(schedule.next_turn(now));
}

TEST_F(ScheduleTest, KnowsWhetherATurnKeepsOthersWaiting) {
  ready("a");
  add("a");
  EXPECT_FALSE(schedule.others("a", Lane::lumped));  // its own cases
  EXPECT_TRUE(schedule.others("a", Lane::active_set));
  add("b");
  EXPECT_FALSE(schedule.others("a", Lane::lumped));
  schedule.prepared("b");
  EXPECT_TRUE(schedule.others("a", Lane::lumped));
}

}  // namespace
}  // namespace anticrack::jobs
