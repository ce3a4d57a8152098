// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/sweep_result.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "jobs/trace_arrays.hpp"
#include "operators/mesh_operator.hpp"

namespace anticrack::jobs {

namespace {

using contact::SweepColumns;
using records::ArrayLayout;
using records::BlockBuilder;
using store::Spool;

/// A chunk of `rows` rows without answers.
records::Block no_answers(const LiveJob& job, std::size_t rows, contact::Status status) {
  SweepColumns columns = unsolved_rows(job, rows);
  std::ranges::fill(columns.status, status);
  return chunk_arrays(columns);
}

/// Joins the chunks' columns of each array, one after the other.
void add_columns(store::SpooledBlock& result, const LiveJob& job, contact::Status unsolved) {
  const LiveSweep& sweep = *job.sweep;
  const records::Block whole = no_answers(job, sweep.plan.rows_in(0), unsolved);
  const records::Block last =
      no_answers(job, sweep.plan.rows_in(sweep.chunks.size() - 1), unsolved);
  const Spool::Run empty = job.spool->append(whole.bytes);
  std::vector<Spool::Run> runs(sweep.chunks.size());
  for (std::size_t a = 0; a < whole.arrays.size(); ++a) {
    const ArrayLayout& array = whole.arrays[a];
    const std::uint64_t a_row = bytes_of(array) / sweep.plan.rows_in(0);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::optional<Spool::Run>& columns = sweep.chunks[i].columns;
      const bool is_last = i + 1 == runs.size();
      const std::uint64_t place = columns
                                      ? columns->place + (is_last ? last : whole).arrays[a].offset
                                      : empty.place + array.offset;
      runs[i] = {place, sweep.plan.rows_in(i) * a_row};
    }
    std::vector<std::uint64_t> shape = array.shape;
    shape.front() = sweep.plan.rows;
    result.add(array.name, array.type, std::move(shape), runs);
  }
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

SweepColumns unsolved_rows(const LiveJob& job, std::size_t rows) {
  const mesh::Mesh& mesh = job.mesh_operator->mesh();
  return {rows,
          mesh.inclusions.size(),
          job.mesh_operator->contact_nodes().size(),
          contact::tilts(mesh),
          job.spec->sweep->bounds,
          job.spec->sweep->tips ? job.mesh_operator->tip_count() : 0};
}

records::Block chunk_arrays(const SweepColumns& columns) {
  BlockBuilder builder;
  arrays::for_each(
      [&](const auto& row) {
        const auto& values = std::invoke(row.member, columns);
        if (row.optional && values.empty()) return;
        builder.add(arrays::sweep_folder() + std::string(row.name), values);
      },
      arrays::sweep_rows<SweepColumns>);
  arrays::for_each(
      [&](const auto& row) {
        const auto& values = std::invoke(row.member, columns);
        if (row.optional && values.empty()) return;
        const std::string_view second = arrays::second_of(row.shape);
        std::vector<std::uint64_t> shape{columns.rows(), second == "inclusions" ? columns.inclusions
                                                         : second == "tips"     ? columns.tips
                                                                                : columns.contacts};
        if (const std::size_t depth = arrays::depth_of(row.shape); depth > 1)
          shape.push_back(depth);
        builder.add(arrays::sweep_folder() + std::string(row.name), values, std::move(shape));
      },
      arrays::sweep_matrices<SweepColumns>);
  return builder.take();
}

void read_columns(std::span<const std::byte> bytes, SweepColumns& columns) {
  const records::Block block = chunk_arrays(columns);
  if (bytes.size() != block.bytes.size()) {
    throw errors::Error(errors::Reason::storage, "{} bytes of rows in the database, not {}",
                        bytes.size(), block.bytes.size());
  }
  auto array = block.arrays.begin();
  const auto read = [&](const auto& row) {
    auto& values = std::invoke(row.member, columns);
    if (row.optional && values.empty()) return;
    const std::span<std::byte> to = std::as_writable_bytes(std::span(values));
    if (!to.empty()) std::memcpy(to.data(), bytes.data() + array->offset, to.size());
    ++array;
  };
  arrays::for_each(read, arrays::sweep_rows<SweepColumns>);
  arrays::for_each(read, arrays::sweep_matrices<SweepColumns>);
}

std::shared_ptr<const records::BlockSource> sweep_result(const LiveJob& job,
                                                         contact::Status unsolved) {
  const auto solved = [](const SweepChunk& chunk) { return chunk.columns.has_value(); };
  if (std::ranges::none_of(job.sweep->chunks, solved)) return nullptr;
  store::SpooledBlock result(job.spool);
  const auto add = [&](const ResultPart& part) { result.add(part.arrays, part.run); };
  BlockBuilder geometry;
  add_geometry(geometry, job.mesh_operator->trace_geometry());
  add(spooled(*job.spool, geometry.take()));
  add_columns(result, job, unsolved);
  BlockBuilder contacts;
  add_arrays(contacts, arrays::sweep_folder(), arrays::sweep_contacts<Contacts>,
             contacts_of(job.mesh_operator->contact_nodes()));
  add(spooled(*job.spool, contacts.take()));
  for (const SweepChunk& chunk : job.sweep->chunks)
    if (chunk.traces) add(*chunk.traces);
  return result.finish();
}

}  // namespace anticrack::jobs
