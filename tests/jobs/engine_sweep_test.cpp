// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps: their answers against those of plain jobs, the columns, and matrices that are none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "jobs/sweep_support.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::eventually;
using anticrack::testing::throws;
using errors::Reason;
using store::JobRecord;
using store::JobState;
using ::testing::ElementsAre;

constexpr double mesh_size = 0.25;
constexpr std::int32_t converged = 3, failed = 5;  // LoadCaseAnswer.Status

std::size_t node_count(const anticrack::testing::Backend& backend, const std::string& mesh) {
  return static_cast<std::size_t>(backend.catalogue.get(mesh).node_count);
}

double largest(const std::vector<double>& values) {
  double result = 0;
  for (const double value : values) {
    result = std::max(result, std::abs(value));
  }
  return result;
}

void expect_near(const std::vector<double>& values, const std::vector<double>& expected) {
  ASSERT_EQ(values.size(), expected.size());
  const double tolerance = 1e-9 * largest(expected);
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_NEAR(values[i], expected[i], tolerance) << i;
  }
}

/// What the two have in common, row by row.
void expect_same_answers(const store::BlockSource& sweep, const JobRecord& plain) {
  std::vector<double> energy, length, displacement;
  for (const store::CaseRecord& record : plain.cases) {
    ASSERT_EQ(record.status, store::CaseStatus::converged);
    energy.push_back(record.answer.energy);
    length.push_back(record.answer.contact_length);
    for (const contact::InclusionAnswer& inclusion : record.answer.inclusions) {
      displacement.push_back(inclusion.displacement);
    }
  }
  expect_near(*array<double>(sweep, "sweep/energy"), energy);
  expect_near(*array<double>(sweep, "sweep/contact_length"), length);
  expect_near(*array<double>(sweep, "sweep/displacement"), displacement);
  EXPECT_GT(largest(length), 0);
  EXPECT_EQ(*array<std::int32_t>(sweep, "sweep/status"),
            std::vector<std::int32_t>(plain.cases.size(), converged));
  EXPECT_LT(largest(*array<double>(sweep, "sweep/kkt")), 1e-9);
}

void expect_same_contact(const store::BlockSource& sweep, const store::BlockSource& plain,
                         std::size_t rows) {
  const auto nodes = *array<std::int32_t>(sweep, "sweep/contact_nodes");
  const auto contact = *array<std::uint8_t>(sweep, "sweep/contact");
  const std::size_t count = nodes.size() / 2;
  ASSERT_GT(count, 0U);
  ASSERT_EQ(contact.size(), rows * count);
  for (std::size_t row = 0; row < rows; ++row) {
    std::map<std::int32_t, std::vector<std::int32_t>> expected;
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<std::int32_t>& trace = expected[nodes[2 * i]];
      if (trace.empty()) {
        trace = *array<std::int32_t>(plain, "loads/" + std::to_string(row) + "/traces/" +
                                                std::to_string(nodes[2 * i]) + "/contact");
      }
      ASSERT_EQ(contact[row * count + i], trace.at(static_cast<std::size_t>(nodes[2 * i + 1])))
          << row << ", " << i;
    }
  }
}

void expect_same_traces(const store::BlockSource& sweep, const store::BlockSource& plain,
                        const std::vector<std::uint32_t>& rows) {
  for (const std::uint32_t row : rows) {
    for (const char* name : {"u_minus", "u_plus", "jump", "pressure"}) {
      const std::string path = "traces/" + std::to_string(row) + "/0/" + name;
      const auto values = array<double>(sweep, path);
      ASSERT_TRUE(values) << path;
      expect_near(*values,
                  *array<double>(plain, "loads/" + std::to_string(row) + "/traces/0/" + name));
    }
  }
}

