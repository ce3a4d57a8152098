// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/edge_ends.hpp"

#include <algorithm>
#include <tuple>

#include "base/at.hpp"

namespace anticrack::mesh {
namespace {

/// Whether an edge is glue between subdomains of the same tension, across which nothing changes.
bool is_seam(const Mesh& mesh, const EdgeTable& edges, const EdgeEnd& end) {
  if (end.kind != Kind::glue) return false;
  const auto uses = edges.find(end.node, end.other);
  if (uses.size() != 2) return false;
  const std::size_t one = at(mesh.subdomain[at(uses[0].triangle)]),
                    other = at(mesh.subdomain[at(uses[1].triangle)]);
  return (mesh.tension.empty() || mesh.tension[one] == mesh.tension[other]) &&
         (mesh.tension_laws.empty() || mesh.tension_laws[one] == mesh.tension_laws[other]);
}

}  // namespace

std::vector<EdgeEnd> edge_ends(const Mesh& mesh, const EdgeTable& edges) {
  std::vector<EdgeEnd> ends;
  for (std::size_t c = 0; c < mesh.interfaces.size(); ++c) {
    const Interface& line = mesh.interfaces[c];
    for (std::size_t i = 0; i + 1 < line.nodes.size(); ++i) {
      const std::int32_t a = line.nodes[i], b = line.nodes[i + 1],
                         interface = static_cast<std::int32_t>(c);
      const EdgeEnd end{a, b, line.kind[i], line.inclusion[i], interface, true};
      if (is_seam(mesh, edges, end)) continue;
      ends.push_back(end);
      ends.push_back({b, a, end.kind, end.inclusion, interface, false});
    }
  }
  std::sort(ends.begin(), ends.end(), [](const EdgeEnd& p, const EdgeEnd& q) {
    return std::tuple(p.node, p.other) < std::tuple(q.node, q.other);
  });
  return ends;
}

std::span<const EdgeEnd> ends_at(std::span<const EdgeEnd> ends, std::int32_t node) noexcept {
  const auto first =
      std::lower_bound(ends.begin(), ends.end(), node,
                       [](const EdgeEnd& end, std::int32_t sought) { return end.node < sought; });
  return {first,
          std::find_if(first, ends.end(), [node](const EdgeEnd& end) { return end.node != node; })};
}

}  // namespace anticrack::mesh
