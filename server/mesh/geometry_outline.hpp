// SPDX-License-Identifier: GPL-3.0-or-later
//
// The polygon of the membrane, and what is asked of any list of vertices.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mesh/geometry.hpp"

namespace anticrack::mesh {

/// Two points nearer to one another than this part of the boundary's diagonal count as one.
inline constexpr double relative_tolerance = 1e-9;
inline constexpr std::size_t max_vertices = 10'000;
inline constexpr std::size_t max_interfaces = 1'000;

/// The polygon counterclockwise, and the distance within which two points are one.
struct Outline {
  std::vector<Point> boundary;
  double tolerance = 0;
};

/// Throws errors::Error (geometry_invalid, limit_exceeded) with the field at fault: "boundary",
/// "boundary[i]". O(v^2).
Outline check_outline(const std::vector<Point>& boundary);

/// Throws geometry_invalid at `field` unless both coordinates are finite and of a size that can be
/// squared and summed.
void check_point(const Point& p, const std::string& field);

/// The same of each of them, which are at most `max_vertices`.
void check_points(const std::vector<Point>& points, const std::string& field);

/// No two consecutive ones are equal.
void check_distinct(std::span<const Point> points, const std::string& field, double tolerance);

/// The polyline through the points `field` neither crosses itself nor folds back; else `owner` is
/// refused. `closed`: the last vertex is joined to the first. O(v^2).
void check_simple(std::span<const Point> points, bool closed, const std::string& owner,
                  const std::string& field, double tolerance);

}  // namespace anticrack::mesh
