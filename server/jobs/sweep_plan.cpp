// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/sweep_plan.hpp"

#include <algorithm>
#include <utility>

#include "contact/sweep_columns.hpp"
#include "contact/traces.hpp"
#include "errors/errors.hpp"
#include "operators/mesh_operator.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;
using records::SweepSpec;

constexpr std::size_t most_combinations = 256;
constexpr std::size_t fewest_combinations = 16;
/// Contacts of all rows of a chunk; a row costs more than in proportion to its contacts.
constexpr std::size_t contacts_a_chunk = std::size_t{1} << 15U;
/// A chunk of many rows may be so many times as large, but there are enough for the threads.
constexpr std::uint64_t most_times = 16, fewest_chunks = 64;
/// Loads are condensed in blocks of 32 columns: more would not make a row cheaper.
constexpr std::size_t most_forces = 32;
constexpr std::size_t force_bytes_a_chunk = std::size_t{64} << 20U;
/// A chunk is one message to a watcher, and the motions are most of it: half a megabyte.
constexpr std::size_t motions_a_chunk = std::size_t{1} << 16U;

/// A sweep of fewer load cases is over before another server has factorised its mesh.
constexpr std::uint64_t fewest_spread_cases = 128;
constexpr std::size_t most_portions = 1024;
constexpr std::uint64_t most_portion_bytes = std::uint64_t{64} << 20U;

/// How many numbers are the motions of a row: A of each inclusion and, if any tilts, Bx, By.
std::size_t motions(const mesh::Mesh& mesh) {
  return mesh.inclusions.size() * (contact::tilts(mesh) ? 3 : 1);
}

/// The bytes of the arrays of sweep_result.hpp.
std::uint64_t result_bytes(const operators::MeshOperator& mesh_operator, std::uint64_t rows,
                           std::uint64_t traces, bool bounds, std::uint64_t tips) {
  constexpr std::uint64_t a_row = 2 * sizeof(std::int32_t) + 3 * sizeof(double);
  constexpr std::uint64_t a_node = 3 * sizeof(double) + sizeof(std::int32_t);
  constexpr std::uint64_t a_trace_node = 4 * sizeof(double) + sizeof(std::int32_t);
  constexpr std::uint64_t alignment = 8;
  const std::uint64_t contacts = mesh_operator.contact_nodes().size();
  const std::uint64_t interfaces = mesh_operator.trace_geometry().size();
  const std::uint64_t bounded =
      bounds ? 3 * sizeof(double) * (1 + mesh_operator.mesh().inclusions.size()) : 0;
  std::uint64_t nodes = 0;
  for (const contact::TraceGeometry& interface : mesh_operator.trace_geometry())
    nodes += interface.s.size();
  return rows * (a_row + sizeof(double) * motions(mesh_operator.mesh()) + bounded + contacts +
                 3 * sizeof(double) * tips) +
         contacts * 2 * sizeof(std::int32_t) + nodes * (a_node + traces * a_trace_node) +
         alignment * (bounds ? 18 : 12) + alignment * (interfaces * (4 + 5 * traces));
}

}  // namespace

std::size_t chunk_rows(SweepSpec::Cases cases, std::uint64_t rows, std::size_t nodes,
                       std::size_t contacts, std::size_t motions) {
  constexpr std::size_t one = 1;
  std::size_t result = 0;
  if (cases == SweepSpec::Cases::combinations) {
    result = std::clamp(contacts_a_chunk / std::max(one, contacts), fewest_combinations,
                        most_combinations);
    result *= std::clamp<std::uint64_t>(rows / (fewest_chunks * result), 1, most_times);
  } else {
    result = std::clamp(force_bytes_a_chunk / (sizeof(double) * nodes), one, most_forces);
  }
  return std::min(result, std::max(one, motions_a_chunk / std::max(one, motions)));
}

std::size_t portion_chunks(std::uint64_t cases, std::size_t chunks, std::uint64_t chunk_bytes) {
  const std::size_t together = (chunks + most_portions - 1) / most_portions;
  if (cases < fewest_spread_cases || chunks < 2 || chunk_bytes > most_portion_bytes / together)
    return 0;
  return together;
}

SweepPlan plan_sweep(const records::JobSpec& spec, MatrixFile matrix,
                     const operators::MeshOperator& mesh_operator, const EngineOptions& options) {
  const SweepSpec& sweep = *spec.sweep;
  const std::size_t nodes = mesh_operator.mesh().xy.size() / 2;
  SweepPlan plan;
  plan.columns = sweep.cases == SweepSpec::Cases::combinations ? spec.loads.size() : nodes;
  plan.rows = rows_of(sweep, matrix.values, plan.columns, options.max_sweep_rows);
  plan.matrix = std::move(matrix.path);
  plan.chunk_rows = chunk_rows(sweep.cases, plan.rows, nodes, mesh_operator.contact_nodes().size(),
                               motions(mesh_operator.mesh()));
  const bool shared = sweep.cases == SweepSpec::Cases::combinations &&
                      mesh_operator.shares_bounds(plan.columns, plan.rows);
  if (sweep.bounds && !shared)
    plan.chunk_rows = std::min(plan.chunk_rows, mesh_operator.estimated_together());
  const std::size_t tips = sweep.tips ? mesh_operator.tip_count() : 0;
  plan.result_bytes =
      result_bytes(mesh_operator, plan.rows, sweep.traces.size(), sweep.bounds, tips);
  if (plan.result_bytes > options.max_result_bytes) {
    throw Error(Reason::limit_exceeded,
                "the answers to {} rows take {} bytes on this mesh and a job's result may have {}: "
                "split the matrix, or keep fewer traces",
                plan.rows, plan.result_bytes, options.max_result_bytes)
        .at(matrix_field(sweep));
  }
  plan.portion_chunks = portion_chunks(
      queued_cases(spec, matrix.values), plan.chunks(),
      result_bytes(mesh_operator, plan.chunk_rows, std::min(plan.chunk_rows, sweep.traces.size()),
                   sweep.bounds, tips));
  return plan;
}

}  // namespace anticrack::jobs
