// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shapes and sizes of the triangles of a mesh.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

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
  const auto angle = [](const Point& p, const Point& q, const Point& r) {
    const auto [ux, uy] = minus(q, p);
    const auto [vx, vy] = minus(r, p);
    return std::atan2(std::abs(ux * vy - uy * vx), ux * vx + uy * vy) * 180 / std::numbers::pi;
  };
  Quality found;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Point a = corner(mesh, t, 0), b = corner(mesh, t, 1), c = corner(mesh, t, 2);
    const auto [low, high] = std::minmax({angle(a, b, c), angle(b, c, a), angle(c, a, b)});
    found.minimum_angle = std::min(found.minimum_angle, low);
    found.maximum_angle = std::max(found.maximum_angle, high);
    const auto [shortest, diameter] = std::minmax({distance(a, b), distance(b, c), distance(c, a)});
    found.shortest_edge = std::min(found.shortest_edge, shortest);
    found.smallest_diameter = std::min(found.smallest_diameter, diameter);
    found.largest_diameter = std::max(found.largest_diameter, diameter);
  }
  return found;
}

}  // namespace anticrack::mesh
