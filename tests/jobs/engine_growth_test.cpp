// SPDX-License-Identifier: GPL-3.0-or-later
//
// Jobs with growth: rows as they come, what interrupts them, what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <thread>
#include <variant>

#include "jobs/engine_support.hpp"
#include "records/case_record.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::Backend;
using anticrack::testing::throws;
using errors::Reason;
using records::JobRecord;
using records::JobState;
using namespace std::chrono_literals;

constexpr double size = 0.02;

/// The left half of the paper's inclusion holds at first.
records::JobSpec growing_job(const std::string& mesh) {
  records::JobSpec spec;
  spec.mesh = mesh;
  spec.loads = {{"opening", fem::Expression{"y > 0 ? 1 : -1"}, ""}};
  spec.growth.emplace().paths = {{"interface", {-0.5, 0}, {0, 0}, "0.1"}};
  return spec;
}

std::vector<contact::GrowthRow> told_rows(const Engine& test, const std::string& id) {
  std::vector<contact::GrowthRow> rows;
  for (const NumberedEvent& event : test.events(id))
    if (const auto* step = std::get_if<GrowthEvent>(&event.event)) rows.push_back(*step->row);
  return rows;
}

void expect_same(const std::vector<contact::GrowthRow>& some,
                 const std::vector<contact::GrowthRow>& others) {
  ASSERT_EQ(some.size(), others.size());
  for (std::size_t i = 0; i < some.size(); ++i) {
    EXPECT_EQ(some[i].position, others[i].position);
    EXPECT_EQ(some[i].load, others[i].load);
    EXPECT_EQ(some[i].displacement, others[i].displacement);
    EXPECT_EQ(some[i].g1, others[i].g1);
  }
}

TEST(EngineGrowth, TellsRowsAsTheyCome) {
  Engine test;
  records::JobSpec spec = growing_job(test.ready_mesh(size));
  const std::string id = test.submit(spec);
  const JobRecord job = test.ended(id);
  ASSERT_EQ(job.state, JobState::succeeded) << (job.error ? job.error->what() : "");
  const contact::AnswerSummary& answer = job.cases.at(0).answer;
  ASSERT_GE(answer.growth.size(), 5U);
  expect_same(told_rows(test, id), answer.growth);
  EXPECT_FALSE(answer.growth_notes.empty());
  for (const contact::GrowthRow& row : answer.growth) {
    EXPECT_EQ(row.interface, "interface");
    EXPECT_NEAR(*row.load, std::sqrt(row.toughness / row.g1), 1e-12 * *row.load);
    EXPECT_NEAR(row.x, row.position - 1, 1e-12);
  }
  EXPECT_NEAR(answer.growth.front().x, 0, size / 2);
  EXPECT_TRUE(answer.growth.front().stable);
  // Where the path holds, nothing opens in the first state.
  const auto x = array<double>(*test.engine.result(id), "interfaces/0/x");
  const auto jump = array<double>(*test.engine.result(id), "loads/0/traces/0/jump");
  double open = 0;
  for (std::size_t i = 0; i < x->size(); ++i) {
    if ((*x)[i] <= answer.growth.front().x)
      EXPECT_EQ((*jump)[i], 0);
    else
      open = std::max(open, (*jump)[i]);
  }
  EXPECT_GT(open, 0);
  EXPECT_FALSE(answer.energy_lower || !answer.tips.empty());

  // Twice the load grows at half the factor; so many positions, not more.
  spec.loads[0].force = fem::Expression{"y > 0 ? 2 : -2"};
  spec.growth->positions = 5;
  const JobRecord doubled = test.ended(test.submit(spec));
  const std::vector<contact::GrowthRow>& few = doubled.cases.at(0).answer.growth;
  EXPECT_LE(few.size(), 6U);
  EXPECT_NEAR(*few[0].load, *answer.growth[0].load / 2, 1e-8 * *few[0].load);
}

TEST(EngineGrowth, IsIncreasedByADisplacement) {
  Engine test;
  records::JobSpec spec = growing_job(test.ready_mesh(size));
  spec.growth->inclusion = "inclusion";
  const JobRecord job = test.ended(test.submit(spec));
  ASSERT_EQ(job.state, JobState::succeeded);
  double highest = 0;
  for (const contact::GrowthRow& row : job.cases.at(0).answer.growth) {
    EXPECT_EQ(row.stable, std::abs(*row.displacement) > highest);
    highest = std::max(highest, std::abs(*row.displacement));
  }
}

TEST(EngineGrowth, CancelledInTheMiddle) {
  Engine test;
  const std::string mesh = test.ready_mesh(size);
  records::JobSpec spec = growing_job(mesh);
  for (int i = 0; i < 50; ++i)  // so that it cannot end before it hears
    spec.loads.push_back({"again " + std::to_string(i), spec.loads[0].force, ""});
  const std::string id = test.submit(spec);
  EXPECT_TRUE(anticrack::testing::eventually([&] { return !told_rows(test, id).empty(); }));
  test.engine.cancel(id);
  const JobRecord job = test.ended(id);
  EXPECT_EQ(job.state, JobState::cancelled);
  EXPECT_TRUE(job.cases.back().answer.growth.empty());
}

