// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shapes and sizes of the triangles of a mesh, and a mesh that is twice as fine.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "mesh/edges.hpp"
#include "mesh/geometry_primitives.hpp"
#include "mesh/quality.hpp"

namespace anticrack::mesh {

/// Angles in degrees, diameters (longest edges) in the unit of the mesh.
struct Quality {
  double minimum_angle = 180;
  double maximum_angle = 0;
  double smallest_diameter = std::numeric_limits<double>::infinity();
  double largest_diameter = 0;
  double shortest_edge = std::numeric_limits<double>::infinity();
};

inline Quality quality(const Mesh& mesh) {
  Quality found;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Point a = corner(mesh, t, 0), b = corner(mesh, t, 1), c = corner(mesh, t, 2);
    const auto [low, high] = std::ranges::minmax(angles(a, b, c));
    found.minimum_angle = std::min(found.minimum_angle, low);
    found.maximum_angle = std::max(found.maximum_angle, high);
    const auto [shortest, diameter] = std::minmax({distance(a, b), distance(b, c), distance(c, a)});
    found.shortest_edge = std::min(found.shortest_edge, shortest);
    found.smallest_diameter = std::min(found.smallest_diameter, diameter);
    found.largest_diameter = std::max(found.largest_diameter, diameter);
  }
  return found;
}

/// Cuts every triangle into four similar to it, as mesh/refine.hpp describes a refined mesh.
inline Mesh refine_uniform(const Mesh& base) {
  Mesh mesh = base;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  EdgeTable(base.triangles).each([&](std::span<const EdgeUse> uses) {
    middles[{uses[0].low(), uses[0].high()}] = static_cast<std::int32_t>(mesh.node_count());
    const auto [ax, ay] = position(base, uses[0].low());
    const auto [bx, by] = position(base, uses[0].high());
    mesh.xy.insert(mesh.xy.end(), {0.5 * (ax + bx), 0.5 * (ay + by)});
  });
  const auto middle = [&](std::int32_t a, std::int32_t b) { return middles.at(std::minmax(a, b)); };
  mesh.triangles.clear();
  mesh.subdomain.clear();
  for (std::size_t t = 0; t < base.triangle_count(); ++t) {
    const std::int32_t* node = &base.triangles[3 * t];
    const std::int32_t a = node[0], b = node[1], c = node[2];
    const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    mesh.triangles.insert(mesh.triangles.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    mesh.subdomain.insert(mesh.subdomain.end(), 4, base.subdomain[t]);
  }
  for (Interface& line : mesh.interfaces) {
    Interface cut{line.name, {line.nodes.front()}, {}, {}};
    for (std::size_t i = 0; i < line.kind.size(); ++i) {
      cut.nodes.insert(cut.nodes.end(),
                       {middle(line.nodes[i], line.nodes[i + 1]), line.nodes[i + 1]});
      cut.kind.insert(cut.kind.end(), 2, line.kind[i]);
      cut.inclusion.insert(cut.inclusion.end(), 2, line.inclusion[i]);
    }
    line = std::move(cut);
  }
  mesh.dirichlet.clear();
  for (const auto& [a, b] : base.dirichlet) {
    mesh.dirichlet.push_back({a, middle(a, b)});
    mesh.dirichlet.push_back({middle(a, b), b});
  }
  return mesh;
}

}  // namespace anticrack::mesh
