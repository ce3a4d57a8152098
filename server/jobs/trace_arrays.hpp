// SPDX-License-Identifier: GPL-3.0-or-later
//
// The arrays that the results of load cases and of sweeps have in common.
#pragma once

#include <fmt/core.h>

#include <functional>
#include <string>
#include <vector>

#include "arrays/result_arrays.hpp"
#include "contact/traces.hpp"
#include "records/block.hpp"

namespace anticrack::jobs {

/// Adds the arrays of a table, from one record; `folder` ends with a slash.
template <class Table, class Record>
void add_arrays(records::BlockBuilder& builder, const std::string& folder, const Table& table,
                const Record& record) {
  arrays::for_each(
      [&](const auto& row) {
        const auto& values = std::invoke(row.member, record);
        std::vector<std::uint64_t> shape{values.size()};
        if (const std::size_t columns = arrays::columns_of(row.shape); columns != 0)
          shape = {values.size() / columns, columns};
        builder.add(folder + std::string(row.name), values, std::move(shape));
      },
      table);
}

/// Adds the positions of the nodes of all interfaces.
inline void add_geometry(records::BlockBuilder& builder,
                         const std::vector<contact::TraceGeometry>& interfaces) {
  for (std::size_t i = 0; i < interfaces.size(); ++i) {
    add_arrays(builder, arrays::interface_folder(i),
               arrays::interface_nodes<contact::TraceGeometry>, interfaces[i]);
  }
}

/// Adds the traces along all interfaces; `folder` ends with a slash.
inline void add_traces(records::BlockBuilder& builder, const std::string& folder,
                       const std::vector<contact::Trace>& traces) {
  for (std::size_t i = 0; i < traces.size(); ++i)
    add_arrays(builder, fmt::format("{}{}/", folder, i), arrays::trace<contact::Trace>, traces[i]);
}

}  // namespace anticrack::jobs
