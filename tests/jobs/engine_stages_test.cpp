// SPDX-License-Identifier: GPL-3.0-or-later
//
// Jobs with an accuracy: stages, and what interrupts them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <set>
#include <variant>

#include "jobs/engine_support.hpp"
#include "records/case_record.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::Backend;
using records::JobRecord;
using records::JobState;
using records::StageRecord;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

records::JobSpec accurate_job(const std::string& mesh, double energy = 0.02) {
  records::JobSpec spec;
  spec.mesh = mesh;
  spec.loads = {{"opening", fem::Expression{"y > 0 ? 1 : -1"}, ""},
                {"skew", fem::Expression{"x*y > 0 ? 1 : -1"}, ""}};
  spec.accuracy.emplace().energy = energy;
  return spec;
}

double relative_width(const records::StageAnswer& answer) {
  return (*answer.energy_upper - *answer.energy_lower) / -answer.energy;
}

std::set<std::string> meshes_of(const Backend& backend) {
  std::set<std::string> ids;
  for (const records::MeshRecord& mesh : backend.catalogue.list({"", 100, {}})) ids.insert(mesh.id);
  return ids;
}

/// What a result is about: all its numbers.
std::vector<std::vector<double>> numbers_of(const JobEngine& engine, const std::string& id) {
  std::vector<std::vector<double>> numbers;
  for (const char* name : {"loads/0/traces/0/jump", "loads/1/traces/0/pressure", "interfaces/0/x",
                           "loads/0/indicator"})
    numbers.push_back(array<double>(*engine.result(id), name).value_or(std::vector<double>()));
  return numbers;
}

/// Calls `act` once, on the thread that appends the event which `at` chooses.
template <class At, class Act>
auto when(const JobEngine& engine, const std::string& id, At at, Act act) {
  const std::shared_ptr<EventLog> log = engine.events(id);
  return log->listen([log, at, act, seen = std::uint64_t{0}, done = false]() mutable {
    for (const NumberedEvent& event : log->read(std::max(seen, log->earliest() - 1), 1000)) {
      seen = event.sequence;
      if (!done && at(event.event)) {
        done = true;
        act();
      }
    }
  });
}

auto stage_ends(std::size_t count) {
  return [count, ended = std::size_t{0}](const Event& event) mutable {
    return std::holds_alternative<StageEvent>(event) && ++ended == count;
  };
}

auto phase_is(const std::string& detail) {
  return [detail](const Event& event) {
    const auto* phase = std::get_if<PhaseEvent>(&event);
    return phase != nullptr && phase->detail == detail;
  };
}

/// The factors are made before it is solved, unless an equal mesh has left them in the cache.
auto phase_begins(const std::string& stage) {
  return [stage](const Event& event) {
    const auto* phase = std::get_if<PhaseEvent>(&event);
    return phase != nullptr && (phase->detail == stage || phase->detail.starts_with(stage + ":"));
  };
}

TEST(EngineStages, RefineUntilEveryLoadCaseIsAccurate) {
  Engine test;
  const std::string mesh = test.ready_mesh(0.4);
  const records::JobSpec spec = accurate_job(mesh);
  const std::string id = test.submit(spec);
  const JobRecord job = test.ended(id);
  EXPECT_EQ(job.state, JobState::succeeded);
  EXPECT_EQ(job.not_reached, "");
  ASSERT_GE(job.stages.size(), 3U);
  EXPECT_EQ(job.stages.front().mesh, mesh);
  for (std::size_t k = 0; k < job.stages.size(); ++k) {
    const StageRecord& stage = job.stages[k];
    ASSERT_EQ(stage.answers.size(), 2U);
    if (k == 0) continue;
    EXPECT_GT(stage.triangles, job.stages[k - 1].triangles);
    EXPECT_GE(stage.seconds, job.stages[k - 1].seconds);
    for (std::size_t i = 0; i < 2; ++i) {
      // Meshes are nested: their energies, the upper bounds, fall towards the membrane's.
      const records::StageAnswer &now = stage.answers[i], &before = job.stages[k - 1].answers[i];
      EXPECT_LT(*now.energy_upper, *before.energy_upper);
      EXPECT_GE(*now.energy_lower, *before.energy_lower);
      EXPECT_EQ(now.energy, *now.energy_lower + 0.5 * (*now.energy_upper - *now.energy_lower));
    }
  }
  const auto worst = [](const StageRecord& stage) {
    return std::max(relative_width(stage.answers[0]), relative_width(stage.answers[1]));
  };
  EXPECT_LE(worst(job.stages.back()), *spec.accuracy->energy);
  EXPECT_GT(worst(job.stages[job.stages.size() - 2]), *spec.accuracy->energy);
  EXPECT_EQ(job.cases[1].answer.energy, job.stages.back().answers[1].energy);

  // The answers' mesh is kept, those between are not.
  EXPECT_EQ(meshes_of(test.backend), (std::set<std::string>{mesh, job.stages.back().mesh}));
  const records::MeshRecord last = test.backend.catalogue.get(job.stages.back().mesh);
  EXPECT_EQ(last.triangle_count, job.stages.back().triangles);
  EXPECT_GT(last.bisection_bound, 0);
  EXPECT_GE(last.minimum_angle, 0.99 * last.bisection_bound) << "bisected from the newest vertices";
  const auto& made = std::get<records::Refinement>(last.definition);
  EXPECT_EQ(made.job, id);
  EXPECT_EQ(made.parent, job.stages[job.stages.size() - 2].mesh);

  std::size_t told = 0;
  for (const NumberedEvent& event : test.events(id)) {
    const auto* stage = std::get_if<StageEvent>(&event.event);
    if (stage != nullptr) {
      EXPECT_EQ(stage->stage->mesh, job.stages.at(told++).mesh);
    }
  }
  EXPECT_EQ(told, job.stages.size());
}

