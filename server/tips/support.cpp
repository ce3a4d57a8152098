// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/support.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "base/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::tips {
namespace {

constexpr const char* gathering = "gathering triangles about a tip";

double distance_to_edge(const Point& x, const Point& a, const Point& b) {
  const Point along = minus(b, a), from = minus(x, a);
  const double part = std::clamp(dot(from, along) / dot(along, along), 0.0, 1.0);
  const Point off{from[0] - part * along[0], from[1] - part * along[1]};
  return std::sqrt(dot(off, off));
}

}  // namespace

Surroundings::Surroundings(const mesh::Mesh& mesh, const mesh::EdgeTable& edges,
                           const std::vector<mesh::EdgeEnd>& ends)
    : _mesh(mesh),
      _edges(edges),
      _ends(ends),
      _on_interface(mesh.node_count(), 0),
      _across(mesh.triangles.size(), -1) {
  for (const mesh::EdgeEnd& end : ends) _on_interface[at(end.node)] = 1;
  std::size_t turn = 0;
  edges.each([&](std::span<const mesh::EdgeUse> uses) {
    stop::look_at_turn(turn++, gathering);
    for (std::size_t k = 0; uses.size() == 2 && k < 2; ++k) {
      const std::int32_t* const node = &mesh.triangles[3 * at(uses[k].triangle)];
      const auto side = std::find(node, node + 3, uses[k].from) - mesh.triangles.data();
      _across[at(side)] = uses[1 - k].triangle;
    }
  });
}

bool Surroundings::is_obstacle(std::int32_t a, std::int32_t b, const Place& place) const {
  if (_on_interface[at(a)] == 0 || _on_interface[at(b)] == 0) return false;
  const auto ends = mesh::ends_at(_ends, a);
  return std::ranges::find(ends, b, &mesh::EdgeEnd::other) != ends.end() &&
         !std::ranges::binary_search(place.edges, std::array{std::min(a, b), std::max(a, b)});
}

Support Surroundings::of(const Place& place, Marks& seen) const {
  const Point& tip = place.course.tip;
  Support support;
  support.radius = place.reach;
  using Near = std::pair<double, std::int32_t>;
  std::priority_queue<Near, std::vector<Near>, std::greater<>> waiting;
  seen.resize(_mesh.triangle_count());
  std::vector<std::int32_t> marked;
  const auto add = [&](std::int32_t triangle, double distance) {
    if (distance >= support.radius || seen[at(triangle)] != 0) return;
    seen[at(triangle)] = 1;
    marked.push_back(triangle);
    waiting.push({distance, triangle});
  };
  for (const auto& edge : place.edges) {
    if (edge[0] != place.node && edge[1] != place.node) continue;
    for (const mesh::EdgeUse& use : _edges.find(edge[0], edge[1])) add(use.triangle, 0);
  }
  std::vector<Near> found;
  while (!waiting.empty()) {
    stop::look_at_turn(found.size(), gathering);
    const auto [nearest, triangle] = waiting.top();
    waiting.pop();
    if (nearest >= support.radius) break;
    if (found.size() == most_triangles) {
      support.radius = nearest;
      break;
    }
    found.push_back({nearest, triangle});
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = _mesh.triangles[3 * at(triangle) + i],
                         b = _mesh.triangles[3 * at(triangle) + (i + 1) % 3];
      const std::int32_t other = _across[3 * at(triangle) + i];
      const bool obstacle = other < 0 || is_obstacle(a, b, place);
      if (!obstacle && seen[at(other)] != 0) continue;
      const double distance = a == place.node || b == place.node
                                  ? 0
                                  : distance_to_edge(tip, position(_mesh, a), position(_mesh, b));
      if (obstacle)
        support.radius = std::min(support.radius, distance);
      else
        add(other, std::max(nearest, distance));
    }
  }
  for (const std::int32_t triangle : marked) seen[at(triangle)] = 0;
  if (found.empty()) return support;
  constexpr std::size_t enough = 200;  // triangles, about a radius of five edges
  const std::size_t quarter = std::min(std::max(found.size() / 4, enough), found.size() - 1);
  support.inner = std::min(found[quarter].first, support.radius / 2);
  for (const auto& [distance, triangle] : found)
    if (distance < support.radius) support.triangles.push_back(triangle);
  return support;
}

}  // namespace anticrack::tips
