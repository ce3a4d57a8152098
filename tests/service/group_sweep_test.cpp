// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps that several servers solve: the numbers are those of a server alone to the bit, whoever
// dies, pauses or helps, and nothing that is in the store is solved again.
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <set>

#include "client/jobs.hpp"
#include "client/meshes.hpp"
#include "service/group_fixture.hpp"
#include "service/processes.hpp"
#include "service/workload.hpp"
#include "support/eventually.hpp"

namespace anticrack::service_test {
namespace {

using anticrack::testing::eventually;

/// A sweep: its mesh, what is combined, and the matrix.
struct Sweep {
  v1::CreateMeshRequest mesh;
  v1::JobSpec spec;
  std::vector<double> matrix;
  bool nodal = false;
};

double value(std::size_t i) { return std::sin(0.37 * static_cast<double>(i)); }

/// Combinations of three loads on the paper's membrane.
Sweep combinations(std::size_t rows, bool bounds = false) {
  Sweep sweep{work("paper.toml").mesh, {}, {}};
  for (const char* f : {"1", "x", "y > 0 ? 1 : -1"}) {
    v1::LoadCase& load = *sweep.spec.add_load_cases();
    load.set_name(fmt::format("load {}", sweep.spec.load_cases_size()));
    load.mutable_force()->set_expression(f);
  }
  for (std::size_t i = 0; i < 3 * rows; ++i) sweep.matrix.push_back(value(i));
  sweep.spec.mutable_sweep()->set_bounds(bounds);
  return sweep;
}

class GroupSweep : public SpreadGroup {
 protected:
  std::string submit(client::Connection& connection, const Sweep& sweep) const {
    v1::JobSpec spec = sweep.spec;
    spec.set_mesh(client::create_mesh(connection, sweep.mesh).name());
    auto& matrix = sweep.nodal ? *spec.mutable_sweep()->mutable_nodal_forces()
                               : *spec.mutable_sweep()->mutable_coefficients();
    matrix.set_upload(client::upload_array(connection, sweep.matrix));
    return client::create_job(connection, spec, client::make_uuid()).name();
  }

  /// The result of a server without a group.
  client::Block alone(const Sweep& sweep) const {
    const Daemon daemon({"--threads", "1"});
    client::Connection connection(daemon.connection());
    const std::string name = submit(connection, sweep);
    wait_for_end(connection, name);
    return client::read_result(connection, name);
  }