TEST(EngineStages, KeepTheirMeshesAndIndicatorsWhereAskedTo) {
  Engine test;
  records::JobSpec spec = accurate_job(test.ready_mesh(0.4));
  spec.accuracy->keep_stages = true;
  spec.indicators = true;
  const std::string id = test.submit(spec);
  const JobRecord job = test.ended(id);
  EXPECT_EQ(meshes_of(test.backend).size(), job.stages.size());
  const auto indicator = array<double>(*test.engine.result(id), "loads/0/indicator");
  ASSERT_TRUE(indicator);
  EXPECT_EQ(indicator->size(), job.stages.back().triangles);
  double sum = 0;
  for (const double one : *indicator) sum += one;
  EXPECT_GE(std::sqrt(sum) * (1 + 1e-9), *job.cases[0].answer.error_bound);
}

TEST(EngineStages, StopAtALimitAndSaySo) {
  Engine test;
  const std::string mesh = test.ready_mesh(0.4);
  records::JobSpec spec = accurate_job(mesh, 1e-3);
  spec.accuracy->max_triangles = 3000;
  const JobRecord full = test.ended(test.submit(spec));
  EXPECT_EQ(full.state, JobState::not_converged);
  EXPECT_THAT(full.not_reached, HasSubstr("max_triangles"));
  EXPECT_LE(full.stages.back().triangles, 3000U);
  EXPECT_GT(full.stages.back().triangles, 1500U) << "what is allowed is used";
  EXPECT_EQ(full.cases[0].status, contact::Status::converged);

  spec.accuracy->max_triangles = 0;
  spec.accuracy->time = 1ms;
  const JobRecord late = test.ended(test.submit(spec));
  EXPECT_EQ(late.state, JobState::not_converged);
  EXPECT_THAT(late.not_reached, HasSubstr("time"));

  spec.accuracy->time = 0ms;
  spec.loads[1].point_forces = {{0.1, 0.3, 1}};
  const JobRecord unbounded = test.ended(test.submit(spec));
  EXPECT_EQ(unbounded.state, JobState::not_converged);
  EXPECT_EQ(unbounded.stages.size(), 1U);
  EXPECT_THAT(unbounded.not_reached, HasSubstr("load case \"skew\""));
}