TEST(EngineGrowth, ThatAStopInterruptsRunsAgainWithTheSameRows) {
  Backend backend;
  const std::string mesh = ready_mesh(backend, size);
  std::string id;
  {
    JobEngine engine(unlimited(one_thread()), *backend.store, backend.catalogue);
    records::JobSpec spec = growing_job(mesh);
    for (int i = 0; i < 50; ++i)
      spec.loads.push_back({"again " + std::to_string(i), spec.loads[0].force, ""});
    id = engine.submit({spec, "", ""}).id;
    EXPECT_TRUE(anticrack::testing::eventually([&] {
      for (const NumberedEvent& event : engine.events(id)->read(0, SIZE_MAX))
        if (std::holds_alternative<GrowthEvent>(event.event)) return true;
      return false;
    }));
    engine.stop(0ms);
  }
  ASSERT_FALSE(records::ended(backend.store->job(id)->state));
  JobEngine engine(unlimited(one_thread()), *backend.store, backend.catalogue);
  const JobRecord again = ended(engine, id);
  EXPECT_EQ(again.state, JobState::succeeded);
  EXPECT_EQ(again.attempt, 2);
  const JobRecord alone = ended(engine, engine.submit({growing_job(mesh), "", ""}).id);
  expect_same(again.cases.at(0).answer.growth, alone.cases.at(0).answer.growth);
  expect_same(again.cases.at(50).answer.growth, alone.cases.at(0).answer.growth);
}

TEST(EngineGrowth, WithWhatCannotBeIsRefused) {
  Engine test;
  const std::string mesh = test.ready_mesh(size);
  const auto submit = [&](const auto& change) {
    return [&, change] {
      records::JobSpec spec = growing_job(mesh);
      change(spec);
      test.submit(spec);
    };
  };
  using Spec = records::JobSpec;
  EXPECT_TRUE(throws(submit([](Spec& spec) { spec.growth->paths.clear(); }),
                     Reason::invalid_argument, "growth.paths"));
  EXPECT_TRUE(
      throws(submit([](Spec& spec) { spec.growth->paths.resize(101, spec.growth->paths[0]); }),
             Reason::limit_exceeded, "growth.paths"));
  for (const int positions : {-1, 1, 1001})
    EXPECT_TRUE(throws(submit([=](Spec& spec) { spec.growth->positions = positions; }),
                       Reason::invalid_argument, "growth.positions"));
  EXPECT_TRUE(throws(submit([](Spec& spec) { spec.growth->paths[0].toughness = ""; }),
                     Reason::invalid_argument, "growth.paths[0].toughness"));
  EXPECT_TRUE(throws(submit([](Spec& spec) { spec.growth->paths[0].toughness = "1 +"; }),
                     Reason::expression_invalid, "growth.paths[0].toughness"));
  EXPECT_TRUE(throws(submit([](Spec& spec) { spec.solver = contact::UzawaOptions{}; }),
                     Reason::invalid_argument, "solver.uzawa"));
  EXPECT_TRUE(
      throws(submit([](Spec& spec) { spec.fields = true; }), Reason::invalid_argument, "outputs"));
  EXPECT_TRUE(throws(submit([](Spec& spec) { spec.probes.emplace_back().name = "middle"; }),
                     Reason::invalid_argument, "probes"));
  EXPECT_TRUE(throws(submit([](Spec& spec) {
                       spec.loads.resize(100, spec.loads[0]);
                       for (std::size_t i = 0; i < spec.loads.size(); ++i)
                         spec.loads[i].name = std::to_string(i);
                       spec.growth->positions = 1000;
                     }),
                     Reason::limit_exceeded, "growth.positions"));

  // What the mesh shows ends the job, with the field.
  const auto field_of = [&](const auto& change) {
    Spec spec = growing_job(mesh);
    change(spec);
    const JobRecord job = test.ended(test.submit(spec));
    EXPECT_EQ(job.state, JobState::failed);
    return job.error && !job.error->fields().empty() ? job.error->fields()[0].field : "";
  };
  EXPECT_EQ(field_of([](Spec& spec) { spec.growth->paths[0].toughness = "-1"; }),
            "growth.paths[0].toughness");
  EXPECT_EQ(field_of([](Spec& spec) { spec.growth->paths[0].to = {0, 0.7}; }), "growth.paths[0]");
  EXPECT_EQ(field_of([](Spec& spec) {
              spec.growth->paths[0].from = {0.5, 0};
              spec.growth->paths[0].to = {-0.5, 0};
            }),
            "growth.paths[0]");
  EXPECT_EQ(field_of([](Spec& spec) { spec.growth->inclusion = "rivet"; }), "growth.inclusion");
}

}  // namespace
}  // namespace anticrack::jobs
