// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/sweep_check.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "fields/walk.hpp"
#include "jobs/check.hpp"
#include "jobs/sweep_plan.hpp"
#include "jobs/sweep_support.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::Backend;
using anticrack::testing::throws;
using errors::Reason;
using records::JobSpec;
using Cases = records::SweepSpec::Cases;

const std::string hash(64, 'a');

class SweepCheck : public ::testing::Test {
 protected:
  ::testing::AssertionResult refuses(const std::function<void(JobSpec&)>& spoil,
                                     const std::string& field,
                                     Reason reason = Reason::invalid_argument) {
    JobSpec spec = combinations("mesh", hash);
    spoil(spec);
    return throws([&] { check(spec, options); }, reason, field);
  }
  EngineOptions options;
};

TEST_F(SweepCheck, AcceptsBothKinds) {
  JobSpec spec = combinations("mesh", hash);
  spec.sweep->traces = {0, 7, 8, UINT32_MAX};
  EXPECT_NO_THROW(check(spec, options));
  EXPECT_NO_THROW(check(nodal_forces("mesh", hash), options));
}

TEST_F(SweepCheck, BoundsTheBasis) {
  EXPECT_TRUE(refuses([](JobSpec& bad) { bad.loads.clear(); }, "load_cases"));
  options.max_sweep_basis = 2;
  EXPECT_TRUE(refuses([](JobSpec&) {}, "load_cases", Reason::limit_exceeded));
  EXPECT_TRUE(refuses([](JobSpec& bad) { bad.sweep->cases = Cases::nodal_forces; }, "load_cases"));
  options.max_sweep_basis = 3;
  EXPECT_TRUE(refuses([](JobSpec& bad) { bad.loads[1].name = "one"; }, "load_cases[1].name"));
  EXPECT_TRUE(refuses([](JobSpec& bad) { bad.loads[2].force = fem::Expression{"y +"}; },
                      "load_cases[2].force.expression", Reason::expression_invalid));
}

TEST_F(SweepCheck, IsForTheActiveSetWithoutFields) {
  EXPECT_TRUE(refuses([](JobSpec& bad) { bad.solver = contact::UzawaOptions(); }, "solver.uzawa"));
  EXPECT_TRUE(refuses([](JobSpec& bad) { bad.fields = true; }, "outputs"));
  const auto with_and_without = [](JobSpec& bad) { bad.sweep->bounds = bad.without_bounds = true; };
  EXPECT_TRUE(refuses(with_and_without, "sweep.bounds"));
}

TEST_F(SweepCheck, WantsTracesAscendingAndFew) {
  const auto traces = [](const std::vector<std::uint32_t>& rows) {
    return [rows](JobSpec& bad) { bad.sweep->traces = rows; };
  };
  EXPECT_TRUE(refuses(traces({1, 2, 2}), "sweep.traces[2]"));
  EXPECT_TRUE(refuses(traces({5, 4}), "sweep.traces[1]"));
  options.max_load_cases = 2;
  EXPECT_TRUE(refuses(traces({1, 2, 3}), "sweep.traces", Reason::limit_exceeded));
}

TEST_F(SweepCheck, CountsWholeRows) {
  records::SweepSpec sweep;
  sweep.traces = {0, 3};
  EXPECT_EQ(rows_of(sweep, 12, 3, 4), 4U);
  EXPECT_TRUE(
      throws([&] { rows_of(sweep, 13, 3, 4); }, Reason::invalid_argument, "sweep.coefficients"));
  EXPECT_TRUE(
      throws([&] { rows_of(sweep, 15, 3, 4); }, Reason::limit_exceeded, "sweep.coefficients"));
  EXPECT_TRUE(
      throws([&] { rows_of(sweep, 9, 3, 4); }, Reason::invalid_argument, "sweep.traces[1]"));
  sweep.cases = Cases::nodal_forces;
  EXPECT_TRUE(
      throws([&] { rows_of(sweep, 13, 3, 4); }, Reason::invalid_argument, "sweep.nodal_forces"));
}

TEST_F(SweepCheck, FindsTheMatrixOfItsOwner) {
  Backend backend;
  records::SweepSpec sweep;
  sweep.upload = upload(backend, {1, 2, 3}, "ann");
  EXPECT_EQ(find_matrix(sweep, *backend.store, "ann").values, 3U);
  EXPECT_TRUE(throws([&] { find_matrix(sweep, *backend.store, "bob"); }, Reason::not_found,
                     "sweep.coefficients"));
  sweep.cases = Cases::nodal_forces;
  sweep.upload = backend.upload("odd", "ann").sha256;
  EXPECT_TRUE(throws([&] { find_matrix(sweep, *backend.store, "ann"); }, Reason::invalid_argument,
                     "sweep.nodal_forces"));
}