  /// Submits a sweep and waits until it is in the middle and both servers have solved some of it.
  std::string begin(const Sweep& sweep) {
    client::Connection connection(servers[0]->connection());
    const std::string name = submit(connection, sweep);
    EXPECT_TRUE(eventually([&] { return noted("helped") > 2 && noted("NOT helped") > 2; }));
    runner_first();
    return name;
  }
  void expect_same(client::Connection& connection, const std::string& name,
                   const Sweep& sweep) const {
    const v1::Job end = wait_for_end(connection, name);
    EXPECT_TRUE(ran_to_its_end(end)) << end.ShortDebugString();
    const client::Block result = client::read_result(connection, name), one = alone(sweep);
    EXPECT_EQ(result.layout.SerializeAsString(), one.layout.SerializeAsString());
    EXPECT_TRUE(result.bytes == one.bytes);
    EXPECT_EQ(count("portions"), 0U);
  }
};

TEST_F(GroupSweep, OfSeveralServersEqualsThatOfOneToTheBit) {
  client::Connection a(add().connection());
  note_portions();
  add();
  Sweep traced = combinations(50'000);
  for (const std::uint32_t row : {0U, 20'000U, 49'999U})
    traced.spec.mutable_sweep()->add_traces(row);
  Sweep tips = combinations(40'000);
  tips.spec.mutable_sweep()->set_tips(true);
  Sweep bounds = combinations(4'000, true);
  bounds.spec.mutable_sweep()->set_tips(true);
  Sweep nodal{work("paper.toml", {"mesh.preset=uniform", "mesh.size=0.1"}).mesh, {}, {}, true};
  const std::string mesh = client::create_mesh(a, nodal.mesh).name();
  const auto nodes = static_cast<std::size_t>(client::wait_for_mesh(a, mesh).node_count());
  for (std::size_t i = 0; i < nodes * (128 * 4096 / nodes + 1); ++i)
    nodal.matrix.push_back(value(i));
  nodal.spec.mutable_sweep()->set_bounds(true);
  for (const Sweep* sweep : {&traced, &tips, &bounds, &nodal}) {
    constexpr int most_tries = 20;  // it may be over before the other server looks for work
    for (int tries = 0; noted("helped") == 0 && tries < most_tries; ++tries) {
      database.sql("TRUNCATE noted");
      expect_same(a, submit(a, *sweep), *sweep);
      expect_once();
    }
    EXPECT_GT(noted("helped"), 0U);
    database.sql("TRUNCATE noted");
  }
}

TEST_F(GroupSweep, OfCheapRowsIsNotWrittenByTheServerThatRunsIt) {
  client::Connection a(add().connection());
  note_portions();
  const Sweep sweep = combinations(50'000);  // 66 portions, of some milliseconds each
  expect_same(a, submit(a, sweep), sweep);
  EXPECT_LT(noted(), 33U);  // none where the machine has nothing else to do
}

TEST_F(GroupSweep, OfFewRowsIsSolvedByOneServer) {
  client::Connection a(add().connection());
  note_portions();
  add();
  const Sweep sweep = combinations(20'000);
  expect_same(a, submit(a, sweep), sweep);
  EXPECT_EQ(noted(), 0U);
}

class GroupLongSweep : public GroupSweep {
 protected:
  void SetUp() override {
    GroupSweep::SetUp();
    add({"--drain-time", "0"});
    note_portions();
    add({"--drain-time", "0"});
  }
  const Sweep sweep = combinations(120'000, true);  // some seconds of one thread
};

TEST_F(GroupLongSweep, TellsWatchersEachRowOnceThoughAHelperDies) {
  const std::string name = begin(sweep);
  helper().kill();
  client::Connection connection(runner().connection());
  std::set<std::uint64_t> rows;
  client::watch_job(connection, name, 0, [&](const v1::WatchJobResponse& event) {
    for (int i = 0; i < event.sweep_rows().status_size(); ++i)
      EXPECT_TRUE(
          rows.insert(event.sweep_rows().first_row() + static_cast<std::uint64_t>(i)).second);
  });
  EXPECT_EQ(rows.size(), sweep.matrix.size() / 3);
  expect_same(connection, name, sweep);
  expect_once();
}

TEST_F(GroupLongSweep, GoesOnWhereADeadServerLeftIt) {
  const std::string name = begin(sweep);
  runner().kill();
  EXPECT_GT(count("portions WHERE body IS NOT NULL"), 0U);
  EXPECT_EQ(helper().run_on_data({"--store", url, "--check-store"}).code, 0);
  const std::size_t before = noted();
  client::Connection connection(helper().connection());
  std::set<std::uint64_t> rows;
  client::watch_job(connection, name, numbers_of_an_attempt,
                    [&](const v1::WatchJobResponse& event) {
                      for (int i = 0; i < event.sweep_rows().status_size(); ++i)
                        rows.insert(event.sweep_rows().first_row() + static_cast<std::uint64_t>(i));
                    });
  EXPECT_EQ(rows.size(), sweep.matrix.size() / 3) << "rows of before are told again";
  expect_same(connection, name, sweep);
  EXPECT_EQ(client::get_job(connection, name).status().attempt(), 2);
  EXPECT_GT(before, 4U);
  expect_once();
}

TEST_F(GroupLongSweep, TakesNothingFromAServerThatWasPausedForLong) {
  const std::string name = begin(sweep);
  client::Connection connection(runner().connection());
  helper().process().signal(SIGSTOP);
  wait_for_end(connection, name);  // not before the lease is over
  const std::size_t solved = noted();
  helper().process().signal(SIGCONT);
  expect_same(connection, name, sweep);
  EXPECT_EQ(noted(), solved);
  expect_once();
  client::Connection paused(helper().connection());
  const std::string next = submit(paused, combinations(1'000));  // it is a server again
  EXPECT_TRUE(ran_to_its_end(wait_for_end(paused, next)));
}

TEST_F(GroupLongSweep, StopsEverywhereWhenItIsCancelled) {
  const std::string name = begin(sweep);
  client::Connection connection(helper().connection());
  client::cancel_job(connection, name);
  const v1::Job end = wait_for_end(connection, name);
  EXPECT_EQ(end.status().state(), v1::JobStatus::STATE_CANCELLED);
  EXPECT_LT(end.status().sweep_answer().converged(), sweep.matrix.size() / 3);
  EXPECT_GT(end.status().sweep_answer().converged(), 0U);
  const std::size_t solved = noted();
  EXPECT_EQ(count("portions"), 0U);
  const std::string next = submit(connection, combinations(1'000));
  EXPECT_TRUE(ran_to_its_end(wait_for_end(connection, next)));
  EXPECT_EQ(noted(), solved);
}

TEST_F(GroupLongSweep, AServerThatIsDrainedGivesItsPortionsBack) {
  const std::string name = begin(sweep);
  drain_both();
  client::Connection connection(helper().connection());
  expect_same(connection, name, sweep);
  expect_once();
}

}  // namespace
}  // namespace anticrack::service_test
