// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shapes and sizes of triangles.
#pragma once

#include "base/at.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesh {

/// Smallest angle over all triangles, degrees. O(m).
double minimum_angle(const Mesh& mesh) noexcept;

/// Length of the longest edge, in the unit of the mesh. O(m).
double longest_edge(const Mesh& mesh) noexcept;

/// An angle of at most 90 degrees, by its tangent: comparing two takes a fifth of the time in which
/// one is computed.
struct Angle {
  double across = 1, along = 0;
  bool operator<(const Angle& other) const noexcept {
    return across / along < other.across / other.along;
  }
  double degrees() const noexcept;
};
/// The least of the angles at a, b and c; from differences of coordinates, so accurate for tiny
/// triangles.
Angle least_angle(const Point& a, const Point& b, const Point& c) noexcept;

}  // namespace anticrack::mesh
