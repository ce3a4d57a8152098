// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job is cancelled in each thing that the engine does for it, as its looks tell: nothing else is
// begun, and the same job has the same answer afterwards.
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <map>
#include <set>
#include <thread>

#include "jobs/sweep_support.hpp"
#include "records/case_record.hpp"
#include "support/every_look.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::eventually;
using anticrack::testing::EveryLook;
using records::JobRecord;
using records::JobState;

/// Of a cancelled job that had answers: they are kept.
const std::set<std::string> keeping{"hashing a result", "writing a result"};

class JobStops : public ::testing::Test {
 protected:
  /// All numbers of its answers.
  std::vector<std::vector<double>> numbers_of(const std::string& id) const {
    std::vector<std::vector<double>> numbers;
    const JobRecord record = test.engine.get(id);
    for (const records::CaseRecord& one : record.cases) {
      const auto& answer = one.answer;
      numbers.push_back(
          {answer.energy, answer.energy_lower.value_or(0), answer.energy_upper.value_or(0)});
      for (const contact::InclusionAnswer& inclusion : answer.inclusions)
        numbers.back().insert(numbers.back().end(),
                              {inclusion.displacement, inclusion.displacement_lower.value_or(0),
                               inclusion.displacement_upper.value_or(0)});
    }
    for (const char* name : {"loads/0/traces/0/jump", "sweep/energy", "sweep/energy_lower"})
      numbers.push_back(
          array<double>(*test.engine.result(id), name).value_or(std::vector<double>()));
    return numbers;
  }

  /// As before any job: no factor is in memory.
  void forget() {
    ASSERT_TRUE(eventually([&] {
      try {
        for (const records::MeshRecord& mesh : test.backend.catalogue.list({"", 1000, {}}))
          test.backend.catalogue.evict(mesh.id);
        return test.engine.idle();
      } catch (const errors::Error&) {
        return false;  // whoever was stopped is on its way out
      }
    }));
  }

  using Looks = std::map<std::string, std::size_t>;

  /// Runs it to its end, then cancels it in all that it does. `least`: of looks, where each loop
  /// has one on a mesh as small as this.
  void walk(const records::JobSpec& spec, const Looks& least) {
    Looks all;
    std::vector<std::vector<double>> expected;
    forget();
    {
      const EveryLook looks;
      const std::string id = test.submit(spec);
      ASSERT_EQ(test.ended(id).state, JobState::succeeded);
      expected = numbers_of(id);
      all = looks.before();
    }
    for (const auto& [doing, count] : least)
      EXPECT_GE(all[doing], count) << doing << ": a loop does not look";
    for (const auto& [doing, count] : all)
      for (const std::size_t number : std::set<std::size_t>{1, (count + 1) / 2})
        if (count > 0) cancel_at(spec, doing, number);
    const std::string id = test.submit(spec);
    EXPECT_EQ(test.ended(id).state, JobState::succeeded);
    EXPECT_EQ(numbers_of(id), expected);
  }

  void cancel_at(const records::JobSpec& spec, const std::string& doing, std::size_t number) {
    SCOPED_TRACE(doing + ", look " + std::to_string(number));
    forget();
    std::string id;
    std::promise<void> submitted;
    const EveryLook looks(doing, number, [&] {
      submitted.get_future().wait();
      test.engine.cancel(id);
    });
    id = test.submit(spec);
    submitted.set_value();
    EXPECT_EQ(test.ended(id).state, JobState::cancelled);
    ASSERT_TRUE(eventually([&] { return looks.acted(); }));
    // Whoever worked for it alone may be on its way out still.
    for (std::size_t heard = SIZE_MAX; heard != looks.after().size();) {
      heard = looks.after().size();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    const Looks before = looks.before();
    std::size_t others = 0;
    for (const std::string& after : looks.after()) {
      EXPECT_TRUE(before.count(after) > 0 || keeping.count(after) > 0) << after << " was begun";
      others += keeping.count(after) > 0 ? 0 : 1;
    }
    EXPECT_LE(others, 8U) << "looks after it was cancelled";
    EXPECT_EQ(test.engine.metrics().jobs_running, 0);
  }

  Engine test{one_thread()};
};

/// Mesher processes of this one.
int meshers() {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "stat");
    std::string pid, program, state, parent;
    if (!(file >> pid >> program >> state >> parent)) continue;
    count += parent == std::to_string(getpid()) && program.starts_with("(anticrack-mesh") ? 1 : 0;
  }
  return count;
}

/// A process of its own, whose looks are reported: it is killed.
TEST_F(JobStops, WhileTheMesherWorks) {
  records::GeometrySource strip{anticrack::testing::paper_geometry(), {mesh::Preset::uniform}};
  strip.geometry.boundary = {{-1, -1e-4}, {1, -1e-4}, {1, 1}, {-1, 1}};  // half a minute in gmsh
  const EveryLook looks;
  const std::string id =
      test.submit(short_job(test.backend.catalogue.create(strip, "", "", true).id));
  ASSERT_TRUE(eventually([&] {
    for (const NumberedEvent& event : test.events(id)) {
      const auto* phase = std::get_if<PhaseEvent>(&event.event);
      if (phase != nullptr && phase->detail.starts_with("meshing: generating a mesh")) return true;
    }
    return false;
  }));
  EXPECT_EQ(meshers(), 1);
  test.engine.cancel(id);
  EXPECT_EQ(test.ended(id).state, JobState::cancelled);
  EXPECT_TRUE(eventually([] { return meshers() == 0; }));
  EXPECT_EQ(looks.before().count("cutting a mesh along its interfaces"), 0U);
  EXPECT_EQ(test.ended(test.submit(short_job(test.ready_mesh(0.3)))).state, JobState::succeeded);
}