TEST(EngineSweep, CombinesAsLoadCasesDo) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  const std::vector<double> matrix = eighths(300 * std::size_t{3});  // two chunks
  store::JobSpec spec = combinations(mesh, upload(test.backend, matrix));
  spec.sweep->traces = {0, 255, 256, 299};
  const std::string sweep = test.submit(spec);
  const JobRecord record = test.ended(sweep);
  ASSERT_EQ(record.state, JobState::succeeded);
  EXPECT_EQ(record.spec.sweep->rows, 300U);
  EXPECT_TRUE(record.cases.empty());
  EXPECT_EQ(record.sweep.converged, 300U);
  EXPECT_EQ(record.sweep.not_converged, 0U);
  EXPECT_EQ(record.sweep.failed, 0U);
  EXPECT_GT(record.sweep.seconds, 0);
  EXPECT_EQ(test.engine.metrics().load_cases_ended, 300U);
  EXPECT_GT(test.engine.metrics().iterations, 0U);

  const std::string plain = test.submit(one_by_one(mesh, matrix));
  const JobRecord expected = test.ended(plain);
  const auto result = test.engine.result(sweep);
  const auto plain_result = test.engine.result(plain);
  expect_same_answers(*result, expected);
  expect_same_contact(*result, *plain_result, 300);
  expect_same_traces(*result, *plain_result, spec.sweep->traces);
  EXPECT_EQ(layout(*result, "traces/1/0/jump"), nullptr);
  const auto steps = *array<std::int32_t>(*result, "sweep/steps");
  EXPECT_EQ(record.sweep.most_steps, *std::max_element(steps.begin(), steps.end()));
  EXPECT_EQ(record.sweep.worst_kkt, largest(*array<double>(*result, "sweep/kkt")));
}

TEST(EngineSweep, TakesNodalForces) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  const std::size_t nodes = node_count(test.backend, mesh);
  const auto triangulation =
      test.backend.store->triangulation(test.backend.catalogue.get(mesh).sha256);
  const std::vector<double> coefficients = eighths(40 * std::size_t{3}, 2);
  std::vector<double> forces;
  for (std::size_t row = 0; row < 40; ++row) {
    for (std::size_t i = 0; i < nodes; ++i) {
      forces.push_back(coefficients[3 * row] +
                       coefficients[3 * row + 1] * triangulation->xy[2 * i] +
                       coefficients[3 * row + 2] * triangulation->xy[2 * i + 1]);
    }
  }
  store::JobSpec spec = nodal_forces(mesh, upload(test.backend, forces));
  spec.sweep->traces = {3, 39};
  const std::string sweep = test.submit(spec);
  const JobRecord record = test.ended(sweep);
  ASSERT_EQ(record.state, JobState::succeeded);
  EXPECT_EQ(record.spec.sweep->rows, 40U);
  EXPECT_EQ(record.sweep.converged, 40U);
  const std::string plain = test.submit(one_by_one(mesh, coefficients));
  expect_same_answers(*test.engine.result(sweep), test.ended(plain));
  expect_same_traces(*test.engine.result(sweep), *test.engine.result(plain), spec.sweep->traces);
}

TEST(EngineSweep, GivesTheSameBitsWithOneThreadAndTwo) {
  const std::vector<double> matrix = eighths(1500 * std::size_t{3}, 3);
  std::set<std::string> hashes;
  for (const int threads : {1, 2}) {
    EngineOptions options;
    options.threads = threads;
    Engine test(options);
    const std::string mesh = test.ready_mesh(mesh_size);
    store::JobSpec spec = combinations(mesh, upload(test.backend, matrix));
    spec.sweep->traces = {700};
    const std::string sweep = test.submit(spec);
    ASSERT_EQ(test.ended(sweep).state, JobState::succeeded);
    hashes.insert(test.engine.result(sweep)->sha256());
  }
  EXPECT_EQ(hashes.size(), 1U);
}

TEST(EngineSweep, TellsOfEveryRowOnce) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  const std::string id =
      test.submit(combinations(mesh, upload(test.backend, eighths(1000 * std::size_t{3}))));
  const JobRecord record = test.ended(id);
  const auto energy = *array<double>(*test.engine.result(id), "sweep/energy");
  std::vector<int> told(1000);
  for (const RowsEvent& event : rows_told(*test.engine.events(id))) {
    for (std::size_t i = 0; i < event.rows->rows(); ++i) {
      ++told.at(event.first_row + i);
      EXPECT_EQ(event.rows->energy[i], energy.at(event.first_row + i));
    }
  }
  EXPECT_EQ(told, std::vector<int>(1000, 1));
  EXPECT_TRUE(test.told(id, "condensing the load cases"));
  EXPECT_EQ(record.timeline.back().state, JobState::succeeded);
}

