// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/trace_arrays.hpp"

#include <cstdint>

namespace anticrack::jobs {

using store::BlockBuilder;

void add_geometry(BlockBuilder& builder, const std::vector<contact::TraceGeometry>& interfaces) {
  for (std::size_t i = 0; i < interfaces.size(); ++i) {
    const std::string path = "interfaces/" + std::to_string(i) + "/";
    std::vector<std::int32_t> kinds;
    kinds.reserve(interfaces[i].kind.size());
    for (const mesh::Kind kind : interfaces[i].kind) {
      kinds.push_back(static_cast<std::int32_t>(kind));
    }
    builder.add(path + "s", interfaces[i].s);
    builder.add(path + "x", interfaces[i].x);
    builder.add(path + "y", interfaces[i].y);
    builder.add(path + "kind", kinds);
  }
}

void add_traces(BlockBuilder& builder, const std::string& folder,
                const std::vector<contact::Trace>& traces) {
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const std::string path = folder + std::to_string(i) + "/";
    builder.add(path + "u_minus", traces[i].u_minus);
    builder.add(path + "u_plus", traces[i].u_plus);
    builder.add(path + "jump", traces[i].jump);
    builder.add(path + "pressure", traces[i].pressure);
    builder.add(path + "contact", traces[i].contact);
  }
}

}  // namespace anticrack::jobs