/// All from a triangulation to bounds of the energy and of A, and from each mesh to a finer one.
TEST_F(JobStops, InAdaptiveStages) {
  records::JobSpec spec;
  spec.mesh = test.ready_mesh(0.4);
  spec.loads = {{"lifted", fem::Expression{"x^2 + y^2 < 0.3 ? 1 : x*y"}, "x*y"}};
  spec.accuracy.emplace().energy = 0.02;
  walk(spec, {
                 // Factors
                 {"hashing a mesh", 1},
                 {"estimating the memory of a mesh", 1},
                 {"finding the triangles at interfaces", 4},
                 {"cutting a mesh along its interfaces", 33},
                 {"sorting the nodes of a mesh", 18},
                 {"looking for parts that nothing holds", 6},
                 {"working on parts of a mesh", 6},
                 {"assembling the stiffness of a mesh", 24},
                 {"listing the neighbours of unknowns", 12},
                 {"ordering the unknowns of a mesh", 6},
                 {"analysing a factor", 6},
                 {"factorising a mesh", 18},
                 {"working on dense matrices", 3},
                 // The solution
                 {"integrating a load", 100},
                 {"solving on a mesh", 6},
                 {"solving for contact", 3},
                 // Bounds
                 {"gathering triangles about a tip", 3},
                 {"measuring tips", 12},
                 {"computing bounds", 3},
                 {"listing the edges of a mesh", 60},
                 {"preparing a mesh for bounds", 30},
                 {"measuring triangles for bounds", 9},
                 {"looking for ways out of a membrane", 3},
                 {"balancing a load", 9},
                 {"lifting the boundary", 3},
                 {"computing a flux in equilibrium", 24},
                 {"computing bounds of the energy", 3},
                 {"computing bounds of A", 10},
                 // The next stage
                 {"choosing which triangles to bisect", 6},
                 {"bisecting a mesh", 14},
                 {"measuring a mesh", 8},
                 {"hashing a result", 3},
             });
}

TEST_F(JobStops, InLoadsFromArraysAndAResultWithFields) {
  records::JobSpec spec;
  spec.mesh = test.ready_mesh(0.06);
  const std::string values = upload(test.backend, eighths(node_count(test.backend, spec.mesh)));
  spec.loads = {{"array", fem::Array{values, false, {}}}, {"constant", 1.0}};
  spec.fields = true;
  walk(spec, {{"reading a file", 1},
              {"summing loads over a mesh", 12},
              {"hashing a result", 1},
              {"writing a result", 1}});
}

TEST_F(JobStops, InASweepWithBounds) {
  records::JobSpec spec = combinations(test.ready_mesh(0.3), upload(test.backend, eighths(3 * 20)));
  spec.sweep->bounds = true;
  walk(spec, {{"reading a file", 1},
              {"computing what bounds of rows share", 20},
              {"computing bounds of rows", 20},
              {"hashing a result", 1}});
  spec.loads[0].boundary_value = "x^2";  // rows cannot share
  walk(spec, {{"computing bounds of the energy", 20}, {"computing bounds of A", 34}});
}

TEST_F(JobStops, InAlgorithm2) {
  walk(short_job(test.ready_mesh(0.1)),
       {{"computing theta*", 10}, {"inverting a dense matrix", 2}});
}

/// Every position of a front is one thing of many.
TEST_F(JobStops, WhileAFrontGrows) {
  records::JobSpec spec;
  spec.mesh = test.ready_mesh(0.02);
  spec.loads = {{"opening", fem::Expression{"y > 0 ? 1 : -1"}, ""}};
  spec.growth.emplace().paths = {{"interface", {-0.5, 0}, {0, 0}, "0.1"}};
  spec.growth->positions = 8;
  walk(spec, {{"growing cracks and delaminations", 5},
              {"solving for contact", 5},
              {"gathering triangles about a tip", 5}});
}

/// Each has meshes of its own, from their factors to bounds.
TEST_F(JobStops, InFinalPositionsOfGrowth) {
  records::JobSpec spec;
  spec.mesh = test.ready_mesh(0.03);
  spec.loads = {{"opening", fem::Expression{"y > 0 ? 1 : -1"}, ""}};
  spec.growth.emplace().paths = {{"interface", {-0.5, 0}, {0, 0}, "0.1"}};
  spec.growth->positions = 4;
  spec.growth->final_positions = 2;
  spec.growth->final_error = 0.5;
  walk(spec, {{"listing the edges of a mesh", 2},
              {"factorising a mesh", 2},
              {"integrating a load", 2},
              {"computing bounds", 2},
              {"choosing which triangles to bisect", 1},
              {"bisecting a mesh", 1}});
}

}  // namespace
}  // namespace anticrack::jobs