TEST(EngineSweep, LaysOutItsResult) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  store::JobSpec spec = combinations(mesh, upload(test.backend, eighths(7 * std::size_t{3})));
  spec.sweep->traces = {2};
  const std::string id = test.submit(spec);
  test.ended(id);
  const auto block = test.engine.result(id);
  const std::uint64_t inclusions = test.backend.catalogue.get(mesh).inclusions.size();
  const store::ArrayLayout* contact_nodes = layout(*block, "sweep/contact_nodes");
  ASSERT_TRUE(contact_nodes);
  EXPECT_EQ(contact_nodes->type, store::ArrayType::int32);
  const std::uint64_t contacts = contact_nodes->shape.at(0);
  EXPECT_THAT(contact_nodes->shape, ElementsAre(contacts, 2));
  const auto expect = [&](const char* name, store::ArrayType type,
                          const std::vector<std::uint64_t>& shape) {
    const store::ArrayLayout* found = layout(*block, name);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->type, type) << name;
    EXPECT_EQ(found->shape, shape) << name;
  };
  using store::ArrayType;
  expect("sweep/status", ArrayType::int32, {7});
  expect("sweep/steps", ArrayType::int32, {7});
  expect("sweep/energy", ArrayType::float64, {7});
  expect("sweep/contact_length", ArrayType::float64, {7});
  expect("sweep/kkt", ArrayType::float64, {7});
  expect("sweep/displacement", ArrayType::float64, {7, inclusions});
  expect("sweep/contact", ArrayType::uint8, {7, contacts});
  const std::uint64_t nodes = layout(*block, "interfaces/0/s")->shape.at(0);
  expect("traces/2/0/jump", ArrayType::float64, {nodes});
  expect("traces/2/0/contact", ArrayType::int32, {nodes});
  EXPECT_EQ(test.ended(id).result_bytes, block->size());
}

TEST(EngineSweep, RefusesAMatrixThatDoesNotFit) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  const auto submit = [&](const std::vector<double>& matrix) {
    test.submit(combinations(mesh, upload(test.backend, matrix)));
  };
  EXPECT_TRUE(throws(
      [&] {
        submit({1, 2, 3, 4});
      },
      Reason::invalid_argument, "sweep.coefficients"));
  EXPECT_TRUE(throws([&] { test.submit(combinations(mesh, std::string(64, 'b'))); },
                     Reason::not_found, "sweep.coefficients"));
  store::JobSpec beyond = combinations(mesh, upload(test.backend, {1, 2, 3}));
  beyond.sweep->traces = {1};
  EXPECT_TRUE(throws([&] { test.submit(beyond); }, Reason::invalid_argument, "sweep.traces[0]"));
  EXPECT_TRUE(test.list().empty());
  EXPECT_EQ(test.engine.metrics().queued_bytes, 0U);
}

TEST(EngineSweep, AnswersTheSameRequestThoughItsMatrixIsGone) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  const store::JobSpec spec = combinations(mesh, upload(test.backend, {1, 2, 3}));
  const std::string id = test.submit(spec, "request");
  test.ended(id);
  ASSERT_EQ(test.backend.store->expire_uploads(store::Clock::time_point::max()), 1U);
  EXPECT_EQ(test.submit(spec, "request"), id);
  EXPECT_TRUE(throws([&] { test.submit(spec); }, Reason::not_found, "sweep.coefficients"));
}

void expect_failed_at(const JobRecord& record, const std::string& field, Reason reason,
                      const std::string& said) {
  EXPECT_EQ(record.state, JobState::failed);
  ASSERT_TRUE(record.error);
  EXPECT_EQ(record.error->reason(), reason);
  ASSERT_EQ(record.error->fields().size(), 1U);
  EXPECT_EQ(record.error->fields()[0].field, field);
  EXPECT_NE(std::string(record.error->what()).find(said), std::string::npos)
      << record.error->what();
}

