// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shapes and sizes of triangles.
#pragma once

#include <array>

#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesh {

/// Angles in degrees, diameters (longest edges) in the unit of the mesh.
struct Quality {
  double minimum_angle = 0;
  double maximum_angle = 0;
  double smallest_diameter = 0;
  double largest_diameter = 0;
  double shortest_edge = 0;
};

/// Of a mesh with at least one triangle. O(m).
Quality quality(const Mesh& mesh) noexcept;

/// The angles at a, b and c, degrees. From differences of coordinates, so as right for a triangle
/// of 1e-13 as its corners are.
std::array<double, 3> angles(const Point& a, const Point& b, const Point& c) noexcept;

/// Corner 0, 1 or 2 of a triangle.
inline Point corner(const Mesh& mesh, std::size_t triangle, std::size_t i) noexcept {
  const auto node = 2 * static_cast<std::size_t>(mesh.triangles[3 * triangle + i]);
  return {mesh.xy[node], mesh.xy[node + 1]};
}

}  // namespace anticrack::mesh