TEST(EngineStages, StopAtTheMemoryBudgetAndSaySo) {
  JobRecord whole;
  std::uint64_t of_stage = 0;
  {
    Engine test;
    records::JobSpec spec = accurate_job(test.ready_mesh(0.4));
    spec.accuracy->keep_stages = true;
    whole = test.ended(test.submit(spec));
    ASSERT_GE(whole.stages.size(), 3U);
    const auto mesh = test.backend.catalogue.get(whole.stages[1].mesh);
    of_stage = operators::estimate_bytes(*test.backend.store->triangulation(mesh.sha256));
  }
  anticrack::testing::BackendOptions options;
  options.memory_budget = of_stage + of_stage / 50;
  Engine test({}, options);
  const std::string id = test.submit(accurate_job(test.ready_mesh(0.4)));
  const JobRecord job = test.ended(id);
  EXPECT_EQ(job.state, JobState::not_converged);
  EXPECT_THAT(job.not_reached, HasSubstr("memory-budget"));
  EXPECT_GE(job.stages.size(), 2U) << "what is allowed is used";
  EXPECT_LT(job.stages.back().triangles, whole.stages.back().triangles);
  EXPECT_EQ(job.cases[1].status, contact::Status::converged);
  EXPECT_EQ(job.cases[1].answer.energy, job.stages.back().answers[1].energy);
  EXPECT_TRUE(array<double>(*test.engine.result(id), "loads/1/traces/0/jump"));
}

TEST(EngineStages, GoBackToWhatFitsIntoASmallerMemoryBudgetAfterARestart) {
  anticrack::testing::TemporaryFolder folder;
  anticrack::testing::BackendOptions options;
  options.data_folder = (folder / "data").string();
  std::string id;
  std::uint64_t second = 0;
  {
    Engine test({}, options);
    id = test.submit(accurate_job(test.ready_mesh(0.4), 0.005));
    std::promise<void> begun;
    const auto listener =
        when(test.engine, id, phase_begins("stage 3"), [&] { begun.set_value(); });
    ASSERT_EQ(begun.get_future().wait_for(300s), std::future_status::ready);
    test.engine.stop(0ms);
    const auto stages = test.backend.store->job(id)->stages;
    ASSERT_GE(stages.size(), 3U);
    const auto mesh = test.backend.catalogue.get(stages[1].mesh);
    second = operators::estimate_bytes(*test.backend.store->triangulation(mesh.sha256));
  }
  options.memory_budget = second + second / 50;
  Engine test({}, options);
  const JobRecord job = test.ended(id);
  EXPECT_EQ(job.state, JobState::not_converged);
  EXPECT_THAT(job.not_reached, HasSubstr("memory budget"));
  ASSERT_EQ(job.stages.size(), 2U);
  EXPECT_EQ(job.cases[0].status, contact::Status::converged);
  EXPECT_EQ(job.cases[0].answer.energy, job.stages.back().answers.at(0).energy);
  EXPECT_TRUE(array<double>(*test.engine.result(id), "loads/1/traces/0/jump"));
}

TEST(EngineStages, CancelledBetweenTwoTheyKeepTheAnswersOfTheLast) {
  Engine test;
  const records::JobSpec spec = accurate_job(test.ready_mesh(0.4));
  const JobRecord whole = test.ended(test.submit(spec));
  for (std::size_t count = 1; count < whole.stages.size(); ++count) {
    const std::string id = test.engine.submit({spec, "", ""}).id;
    const auto listener = when(test.engine, id, stage_ends(count), [&] { test.engine.cancel(id); });
    const JobRecord job = test.ended(id);
    EXPECT_EQ(job.state, JobState::cancelled);
    ASSERT_EQ(job.stages.size(), count);
    EXPECT_EQ(job.cases[0].answer.energy, whole.stages[count - 1].answers[0].energy);
    EXPECT_TRUE(array<double>(*test.engine.result(id), "loads/1/traces/0/jump"));
  }
}

TEST(EngineStages, CutShortTheyFallBackToTheOneBefore) {
  Engine test;
  const records::JobSpec spec = accurate_job(test.ready_mesh(0.4));
  const JobRecord whole = test.ended(test.submit(spec));
  for (std::size_t stage = 2; stage <= whole.stages.size(); ++stage) {
    for (const bool as_it_begins : {false, true}) {
      const std::string id = test.engine.submit({spec, "", ""}).id;
      const std::string name = "stage " + std::to_string(stage);
      const auto cancel = [&] { test.engine.cancel(id); };
      const auto listener = as_it_begins ? when(test.engine, id, phase_begins(name), cancel)
                                         : when(test.engine, id, phase_is(name), cancel);
      const JobRecord job = test.ended(id);
      EXPECT_EQ(job.state, JobState::cancelled);
      ASSERT_EQ(job.stages.size(), stage - 1);
      EXPECT_EQ(job.cases[0].answer.energy, whole.stages[stage - 2].answers[0].energy);
      EXPECT_EQ(job.cases[1].status, contact::Status::converged);
      EXPECT_TRUE(array<double>(*test.engine.result(id), "loads/1/traces/0/jump"));
      EXPECT_EQ(meshes_of(test.backend).count(job.stages.back().mesh), 1U);
    }
  }
}

