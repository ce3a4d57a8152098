// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/sweep_chunk.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

#include "jobs/portion_codec.hpp"
#include "jobs/sweep_result.hpp"
#include "jobs/sweep_support.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::Backend;
using errors::Reason;

/// A job of 300 rows in two chunks, as it is when a thread takes the first.
class ChunkTest : public ::testing::Test {
 protected:
  explicit ChunkTest(bool tilt = false, bool bounds = false) {
    records::JobRecord record;
    record.spec = combinations("mesh", upload(backend, eighths(300 * std::size_t{3})));
    record.spec.sweep->bounds = bounds;
    job = std::make_shared<LiveJob>(1, record, 1, 1U << 20U, nullptr);
    const std::string mesh = ready_mesh(backend, 0.25);
    job->mesh_operator = backend.prepare(mesh);
    if (tilt) {
      auto tilting = std::make_shared<mesh::Mesh>(job->mesh_operator->mesh());
      tilting->motions.assign(tilting->inclusions.size(), {true, {}});
      job->mesh_operator = operators::MeshOperator::factorise(tilting, 1, {});
    }
    job->spool = backend.store->new_spool();
    job->sweep = std::make_unique<LiveSweep>(
        plan_sweep(*job->spec, find_matrix(*job->spec->sweep, *backend.store, ""),
                   *job->mesh_operator, EngineOptions{}));
    job->sweep->basis = condense_basis(*job, *job->mesh_operator, *backend.store);
  }
  EndedChunk solve(std::size_t index) {
    return solve_chunk({job, index, std::chrono::steady_clock::now()}, iterations);
  }

  Backend backend;
  JobPtr job;
  std::atomic<std::uint64_t> iterations{0};
};

TEST_F(ChunkTest, HasItsRows) {
  const EndedChunk first = solve(0), last = solve(1);
  ASSERT_TRUE(first.solved.columns && last.solved.columns);
  EXPECT_EQ(first.columns->rows(), 256U);
  EXPECT_EQ(last.columns->rows(), 44U);
  EXPECT_EQ(last.record.converged, 44U);
  EXPECT_GT(iterations, 300U);
  records::SweepRecord sum;
  add(sum, first.record);
  add(sum, last.record);
  EXPECT_EQ(sum.converged, 300U);
  EXPECT_EQ(sum.worst_kkt, std::max(first.record.worst_kkt, last.record.worst_kkt));
}

class TiltingChunkTest : public ChunkTest {
 protected:
  TiltingChunkTest() : ChunkTest(true) {}
};

TEST_F(ChunkTest, HasNoSlopesWhereNothingTilts) {
  job->sweep->chunks[0] = solve(0).solved;
  const auto block = sweep_result(*job, contact::Status::cancelled);
  EXPECT_EQ(layout(*block, "sweep/slope"), nullptr);
}

TEST_F(TiltingChunkTest, HasSlopesOfEveryRowAndTheBytesThatWerePlanned) {
  job->sweep->chunks[1] = solve(1).solved;
  const auto block = sweep_result(*job, contact::Status::cancelled);
  const records::ArrayLayout* slope = layout(*block, "sweep/slope");
  ASSERT_TRUE(slope);
  const std::uint64_t inclusions = job->mesh_operator->mesh().inclusions.size();
  EXPECT_EQ(slope->shape, (std::vector<std::uint64_t>{300, inclusions, 2}));
  EXPECT_EQ(array<std::int32_t>(*block, "sweep/status")->back(), converged);
  EXPECT_EQ(array<double>(*block, "sweep/slope")->front(), 0) << "of a row without an answer";
  EXPECT_LE(block->size(), job->sweep->plan.result_bytes);
  EXPECT_GT(block->size() + 1000, job->sweep->plan.result_bytes);
}

TEST_F(TiltingChunkTest, ComesBackFromThePortionsOfTheStoreAsItWas) {
  SweepPlan plan = job->sweep->plan;
  plan.portion_chunks = 2;
  const auto basis = job->sweep->basis;
  job->sweep = std::make_unique<LiveSweep>(plan);
  job->sweep->basis = basis;
  const EndedChunk first = solve(0);
  EndedChunk last = solve(1);
  records::BlockBuilder builder;
  builder.add("traces", std::vector<double>{1, 2, 3});
  last.solved.traces = spooled(*job->spool, builder.take());
  last.record.warnings = {"rows without bounds"};
  const store::SolvedPortion portion{
      0, pack({{first.solved, first.record}, {last.solved, last.record}}, *job->spool)};
  const std::vector<EndedChunk> chunks = unpack(portion, job);
  ASSERT_EQ(chunks.size(), 2U);
  for (const EndedChunk* sent : std::initializer_list<const EndedChunk*>{&first, &last}) {
    const EndedChunk& got = chunks[sent->task.index];
    EXPECT_EQ(got.task.index, sent->task.index);
    EXPECT_EQ(chunk_arrays(*got.columns).bytes, chunk_arrays(*sent->columns).bytes);
    EXPECT_EQ(got.record.converged, sent->record.converged);
    EXPECT_EQ(got.record.worst_kkt, sent->record.worst_kkt);
    EXPECT_EQ(got.record.solve_time, sent->record.solve_time);
    std::vector<std::byte> bytes(got.solved.columns->bytes);
    job->spool->read(got.solved.columns->place, bytes);
    EXPECT_EQ(bytes, chunk_arrays(*sent->columns).bytes);
  }
  EXPECT_EQ(chunks[1].record.warnings, last.record.warnings);
  ASSERT_TRUE(chunks[1].solved.traces);
  EXPECT_EQ(chunks[1].solved.traces->arrays.at(0).name, "traces");
  EXPECT_EQ(chunks[1].solved.traces->run.bytes, 3 * sizeof(double));

  const auto refused = [&](std::uint64_t number, const std::string& body) {
    return anticrack::testing::throws([&] { unpack({number, body}, job); }, Reason::storage);
  };
  EXPECT_TRUE(refused(1, portion.body)) << "there is no such portion";
  EXPECT_TRUE(refused(0, portion.body + "x"));
  EXPECT_TRUE(refused(0, pack({{first.solved, first.record}}, *job->spool)));
  EXPECT_TRUE(
      refused(0, pack({{last.solved, last.record}, {first.solved, first.record}}, *job->spool)))
      << "other rows";
}

