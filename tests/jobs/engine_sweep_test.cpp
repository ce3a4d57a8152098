// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps: their answers against those of plain jobs, and their columns.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "contact/sweep_columns.hpp"
#include "jobs/sweep_support.hpp"
#include "records/case_record.hpp"

namespace anticrack::jobs {
namespace {

using records::JobRecord;
using records::JobState;
using ::testing::ElementsAre;

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

/// What the two have in common, row by row. With bounds, energy and A are the middles of these.
void expect_same_answers(const records::BlockSource& sweep, const JobRecord& plain,
                         bool bounds = false) {
  std::vector<double> energy, length, displacement;
  for (const records::CaseRecord& record : plain.cases) {
    ASSERT_EQ(record.status, contact::Status::converged);
    energy.push_back(bounds ? record.answer.energy : record.answer.energy_mesh);
    length.push_back(record.answer.contact_length);
    for (const contact::InclusionAnswer& inclusion : record.answer.inclusions) {
      displacement.push_back(bounds ? inclusion.displacement : inclusion.displacement_mesh);
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

void expect_same_contact(const records::BlockSource& sweep, const records::BlockSource& plain,
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

void expect_same_traces(const records::BlockSource& sweep, const records::BlockSource& plain,
                        const std::vector<std::uint32_t>& rows) {
  for (const std::uint32_t row : rows) {
    for (const char* name : {"u_minus", "u_plus", "jump", "pressure", "flux", "force"}) {
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
  records::JobSpec spec = combinations(mesh, upload(test.backend, matrix));
  spec.sweep->traces = {0, 255, 256, 299};
  const std::string sweep = test.submit(spec);
  const JobRecord record = test.ended(sweep);
  ASSERT_EQ(record.state, JobState::succeeded);
  EXPECT_EQ(record.spec.sweep->rows, 300U);
  EXPECT_TRUE(record.cases.empty());
  EXPECT_EQ(record.sweep.converged, 300U);
  EXPECT_EQ(record.sweep.not_converged, 0U);
  EXPECT_EQ(record.sweep.failed, 0U);
  EXPECT_GT(record.sweep.solve_time.count(), 0);
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

/// The bounds of energy or A, `what`, of all rows.
struct RowIntervals {
  RowIntervals(const records::BlockSource& result, const std::string& what)
      : lower(*array<double>(result, "sweep/" + what + "_lower")),
        upper(*array<double>(result, "sweep/" + what + "_upper")) {}
  std::vector<double> lower, upper;
};

/// Rows and the same loads as load cases: numbers of the mesh are the same, and bounds of both hold
/// the same exact number and are about as wide. Returns how many rows have bounds of A of their
/// own.
std::size_t expect_bounds_as_load_cases(const records::BlockSource& result,
                                        const JobRecord& plain) {
  const RowIntervals energy(result, "energy"), a(result, "displacement");
  const auto middles = *array<double>(result, "sweep/energy");
  std::vector<double> energies, displacements;
  std::size_t others = 0;
  const auto compare = [&](double lower, double upper, double of_lower, double of_upper) {
    const double rounding = 1e-12 * (std::abs(of_lower) + std::abs(of_upper));
    EXPECT_LE(lower, of_upper + rounding);
    EXPECT_GE(upper, of_lower - rounding);
    EXPECT_LE(upper - lower, 2 * (of_upper - of_lower) + rounding);
    others += lower != of_lower ? 1 : 0;
  };
  for (std::size_t row = 0; row < plain.cases.size(); ++row) {
    SCOPED_TRACE("row " + std::to_string(row));
    const contact::AnswerSummary& answer = plain.cases[row].answer;
    energies.push_back(answer.energy_mesh);
    compare(energy.lower[row], energy.upper[row], *answer.energy_lower, *answer.energy_upper);
    EXPECT_EQ(middles[row], (energy.lower[row] + energy.upper[row]) / 2);
    for (const contact::InclusionAnswer& one : answer.inclusions) {
      const std::size_t place = displacements.size();
      displacements.push_back(one.displacement_mesh);
      compare(a.lower[place], a.upper[place], *one.displacement_lower, *one.displacement_upper);
    }
  }
  expect_near(*array<double>(result, "sweep/energy_mesh"), energies);
  expect_near(*array<double>(result, "sweep/displacement_mesh"), displacements);
  return others;
}

TEST(EngineSweep, HasTheBoundsOfLoadCasesWhereItIsAskedForThem) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  // Three chunks of rows that share their bounds; one has no load, and one little.
  std::vector<double> matrix = eighths(600 * std::size_t{3}, 5);
  std::fill_n(matrix.begin() + 3 * 17, 3, 0.0);
  std::fill_n(matrix.begin() + 3 * 18, 3, 1.0 / 64);
  records::JobSpec spec = combinations(mesh, upload(test.backend, matrix));
  const std::string without = test.submit(spec);
  test.ended(without);
  spec.sweep->bounds = true;
  const std::string sweep = test.submit(spec), plain = test.submit(one_by_one(mesh, matrix));
  const JobRecord ended = test.ended(sweep), expected = test.ended(plain);
  ASSERT_EQ(ended.state, JobState::succeeded);
  EXPECT_TRUE(ended.sweep.warnings.empty());
  const auto result = test.engine.result(sweep), other = test.engine.result(without);
  EXPECT_GT(expect_bounds_as_load_cases(*result, expected), 600U) << "bounded one by one";
  for (const std::string name : {"energy", "displacement"}) {
    EXPECT_EQ(*array<double>(*result, "sweep/" + name + "_mesh"),
              *array<double>(*other, "sweep/" + name));
    for (const char* part : {"_lower", "_upper", "_mesh"})
      EXPECT_EQ(layout(*other, "sweep/" + name + part), nullptr) << name << part;
    const RowIntervals of(*result, name);
    const std::size_t count = of.lower.size() / 600;
    EXPECT_EQ(largest({of.lower.begin() + 17 * count, of.lower.begin() + 18 * count}), 0);
    EXPECT_EQ(largest({of.upper.begin() + 17 * count, of.upper.begin() + 18 * count}), 0);
  }
}

/// Where rows cannot share, as with boundary values that bend, they have the bounds of load cases.
TEST(EngineSweep, BoundsRowsOneByOneWhereTheyCannotShare) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  const std::vector<double> matrix = eighths(20 * std::size_t{3}, 5);
  records::JobSpec spec = combinations(mesh, upload(test.backend, matrix));
  records::JobSpec cases = one_by_one(mesh, matrix);
  spec.loads[1].boundary_value = "x^2";
  for (std::size_t row = 0; row < 20; ++row)
    cases.loads[row].boundary_value = "(" + std::to_string(matrix[3 * row + 1]) + ")*x^2";
  spec.sweep->bounds = true;
  const std::string sweep = test.submit(spec), plain = test.submit(cases);
  ASSERT_EQ(test.ended(sweep).state, JobState::succeeded);
  const JobRecord expected = test.ended(plain);
  const auto result = test.engine.result(sweep);
  expect_same_answers(*result, expected, true);
  std::vector<double> lower, upper, a_lower, a_upper;
  for (const records::CaseRecord& record : expected.cases) {
    lower.push_back(record.answer.energy_lower.value());
    upper.push_back(record.answer.energy_upper.value());
    for (const contact::InclusionAnswer& inclusion : record.answer.inclusions) {
      a_lower.push_back(inclusion.displacement_lower.value());
      a_upper.push_back(inclusion.displacement_upper.value());
    }
  }
  const RowIntervals energy(*result, "energy"), a(*result, "displacement");
  expect_near(energy.lower, lower);
  expect_near(energy.upper, upper);
  expect_near(a.lower, a_lower);
  expect_near(a.upper, a_upper);
}

TEST(EngineSweep, SaysWhyARowHasNoBounds) {
  Engine test;
  records::JobSpec spec = combinations(
      test.ready_mesh(mesh_size), upload(test.backend, {1, 0, 0, 1, 0, 0.5, 0, 1, 0, 0, 0, 1}));
  spec.loads[2].force = 0.0;
  spec.loads[2].point_forces = {{0.3, 0.4, 1}};
  spec.sweep->bounds = true;
  const std::string id = test.submit(spec);
  const JobRecord ended = test.ended(id);
  ASSERT_EQ(ended.sweep.converged, 4U);
  ASSERT_EQ(ended.sweep.warnings.size(), 1U);
  EXPECT_EQ(ended.sweep.warnings[0].rfind("rows without bounds: a point force", 0), 0U);
  const auto result = test.engine.result(id);
  for (const char* name : {"energy_lower", "energy_upper", "displacement_lower"}) {
    const auto values = *array<double>(*result, std::string("sweep/") + name);
    for (std::size_t i = 0; i < values.size(); ++i)
      EXPECT_EQ(std::isnan(values[i]), (i * 4 / values.size()) % 2 == 1) << name << i;
  }
}

TEST(EngineSweep, TellsTheWarningsOfItsBasis) {
  Engine test;
  records::JobSpec spec =
      combinations(test.ready_mesh(mesh_size), upload(test.backend, eighths(std::size_t{3})));
  spec.loads[1].force = fem::Expression{"y > 0 ? 1 : sin(1e5*x*y)/sqrt(abs(x - 0.03))"};
  EXPECT_EQ(test.ended(test.submit(spec)).sweep.warnings.size(), 1U);
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
  records::JobSpec spec = nodal_forces(mesh, upload(test.backend, forces));
  spec.sweep->traces = {3, 39};
  const std::string sweep = test.submit(spec);
  const JobRecord record = test.ended(sweep);
  ASSERT_EQ(record.state, JobState::succeeded);
  EXPECT_EQ(record.spec.sweep->rows, 40U);
  EXPECT_EQ(record.sweep.converged, 40U);
  const std::string plain = test.submit(one_by_one(mesh, coefficients));
  expect_same_answers(*test.engine.result(sweep), test.ended(plain));
  expect_same_traces(*test.engine.result(sweep), *test.engine.result(plain), spec.sweep->traces);
  spec.sweep->bounds = true;
  const std::string bounded = test.submit(spec);
  const std::vector<records::CaseRecord> cases = test.ended(plain).cases;
  ASSERT_EQ(test.ended(bounded).state, JobState::succeeded);
  std::vector<double> lower;
  for (const records::CaseRecord& record : cases)
    lower.push_back(record.answer.energy_lower.value());
  expect_near(*array<double>(*test.engine.result(bounded), "sweep/energy_lower"), lower);
}

TEST(EngineSweep, GivesTheSameBitsWithOneThreadAndTwo) {
  const std::vector<double> matrix = eighths(1500 * std::size_t{3}, 3);
  std::set<std::string> hashes;
  for (const int threads : {1, 2}) {
    EngineOptions options;
    options.threads = threads;
    Engine test(options);
    const std::string mesh = test.ready_mesh(mesh_size);
    records::JobSpec spec = combinations(mesh, upload(test.backend, matrix));
    spec.sweep->traces = {700};
    for (const bool bounds : {false, true}) {
      spec.sweep->bounds = bounds;
      const std::string sweep = test.submit(spec);
      ASSERT_EQ(test.ended(sweep).state, JobState::succeeded);
      hashes.insert(test.engine.result(sweep)->sha256());
    }
  }
  EXPECT_EQ(hashes.size(), 2U);
}

TEST(EngineSweep, RowsThatDoNotConvergeDoNotFailIt) {
  Engine test;
  records::JobSpec spec =
      combinations(test.ready_mesh(mesh_size), upload(test.backend, eighths(300 * std::size_t{3})));
  spec.solver = contact::ActiveSetOptions{1e-12, 1};  // a step: enough where nothing opens
  spec.sweep->traces = {0, 1, 2, 3, 4, 5, 6, 7};
  const std::string id = test.submit(spec);
  const JobRecord record = test.ended(id);
  EXPECT_EQ(record.state, JobState::not_converged);
  EXPECT_GT(record.sweep.not_converged, 0U);
  EXPECT_EQ(record.sweep.converged + record.sweep.not_converged, 300U);
  EXPECT_EQ(record.sweep.failed, 0U);
  EXPECT_EQ(record.sweep.most_steps, 1);
  const auto result = test.engine.result(id);
  const auto status = *array<std::int32_t>(*result, "sweep/status");
  EXPECT_EQ(static_cast<std::uint64_t>(std::count(status.begin(), status.end(), not_converged)),
            record.sweep.not_converged);
  EXPECT_TRUE(layout(*result, "traces/7/0/jump"));
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
  records::JobSpec spec = combinations(mesh, upload(test.backend, eighths(7 * std::size_t{3})));
  spec.sweep->traces = {2};
  const std::string id = test.submit(spec);
  test.ended(id);
  const auto block = test.engine.result(id);
  const std::uint64_t inclusions = test.backend.catalogue.get(mesh).inclusions.size();
  const records::ArrayLayout* contact_nodes = layout(*block, "sweep/contact_nodes");
  ASSERT_TRUE(contact_nodes);
  EXPECT_EQ(contact_nodes->type, records::ArrayType::int32);
  const std::uint64_t contacts = contact_nodes->shape.at(0);
  EXPECT_THAT(contact_nodes->shape, ElementsAre(contacts, 2));
  const auto expect = [&](const char* name, records::ArrayType type,
                          const std::vector<std::uint64_t>& shape) {
    const records::ArrayLayout* found = layout(*block, name);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->type, type) << name;
    EXPECT_EQ(found->shape, shape) << name;
  };
  using records::ArrayType;
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

TEST(EngineSweep, ReadsTheArraysOfItsBasis) {
  Engine test;
  const std::string mesh = test.ready_mesh(mesh_size);
  records::JobSpec spec = combinations(mesh, upload(test.backend, {2, 0, 0, 0.5, 0, 0}));
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
