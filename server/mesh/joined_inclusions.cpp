// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/joined_inclusions.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

#include "base/at.hpp"

namespace anticrack::mesh {

base::UnionFind join_inclusions(const Mesh& mesh) {
  base::UnionFind joined(mesh.inclusions.size());
  std::vector<std::int32_t> first(mesh.node_count(), -1);
  for (const Interface& interface : mesh.interfaces) {
    for (std::size_t e = 0; e < interface.inclusion.size(); ++e) {
      if (interface.inclusion[e] < 0) continue;
      for (const std::size_t i : {e, e + 1}) {
        std::int32_t& one = first[at(interface.nodes[i])];
        if (one < 0) one = interface.inclusion[e];
        joined.unite(one, interface.inclusion[e]);
      }
    }
  }
  return joined;
}

std::vector<std::string> why_none_tilts(const Mesh& mesh) {
  std::vector<std::string> why(mesh.inclusions.size());
  if (mesh.motions.empty()) return why;
  base::UnionFind joined = join_inclusions(mesh);
  std::vector<std::int32_t> straight_one(why.size(), -1);  // of the body, by its root
  for (std::int32_t j = 0; j < static_cast<std::int32_t>(why.size()); ++j) {
    std::int32_t& one = straight_one[at(joined.find(j))];
    if (one < 0 && !mesh.motions[at(j)].tilt) one = j;
  }
  for (std::int32_t j = 0; j < static_cast<std::int32_t>(why.size()); ++j) {
    const std::int32_t one = straight_one[at(joined.find(j))];
    if (one < 0 || one == j || !mesh.motions[at(j)].tilt) continue;
    const bool held = mesh.motions[at(one)].fixed.has_value();
    why[at(j)] = fmt::format(
        "the inclusion \"{}\" does not tilt, as inclusions that share nodes are one body, and "
        "\"{}\" "
        "{}: {}, or leave an edge between them",
        mesh.inclusions[at(j)], mesh.inclusions[at(one)], held ? "is held" : "does not tilt",
        held ? "do not hold that one" : "let that one tilt as well");
  }
  return why;
}

}  // namespace anticrack::mesh