TEST(PortionCodec, KeepsEachBitOfAPositionAndRefusesADamagedOne) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const PositionRequest request{
      {{3, 0}, {growth::Fate::not_followed, growth::Fate::grows}}, 1, {0.1, 1. / 3}, 0, 7};
  const PositionRequest asked = unpack_request(pack(request));
  EXPECT_EQ(asked.state.at, request.state.at);
  EXPECT_EQ(asked.state.fate, request.state.fate);
  EXPECT_EQ(asked.loads, request.loads);
  EXPECT_EQ(pack(asked), pack(request));
  EXPECT_TRUE(
      anticrack::testing::throws([&] { unpack_request(pack(request) + "x"); }, Reason::storage));

  const SolvedPosition solved{std::nullopt, "closed", "why", {{-1. / 3, 0}, {-infinite, infinite}}};
  const std::string body = pack(solved);
  const SolvedPosition found = unpack_position(body, 2);
  EXPECT_FALSE(found.release);
  EXPECT_EQ(found.reason, "why");
  EXPECT_EQ(found.energy.at(0).lower, -1. / 3);
  EXPECT_EQ(found.energy.at(1).upper, infinite);
  EXPECT_EQ(pack(found), body);
  for (std::size_t bytes = 0; bytes < body.size(); ++bytes)
    EXPECT_TRUE(anticrack::testing::throws([&] { unpack_position(body.substr(0, bytes), 2); },
                                           Reason::storage))
        << bytes;
}

class BoundedChunkTest : public ChunkTest {
 protected:
  BoundedChunkTest() : ChunkTest(false, true) {}
};

TEST_F(BoundedChunkTest, HasTheBytesThatWerePlanned) {
  ASSERT_TRUE(job->mesh_operator->shares_bounds(3, 300));
  job->sweep->chunks[1] = solve(1).solved;
  const auto block = sweep_result(*job, contact::Status::cancelled);
  EXPECT_LE(block->size(), job->sweep->plan.result_bytes);
  EXPECT_GT(block->size() + 1000, job->sweep->plan.result_bytes);
  const auto lower = *array<double>(*block, "sweep/energy_lower");
  const auto energy = *array<double>(*block, "sweep/energy");
  const auto upper = *array<double>(*block, "sweep/energy_upper");
  ASSERT_EQ(lower.size(), 300U);
  EXPECT_TRUE(std::isnan(lower[0])) << "of a row without an answer";
  for (std::size_t row = job->sweep->plan.first_row(1); row < 300; ++row) {
    EXPECT_LE(lower[row], energy[row]);
    EXPECT_LE(energy[row], upper[row]);
  }
}

/// Rows that are bounded one by one end soon after they are stopped.
TEST_F(BoundedChunkTest, IsSmallWhereRowsDoNotShareTheirBounds) {
  EXPECT_EQ(job->sweep->plan.chunk_rows, 256U);
  records::JobSpec spec = *job->spec;
  spec.sweep->upload = upload(backend, eighths(3));
  ASSERT_FALSE(job->mesh_operator->shares_bounds(3, 1));
  const SweepPlan plan = plan_sweep(spec, find_matrix(*spec.sweep, *backend.store, ""),
                                    *job->mesh_operator, EngineOptions{});
  EXPECT_EQ(plan.chunk_rows, job->mesh_operator->estimated_together());
}

TEST_F(BoundedChunkTest, IsLeftWhereItsJobStops) {
  job->stop.request_stop();
  EXPECT_FALSE(solve(0).solved.columns);
}

TEST_F(ChunkTest, IsLeftWhereItsJobStops) {
  job->stop.request_stop();
  const EndedChunk chunk = solve(0);
  EXPECT_FALSE(chunk.solved.columns);
  EXPECT_FALSE(chunk.failure);
  EXPECT_EQ(chunk.record.converged + chunk.record.not_converged, 0U);
}

TEST_F(ChunkTest, FailsWhereTheMatrixCannotBeRead) {
  std::filesystem::resize_file(job->sweep->plan.matrix, 299 * 3 * sizeof(double));
  EXPECT_FALSE(solve(0).failure);
  const EndedChunk chunk = solve(1);
  EXPECT_FALSE(chunk.solved.columns);
  ASSERT_TRUE(chunk.failure);
  EXPECT_EQ(chunk.failure->reason(), Reason::storage);
}

TEST_F(ChunkTest, ResultTakesTheBytesThatWerePlanned) {
  EXPECT_EQ(sweep_result(*job, contact::Status::cancelled), nullptr);
  job->sweep->chunks[1] = solve(1).solved;
  const auto block = sweep_result(*job, contact::Status::cancelled);
  ASSERT_TRUE(block);
  EXPECT_LE(block->size(), job->sweep->plan.result_bytes);
  EXPECT_GT(block->size() + 1000, job->sweep->plan.result_bytes);
  const auto status = *array<std::int32_t>(*block, "sweep/status");
  EXPECT_EQ(status.front(), 6);  // LoadCaseAnswer.Status: cancelled
  EXPECT_EQ(status.back(), 3);   // converged
}

}  // namespace
}  // namespace anticrack::jobs