TEST(EngineStages, GoOnAfterAStopInEachOfThemWithTheSameBits) {
  anticrack::testing::TemporaryFolder folder;
  anticrack::testing::BackendOptions options;
  options.data_folder = (folder / "data").string();
  records::JobSpec spec;
  JobRecord whole;
  std::vector<std::vector<double>> expected;
  {
    Engine test({}, options);
    spec = accurate_job(test.ready_mesh(0.4));
    spec.indicators = true;
    const std::string id = test.submit(spec);
    whole = test.ended(id);
    expected = numbers_of(test.engine, id);
  }
  std::string id;
  for (std::size_t stage = 1; stage <= whole.stages.size(); ++stage) {
    Engine test({}, options);
    if (id.empty()) id = test.submit(spec);
    if (records::ended(test.state(id))) break;  // a stop came late
    std::promise<void> begun;
    const auto solves = [stage](const Event& event) {  // this stage or, after a late stop, another
      const auto* phase = std::get_if<PhaseEvent>(&event);
      if (phase == nullptr) return std::holds_alternative<EndEvent>(event);
      return phase->detail.starts_with("stage ") && phase->detail.find(':') == std::string::npos &&
             std::stoul(phase->detail.substr(6)) >= stage;
    };
    const auto listener = when(test.engine, id, solves, [&] { begun.set_value(); });
    ASSERT_EQ(begun.get_future().wait_for(300s), std::future_status::ready);
    test.engine.stop(0ms);
  }
  Engine test({}, options);
  const JobRecord job =
      records::ended(test.backend.store->job(id)->state) ? test.engine.get(id) : test.ended(id);
  EXPECT_EQ(job.state, JobState::succeeded);
  ASSERT_EQ(job.stages.size(), whole.stages.size());
  EXPECT_EQ(numbers_of(test.engine, id), expected);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(job.cases[i].answer.energy_lower, whole.cases[i].answer.energy_lower);
    const contact::InclusionAnswer& one = job.cases[i].answer.inclusions[0];
    EXPECT_EQ(one.displacement_lower, whole.cases[i].answer.inclusions[0].displacement_lower);
    EXPECT_EQ(one.displacement_upper, whole.cases[i].answer.inclusions[0].displacement_upper);
  }
}

TEST(EngineStages, DoNotNeedToBeStored) {
  Backend backend;
  anticrack::testing::FailingStore& store = *backend.store;
  JobEngine engine(unlimited(), store, backend.catalogue);
  const records::JobSpec spec = accurate_job(ready_mesh(backend, 0.4));
  const std::string id = engine.submit({spec, "", ""}).id;
  const auto listener = when(engine, id, stage_ends(1), [&] { store.put_fails = true; });
  EXPECT_EQ(ended(engine, id).state, JobState::succeeded);
  EXPECT_GT(store.failures, 0);
}

TEST(EngineStages, EndWithWhatTheyHaveWhereTheDiskHasNoRoomForAFinerMesh) {
  anticrack::testing::BackendOptions options;
  options.disk_budget = 1'000'000;
  Engine test({}, options);
  const JobRecord job = test.ended(test.submit(accurate_job(test.ready_mesh(0.4), 1e-4)));
  EXPECT_EQ(job.state, JobState::not_converged);
  EXPECT_THAT(job.not_reached, HasSubstr("disk"));
  EXPECT_GE(job.stages.size(), 2U);
  EXPECT_EQ(job.cases[0].answer.energy, job.stages.back().answers[0].energy);
}

TEST(EngineStages, AMeshThatIsGoneMakesThemBeginAnew) {
  Backend backend;
  const records::JobSpec spec = accurate_job(ready_mesh(backend, 0.4));
  JobRecord record;
  record.id = "job";
  record.spec = spec;
  record.cases.resize(2);
  record.created = records::Clock::now();
  record.stages = {{spec.mesh, 10, 1, {{}, {}}}, {"0123456789abcdef", 20}};
  backend.store->create(record, "print");
  JobEngine engine(unlimited(), *backend.store, backend.catalogue);
  const JobRecord job = ended(engine, "job");
  EXPECT_EQ(job.state, JobState::succeeded);
  EXPECT_NE(job.stages.at(1).mesh, "0123456789abcdef");
}

}  // namespace
}  // namespace anticrack::jobs
