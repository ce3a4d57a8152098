// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <tuple>

#include "mesh/at.hpp"
#include "mesh/edges.hpp"
#include "mesh/refine.hpp"

namespace anticrack::mesh {
namespace {

/// An interface edge as one of its ends sees it.
struct EdgeEnd {
  std::int32_t node = 0;
  std::int32_t other = 0;
  Kind kind = Kind::glue;
  std::int32_t inclusion = -1;
};

std::vector<EdgeEnd> interface_edge_ends(const Mesh& mesh) {
  std::vector<EdgeEnd> ends;
  for (const Interface& line : mesh.interfaces) {
    for (std::size_t i = 0; i + 1 < line.nodes.size(); ++i) {
      const std::int32_t a = line.nodes[i];
      const std::int32_t b = line.nodes[i + 1];
      ends.push_back({a, b, line.kind[i], line.inclusion[i]});
      ends.push_back({b, a, line.kind[i], line.inclusion[i]});
    }
  }
  std::sort(ends.begin(), ends.end(), [](const EdgeEnd& p, const EdgeEnd& q) {
    return std::tuple(p.node, p.other) < std::tuple(q.node, q.other);
  });
  return ends;
}

}  // namespace

std::vector<std::int32_t> tips(const Mesh& mesh) {
  const std::vector<EdgeEnd> ends = interface_edge_ends(mesh);
  const EdgeTable edges(mesh.triangles);
  const std::vector<bool> on_boundary = edges.boundary_nodes(mesh.node_count());
  const auto free_end = [&](const EdgeEnd& end) {
    if (end.kind == Kind::glue) return false;
    return !on_boundary[at(end.node)] || edges.find(end.node, end.other).size() == 1;
  };

  std::vector<std::int32_t> found;
  for (auto first = ends.begin(); first != ends.end();) {
    const auto last = std::find_if(
        first, ends.end(), [node = first->node](const EdgeEnd& end) { return end.node != node; });
    const bool differ = std::any_of(first, last, [&](const EdgeEnd& end) {
      return end.kind != first->kind || end.inclusion != first->inclusion;
    });
    if (differ || (last - first == 1 && free_end(*first))) found.push_back(first->node);
    first = last;
  }
  return found;
}

}  // namespace anticrack::mesh
