// SPDX-License-Identifier: GPL-3.0-or-later
//
// Growth whose final positions several servers solve: rows, notes and events are those of a server
// alone to the bit, whoever dies, and nothing that is in the store is solved again.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <numeric>

#include "client/jobs.hpp"
#include "service/group_fixture.hpp"
#include "service/processes.hpp"
#include "service/workload.hpp"
#include "support/eventually.hpp"

namespace anticrack::service_test {
namespace {

using anticrack::testing::eventually;

/// Positions that a server is solving for another.
constexpr const char* helped =
    "portions p JOIN anticrack.queue q USING (job) WHERE body IS NULL AND p.runner <> q.runner";

class GroupGrowth : public SpreadGroup {
 protected:
  void SetUp() override {
    SpreadGroup::SetUp();
    add({"--drain-time", "0"});
    note_portions();
    add({"--drain-time", "0"});
  }

  void add_load(const std::string& name, const std::string& boundary_value) {
    const v1::LoadCase first = growing.spec.load_cases(0);
    v1::LoadCase& load = *growing.spec.add_load_cases();
    load = first;
    load.set_name(name);
    load.set_boundary_value(boundary_value);
  }

  /// Submits the job and waits until both servers have solved a position and the other one is at
  /// work on the next.
  std::string begin() {
    client::Connection connection(servers[0]->connection());
    std::string name = submit(connection, growing, client::make_uuid()).name();
    EXPECT_TRUE(eventually(
        [&] { return noted("helped") > 0 && noted("NOT helped") > 0 && count(helped) > 0; }));
    runner_first();
    return name;
  }

  void expect_same(Daemon& at, const std::string& name) const {
    const Daemon daemon({"--threads", "1"});
    client::Connection here(at.connection()), alone(daemon.connection());
    const std::string once = submit(alone, growing, "once").name();
    const v1::Job job = wait_for_end(here, name), other = wait_for_end(alone, once);
    EXPECT_EQ(job.status().state(), v1::JobStatus::STATE_SUCCEEDED) << job.ShortDebugString();
    ASSERT_EQ(job.status().answers_size(), growing.spec.load_cases_size());
    const std::vector<std::vector<int>> told = heard(here, name, job.status().attempt());
    for (int i = 0; i < job.status().answers_size(); ++i) {
      const v1::LoadCaseAnswer &answer = job.status().answers(i),
                               &expected = other.status().answers(i);
      ASSERT_EQ(answer.growth_size(), expected.growth_size());
      std::vector<int> order(static_cast<std::size_t>(answer.growth_size()));
      std::iota(order.begin(), order.end(), 0);
      for (int row = 0; row < answer.growth_size(); ++row) {
        EXPECT_EQ(answer.growth(row).SerializeAsString(), expected.growth(row).SerializeAsString());
        if (expected.growth(row).has_g1_final()) order.push_back(row);
      }
      EXPECT_TRUE(std::ranges::equal(answer.growth_notes(), expected.growth_notes()));
      EXPECT_EQ(told.at(static_cast<std::size_t>(i)), order);
    }
    const client::Block result = client::read_result(here, name),
                        one = client::read_result(alone, once);
    EXPECT_EQ(result.layout.SerializeAsString(), one.layout.SerializeAsString());
    EXPECT_TRUE(result.bytes == one.bytes);
    EXPECT_EQ(count("portions"), 0U);
    expect_once();
  }

  /// The rows of each load case of which a watcher hears in this attempt, in order.
  std::vector<std::vector<int>> heard(client::Connection& connection, const std::string& name,
                                      int attempt) const {
    std::vector<std::vector<int>> rows(static_cast<std::size_t>(growing.spec.load_cases_size()));
    client::watch_job(connection, name,
                      static_cast<std::uint64_t>(attempt - 1) * numbers_of_an_attempt,
                      [&](const v1::WatchJobResponse& event) {
                        if (event.has_growth_step())
                          rows.at(static_cast<std::size_t>(event.growth_step().load_case()))
                              .push_back(event.growth_step().number());
                      });
    return rows;
  }

  Work growing = work("growth.toml", {"mesh.preset=uniform", "mesh.size=0.02",
                                      "geometry.boundary=[[-1,-1],[1,-1],[1,1],[-1,1]]",
                                      "growth.positions=20", "growth.final=8"});
};

TEST_F(GroupGrowth, OfSeveralServersEqualsThatOfOneToTheBit) {
  add_load("bent", "y * (1 + 0.1 * x)");
  const std::string name = begin();
  expect_same(helper(), name);
  EXPECT_GT(noted("helped AND n >= 8"), 0U) << "also of the second load case";
}

TEST_F(GroupGrowth, BesideADeadLoadEqualsThatOfOneThreadToTheBit) {
  servers.clear();
  for (int i = 0; i < 2; ++i) add({}, "2");
  add_load("dead", "0.3 * y");
  growing.spec.mutable_growth()->set_dead("dead");
  const std::string name = begin();
  expect_same(runner(), name);
}

TEST_F(GroupGrowth, IsNotHelpedByAServerOfOtherLimits) {
  servers.pop_back();
  add({"--mesh-triangles", "1000000"});
  client::Connection connection(servers[0]->connection());
  expect_same(*servers[0], submit(connection, growing, "alone").name());
  EXPECT_GT(noted(), 0U);
  EXPECT_EQ(noted("helped"), 0U);
}

TEST_F(GroupGrowth, GoesOnWhenAHelperDiesInTheMiddleOfItsPosition) {
  const std::string name = begin();
  ASSERT_TRUE(eventually([&] {
    helper().process().signal(SIGSTOP);
    const bool at_work = count(helped) == 1;
    if (!at_work) helper().process().signal(SIGCONT);
    return at_work;
  }));
  helper().kill();
  expect_same(runner(), name);
}

TEST_F(GroupGrowth, GoesOnWhereADeadServerLeftIt) {
  const std::string name = begin();
  runner().kill();
  EXPECT_GT(count("portions WHERE body IS NOT NULL"), 1U);
  EXPECT_EQ(helper().run_on_data({"--store", url, "--check-store"}).code, 0);
  expect_same(helper(), name);
  client::Connection connection(helper().connection());
  EXPECT_EQ(client::get_job(connection, name).status().attempt(), 2);
}

TEST_F(GroupGrowth, StopsEverywhereWhenItIsCancelled) {
  const std::string name = begin();
  client::Connection connection(helper().connection());
  client::cancel_job(connection, name);
  const v1::Job end = wait_for_end(connection, name);
  EXPECT_EQ(end.status().state(), v1::JobStatus::STATE_CANCELLED);
  EXPECT_EQ(count("portions"), 0U);
  const std::size_t solved = noted();
  Work next = growing;
  next.spec.mutable_growth()->set_final_positions(0);
  EXPECT_TRUE(ran_to_its_end(wait_for_end(connection, submit(connection, next, "next").name())));
  EXPECT_EQ(noted(), solved);
}

TEST_F(GroupGrowth, AServerThatIsDrainedGivesItsPositionsBack) {
  const std::string name = begin();
  drain_both();
  expect_same(helper(), name);
}

}  // namespace
}  // namespace anticrack::service_test
