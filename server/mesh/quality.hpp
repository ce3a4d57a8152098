// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shapes and sizes of triangles.
#pragma once

#include <array>

#include "mesh/at.hpp"
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

/// Smallest angle over all triangles, degrees. O(m).
double minimum_angle(const Mesh& mesh) noexcept;

/// The angles at a, b and c, degrees; from differences of coordinates, so accurate for tiny
/// triangles.
std::array<double, 3> angles(const Point& a, const Point& b, const Point& c) noexcept;

}  // namespace anticrack::mesh
