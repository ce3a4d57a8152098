// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a server would send of a result.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "results/tables.hpp"

namespace anticrack::testing {

/// A block, array by array, as the server lays it out.
struct BlockMaker {
  v1::BlockLayout layout;
  std::vector<std::byte> bytes;

  template <class T>
  BlockMaker& add(const std::string& name, const std::vector<T>& values, std::size_t columns = 0) {
    v1::ArrayLayout& array = *layout.add_arrays();
    array.set_name(name);
    array.set_type(sizeof(T) == 8   ? v1::ArrayLayout::TYPE_FLOAT64
                   : sizeof(T) == 4 ? v1::ArrayLayout::TYPE_INT32
                                    : v1::ArrayLayout::TYPE_UINT8);
    array.add_shape(columns == 0 ? values.size() : values.size() / columns);
    if (columns != 0) array.add_shape(columns);
    array.set_offset(bytes.size());
    const auto added = std::as_bytes(std::span(values));
    bytes.insert(bytes.end(), added.begin(), added.end());
    bytes.resize((bytes.size() + 7) / 8 * 8);
    return *this;
  }

  /// The arrays of a table.
  template <class Record, class Table>
  void add_all(const std::string& folder, const Record& record, const Table& table) {
    arrays::for_each(
        [&](const auto& row) {
          const auto& values = std::invoke(row.member, record);
          if (!values.empty() || !row.optional)
            add(folder + std::string(row.name), values, arrays::columns_of(row.shape));
        },
        table);
  }
};

/// The two blocks of load cases.
struct ResultBlocks {
  explicit ResultBlocks(const results::Result& result) {
    mesh.add_all("", result.mesh, results::tables::mesh);
    for (std::size_t i = 0; i < result.interfaces.size(); ++i) {
      const std::string at = arrays::interface_folder(i);
      answer.add_all(at, result.interfaces[i], arrays::interface_nodes<results::Interface>);
      mesh.add_all(at, result.interfaces[i], results::tables::edges);
    }
    for (std::size_t i = 0; i < result.loads.size(); ++i) add_load(i, result.loads[i]);
    for (std::size_t i = 0; i < result.loads[0].fields.size(); ++i)
      answer.add_all(arrays::field_folder(i), result.loads[0].fields[i],
                     arrays::subdomain<results::Field>);
  }

  BlockMaker mesh, answer;

 private:
  void add_load(std::size_t index, const results::Load& load) {
    for (std::size_t i = 0; i < load.traces.size(); ++i)
      answer.add_all(arrays::load_traces(index) + std::to_string(i) + "/", load.traces[i],
                     arrays::trace<results::Trace>);
    answer.add_all(arrays::load_folder(index), load, results::tables::of_load);
    answer.add_all(arrays::load_history(index), load.history, arrays::history<results::History>);
    for (std::size_t i = 0; i < load.fields.size(); ++i)
      answer.add(arrays::load_fields(index) + std::to_string(i), load.fields[i].u);
  }
};

}  // namespace anticrack::testing
