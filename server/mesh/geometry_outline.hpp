// SPDX-License-Identifier: GPL-3.0-or-later
//
// The polygon, the interface that cuts it, and the outer boundary of the two parts it leaves.
#pragma once

#include <array>
#include <vector>

#include "mesh/geometry.hpp"

namespace anticrack::mesh {

/// Two points nearer to one another than this part of the boundary's diagonal count as one.
inline constexpr double relative_tolerance = 1e-9;
inline constexpr std::size_t max_vertices = 10'000;

/// A place on the boundary: on the edge from vertex `edge` to the next, `t` in [0,1) of the way.
struct BoundaryPlace {
  std::size_t edge = 0;
  double t = 0;
};

/// The polygon counterclockwise, and where the interface starts and ends on it.
struct Outline {
  std::vector<Point> boundary;
  BoundaryPlace start;
  BoundaryPlace end;
  double tolerance = 0;
};

/// Checks boundary and interface. Throws errors::Error (geometry_invalid, limit_exceeded) with the
/// field at fault: "boundary", "boundary[i]", "interface", "interface[i]".
Outline check_outline(const Geometry& geometry);

/// The vertices passed on the way counterclockwise from one place to another, ends left out.
std::vector<std::size_t> vertices_between(const BoundaryPlace& from, const BoundaryPlace& to,
                                          std::size_t vertex_count);

/// Throws geometry_invalid at `field` unless both coordinates are finite and of a size that can be
/// squared and summed.
void check_point(const Point& p, const std::string& field);

}  // namespace anticrack::mesh
