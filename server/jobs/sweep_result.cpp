// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/sweep_result.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "jobs/trace_arrays.hpp"

namespace anticrack::jobs {

namespace {

using contact::Status;
using contact::SweepColumns;
using store::ArrayType;
using store::BlockBuilder;

/// Puts the columns that `get` takes out of each chunk one after the other.
template <class Get>
void add_column(BlockBuilder& builder, const std::string& name, ArrayType type,
                std::vector<std::uint64_t> shape, const LiveSweep& sweep, const Get& get) {
  const std::span<std::byte> bytes = builder.add_zeros("sweep/" + name, type, std::move(shape));
  const std::size_t a_row = bytes.size() / sweep.plan.rows;
  for (std::size_t i = 0; i < sweep.chunks.size(); ++i) {
    if (const SweepColumns* columns = sweep.chunks[i].columns.get()) {
      const auto& values = get(*columns);
      const auto place = bytes.subspan(sweep.plan.first_row(i) * a_row);
      std::ranges::copy(std::as_bytes(std::span(values)), place.begin());
    }
  }
}

void add_status(BlockBuilder& builder, const LiveSweep& sweep, Status unsolved) {
  const auto number_of = [](Status status) { return static_cast<std::int32_t>(status); };
  std::vector<std::int32_t> numbers(sweep.plan.rows, number_of(unsolved));
  for (std::size_t i = 0; i < sweep.chunks.size(); ++i) {
    if (const SweepColumns* columns = sweep.chunks[i].columns.get()) {
      std::transform(columns->status.begin(), columns->status.end(),
                     numbers.begin() + static_cast<std::ptrdiff_t>(sweep.plan.first_row(i)),
                     number_of);
    }
  }
  builder.add("sweep/status", numbers);
}

void add_columns(BlockBuilder& builder, const LiveSweep& sweep, std::uint64_t inclusions,
                 std::uint64_t contacts) {
  const std::uint64_t rows = sweep.plan.rows;
  const auto add = [&](const char* name, ArrayType type, std::vector<std::uint64_t> shape,
                       auto SweepColumns::*member) {
    add_column(
        builder, name, type, std::move(shape),
        sweep, [member](const SweepColumns& columns) -> const auto& { return columns.*member; });
  };
  add("steps", ArrayType::int32, {rows}, &SweepColumns::steps);
  add("energy", ArrayType::float64, {rows}, &SweepColumns::energy);
  add("contact_length", ArrayType::float64, {rows}, &SweepColumns::contact_length);
  add("kkt", ArrayType::float64, {rows}, &SweepColumns::kkt);
  add("displacement", ArrayType::float64, {rows, inclusions}, &SweepColumns::displacement);
  add("contact", ArrayType::uint8, {rows, contacts}, &SweepColumns::contact);
}

void add_contact_nodes(BlockBuilder& builder,
                       const std::vector<std::array<std::int32_t, 2>>& nodes) {
  std::vector<std::int32_t> pairs;
  pairs.reserve(2 * nodes.size());
  for (const auto& node : nodes) {
    pairs.insert(pairs.end(), node.begin(), node.end());
  }
  builder.add("sweep/contact_nodes", pairs, {nodes.size(), 2});
}

}  // namespace

std::shared_ptr<const store::Block> sweep_result(const operators::MeshOperator& mesh_operator,
                                                 LiveSweep& sweep, Status unsolved) {
  if (std::none_of(sweep.chunks.begin(), sweep.chunks.end(),
                   [](const SweepChunk& chunk) { return chunk.columns != nullptr; })) {
    return nullptr;
  }
  BlockBuilder builder;
  builder.reserve(sweep.plan.result_bytes);
  add_geometry(builder, mesh_operator.trace_geometry());
  add_status(builder, sweep, unsolved);
  const auto& contact_nodes = mesh_operator.contact_nodes();
  add_columns(builder, sweep, mesh_operator.mesh().inclusions.size(), contact_nodes.size());
  add_contact_nodes(builder, contact_nodes);
  for (SweepChunk& chunk : sweep.chunks) {
    for (const RowTraces& traces : chunk.traces) {
      add_traces(builder, "traces/" + std::to_string(traces.row) + "/", traces.traces);
    }
    chunk = {};
  }
  return std::make_shared<const store::Block>(builder.finish());
}

}  // namespace anticrack::jobs
