// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/sweep_result.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
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

/// Puts the chunks' columns of a row of the table one after the other.
template <class Row>
void add_column(BlockBuilder& builder, const Row& row, std::vector<std::uint64_t> shape,
                const LiveSweep& sweep) {
  using Column = arrays::MemberOf<const SweepColumns, decltype(row.member)>;
  constexpr ArrayType type = store::array_type<typename Column::value_type>;
  const std::span<std::byte> bytes =
      builder.add_zeros(arrays::sweep_folder() + std::string(row.name), type, std::move(shape));
  const std::size_t a_row = bytes.size() / sweep.plan.rows;
  for (std::size_t i = 0; i < sweep.chunks.size(); ++i) {
    if (const SweepColumns* columns = sweep.chunks[i].columns.get()) {
      const auto place = bytes.subspan(sweep.plan.first_row(i) * a_row);
      std::ranges::copy(std::as_bytes(std::span(std::invoke(row.member, *columns))), place.begin());
    }
  }
}

void add_status(BlockBuilder& builder, const LiveSweep& sweep, Status unsolved) {
  std::vector<Status> all(sweep.plan.rows, unsolved);
  for (std::size_t i = 0; i < sweep.chunks.size(); ++i) {
    if (const SweepColumns* columns = sweep.chunks[i].columns.get()) {
      std::ranges::copy(columns->status,
                        all.begin() + static_cast<std::ptrdiff_t>(sweep.plan.first_row(i)));
    }
  }
  builder.add(arrays::sweep_folder() + "status", all);
}

void add_columns(BlockBuilder& builder, const LiveSweep& sweep, std::uint64_t inclusions,
                 std::uint64_t contacts) {
  const std::uint64_t rows = sweep.plan.rows;
  arrays::for_each(
      [&](const auto& row) {
        if (row.name == "status") return;  // also of rows that no chunk has
        add_column(builder, row, {rows}, sweep);
      },
      arrays::sweep_rows<SweepColumns>);
  arrays::for_each(
      [&](const auto& row) {
        const std::uint64_t columns = row.shape.ends_with(",inclusions") ? inclusions : contacts;
        add_column(builder, row, {rows, columns}, sweep);
      },
      arrays::sweep_matrices<SweepColumns>);
}

struct Contacts {
  std::vector<std::int32_t> contact_nodes;
};

Contacts contacts_of(const std::vector<std::array<std::int32_t, 2>>& nodes) {
  Contacts contacts;
  contacts.contact_nodes.reserve(2 * nodes.size());
  for (const auto& node : nodes)
    contacts.contact_nodes.insert(contacts.contact_nodes.end(), node.begin(), node.end());
  return contacts;
}

}  // namespace

std::shared_ptr<const store::Block> sweep_result(const operators::MeshOperator& mesh_operator,
                                                 LiveSweep& sweep, Status unsolved) {
  if (std::none_of(sweep.chunks.begin(), sweep.chunks.end(),
                   [](const SweepChunk& chunk) { return chunk.columns != nullptr; }))
    return nullptr;
  BlockBuilder builder;
  builder.reserve(sweep.plan.result_bytes);
  add_geometry(builder, mesh_operator.trace_geometry());
  add_status(builder, sweep, unsolved);
  const auto& contact_nodes = mesh_operator.contact_nodes();
  add_columns(builder, sweep, mesh_operator.mesh().inclusions.size(), contact_nodes.size());
  add_arrays(builder, arrays::sweep_folder(), arrays::sweep_contacts<Contacts>,
             contacts_of(contact_nodes));
  for (SweepChunk& chunk : sweep.chunks) {
    for (const RowTraces& traces : chunk.traces)
      add_traces(builder, arrays::row_traces(traces.row), traces.traces);
    chunk = {};
  }
  return std::make_shared<const store::Block>(builder.finish());
}

}  // namespace anticrack::jobs