TEST_F(SweepCheck, CountsInTheQueueByItsMatrix) {
  Backend backend;
  const auto cost = [&](const JobSpec& spec) { return queued_cases(spec, *backend.store, ""); };
  const std::string matrix = upload(backend, std::vector<double>(3 * 257));
  EXPECT_EQ(cost(combinations("mesh", upload(backend, {1, 2, 3}))), 1U);
  EXPECT_EQ(cost(combinations("mesh", matrix)), 2U);
  EXPECT_EQ(cost(nodal_forces("mesh", matrix)), 1U);
  JobSpec bounded = combinations("mesh", matrix);
  bounded.sweep->bounds = true;
  EXPECT_EQ(cost(bounded), 33U);
  EXPECT_EQ(cost(nodal_forces("mesh", upload(backend, std::vector<double>((1U << 17U) + 1)))), 2U);
  EXPECT_EQ(cost(combinations("mesh", hash)), 1U);  // it is not there
  JobSpec plain = combinations("mesh", hash);
  plain.sweep.reset();
  EXPECT_EQ(cost(plain), 3U);
}

TEST(SweepPlan, HasLargeChunksOfCheapRows) {
  EXPECT_EQ(chunk_rows(Cases::combinations, 1000, 4000, 0, 1), 256U);
  EXPECT_EQ(chunk_rows(Cases::combinations, 1000, 4000, 80, 1), 256U);
  EXPECT_EQ(chunk_rows(Cases::combinations, 1000, 4000, 512, 1), 64U);
  EXPECT_EQ(chunk_rows(Cases::combinations, 1000, 4000, 100'000, 1), 16U);
  EXPECT_EQ(chunk_rows(Cases::nodal_forces, 1'000'000, 4000, 80, 1), 32U);
  EXPECT_EQ(chunk_rows(Cases::nodal_forces, 1'000'000, 1'000'000, 80, 1), 8U);
  EXPECT_EQ(chunk_rows(Cases::nodal_forces, 1'000'000, 100'000'000, 80, 1), 1U);
  EXPECT_EQ(chunk_rows(Cases::combinations, 1000, 4000, 80, 4096), 16U);
  EXPECT_EQ(chunk_rows(Cases::nodal_forces, 1'000'000, 4000, 80, 1'000'000), 1U);
  EXPECT_EQ(chunk_rows(Cases::combinations, 64 * 512, 4000, 80, 1), 512U);
  EXPECT_EQ(chunk_rows(Cases::combinations, 64 * 512 - 1, 4000, 80, 1), 256U);
  EXPECT_EQ(chunk_rows(Cases::combinations, 1'000'000'000, 4000, 80, 1), 4096U);
  EXPECT_EQ(chunk_rows(Cases::combinations, 1'000'000'000, 4000, 100'000, 1), 256U);
  EXPECT_EQ(chunk_rows(Cases::combinations, 1'000'000'000, 4000, 80, 4096), 16U);
}

TEST(SweepPlan, IsSpreadWhereItIsLargeInPortionsThatAreSmall) {
  constexpr std::uint64_t chunk = 1U << 20U;
  EXPECT_EQ(portion_chunks(127, 1000, chunk), 0U);
  EXPECT_EQ(portion_chunks(128, 1, chunk), 0U);
  EXPECT_EQ(portion_chunks(128, 2, chunk), 1U);
  EXPECT_EQ(portion_chunks(128, 1024, 64 * chunk), 1U);
  EXPECT_EQ(portion_chunks(128, 1024, 64 * chunk + 1), 0U);
  for (const std::size_t chunks : {1025U, 2048U, 2049U, 1'000'000U}) {
    const std::size_t together = portion_chunks(128, chunks, 1);
    EXPECT_LE(chunks, 1024 * together);
    EXPECT_GT(chunks, 1024 * (together - 1));
    EXPECT_EQ(portion_chunks(128, chunks, 64 * chunk / together + 1), 0U);
  }
}

TEST(SweepPlan, CoversEveryRowOnce) {
  SweepPlan plan;
  plan.rows = 600;
  plan.chunk_rows = 256;
  ASSERT_EQ(plan.chunks(), 3U);
  std::uint64_t row = 0;
  for (std::size_t chunk = 0; chunk < plan.chunks(); ++chunk) {
    EXPECT_EQ(plan.first_row(chunk), row);
    row += plan.rows_in(chunk);
  }
  EXPECT_EQ(row, 600U);
}

}  // namespace
}  // namespace anticrack::jobs