TEST(EngineSweep, FailsWhereTheNodalForcesAreNotOfTheMesh) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  const std::size_t nodes = node_count(test.backend, mesh);
  const std::string longer = upload(test.backend, std::vector<double>(nodes + 1, 1.0));
  const JobRecord record = test.ended(test.submit(nodal_forces(mesh, longer)));
  expect_failed_at(record, "sweep.nodal_forces", Reason::invalid_argument, std::to_string(nodes));
  EXPECT_FALSE(record.started);
  store::JobSpec beyond = nodal_forces(mesh, upload(test.backend, std::vector<double>(nodes, 1.0)));
  beyond.sweep->traces = {0, 1};
  expect_failed_at(test.ended(test.submit(beyond)), "sweep.traces[1]", Reason::invalid_argument,
                   "no row 1");
  EXPECT_EQ(test.engine.metrics().jobs_queued, 0);
  EXPECT_EQ(test.engine.metrics().jobs_running, 0);
}

TEST(EngineSweep, FailsAtAValueThatIsNotFinite) {
  Engine test(one_thread());
  const std::string mesh = test.ready_mesh(mesh_size);
  std::vector<double> matrix = eighths(600 * std::size_t{3});
  matrix[3 * 400 + 2] = std::nan("");
  const std::string id = test.submit(combinations(mesh, upload(test.backend, matrix)));
  const JobRecord record = test.ended(id);
  expect_failed_at(record, "sweep.coefficients", Reason::invalid_argument,
                   "row 400 of the matrix: column 2 is nan");
  // The chunk before had its answers.
  EXPECT_EQ(record.sweep.converged, 256U);
  EXPECT_EQ(record.sweep.failed, 344U);
  const auto status = *array<std::int32_t>(*test.engine.result(id), "sweep/status");
  EXPECT_EQ(std::count(status.begin(), status.end(), converged), 256);
  EXPECT_EQ(std::count(status.begin(), status.end(), failed), 344);

  std::vector<double> forces(2 * node_count(test.backend, mesh), 1.0);
  forces[node_count(test.backend, mesh) + 4] = HUGE_VAL;
  expect_failed_at(test.ended(test.submit(nodal_forces(mesh, upload(test.backend, forces)))),
                   "sweep.nodal_forces", Reason::invalid_argument,
                   "row 1 of the matrix: column 4 is inf");
}

TEST(EngineSweep, FailsWithTheLoadThatCannotBeCondensed) {
  Engine test;
  store::JobSpec spec = combinations(test.ready_mesh(mesh_size), upload(test.backend, {1, 2, 3}));
  spec.loads[1].force = fem::PerRegion{{{"nowhere", 1.0}}};
  const JobRecord record = test.ended(test.submit(spec));
  EXPECT_EQ(record.state, JobState::failed);
  ASSERT_TRUE(record.error);
  EXPECT_EQ(record.error->fields().at(0).field.rfind("load_cases[1].force", 0), 0U)
      << record.error->fields()[0].field;
  EXPECT_EQ(record.sweep.failed, 1U);
}

TEST(EngineSweep, IsRefusedWhereItsAnswersWouldBeTooLarge) {
  EngineOptions options;
  options.max_result_bytes = 20'000;
  Engine test(options);
  const std::string mesh = test.ready_mesh(mesh_size);
  const auto run = [&](std::size_t rows) {
    return test.ended(test.submit(combinations(mesh, upload(test.backend, eighths(3 * rows)))));
  };
  EXPECT_EQ(run(10).state, JobState::succeeded);
  const JobRecord record = run(1000);
  expect_failed_at(record, "sweep.coefficients", Reason::limit_exceeded, "split the matrix");
  EXPECT_FALSE(record.started);
}

TEST(EngineSweep, ReadsTheArraysOfItsBasis) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  store::JobSpec spec = combinations(mesh, upload(test.backend, {2, 0, 0, 0.5, 0, 0}));
  const std::string constant = test.submit(spec);
  spec.loads[0].force = fem::Array{
      upload(test.backend, std::vector<double>(node_count(test.backend, mesh), 1.0)), false};
  const std::string array_of_ones = test.submit(spec);
  for (const std::string& id : {constant, array_of_ones}) {
    ASSERT_EQ(test.ended(id).state, JobState::succeeded);
  }
  expect_near(*array<double>(*test.engine.result(array_of_ones), "sweep/energy"),
              *array<double>(*test.engine.result(constant), "sweep/energy"));
}

}  // namespace
}  // namespace anticrack::jobs
