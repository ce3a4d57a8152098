// SPDX-License-Identifier: GPL-3.0-or-later
//
// Checks of the polygon of the membrane and of any list of vertices.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/geometry_field.hpp"

namespace anticrack::mesh {

/// Points closer than this fraction of the boundary's diagonal count as one.
inline constexpr double relative_tolerance = 1e-9;
/// Points nearer than this fraction to the line on which they must lie are moved onto it.
inline constexpr double snap_reach = 1e-6;
inline constexpr std::size_t max_vertices = 20'000;
inline constexpr std::size_t max_interfaces = 1'000;

/// The vertices of the boundary (of a polygon, counterclockwise), and the distance within which two
/// points are one.
struct Outline {
  std::vector<Point> boundary;
  double tolerance = 0;
};

/// Checks the polygon of the boundary. Throws errors::Error (geometry_invalid, limit_exceeded) with
/// the field at fault: "boundary", "boundary[i]". O(v^2).
Outline check_outline(const std::vector<Point>& boundary);

/// The distance within which points of a boundary are one. Throws geometry_invalid at `owner` if
/// the boundary is too small or too far from the origin for double precision.
double check_extent(const std::vector<Point>& boundary, const Field& owner);

/// Throws geometry_invalid at `field` unless both coordinates are finite and at most 1e100 in size.
void check_point(const Point& p, const Field& field);

/// Throws limit_exceeded at `field` if there are more than `limit` of the `items` ("entries").
void check_count(std::size_t count, const Field& field, const char* items = "entries",
                 std::size_t limit = max_vertices);

/// Checks the number of points, at most `max_vertices`, and each point as check_point does.
void check_points(const std::vector<Point>& points, const Field& field);

/// Throws geometry_invalid at `field` if two consecutive points are equal.
void check_distinct(std::span<const Point> points, const Field& field, double tolerance);

/// Refuses `owner` if the polyline through the points `field` crosses itself or folds back.
/// `closed`: the last vertex is joined to the first. O(v log v) and
/// the pairs of edges over the same x.
void check_simple(std::span<const Point> points, bool closed, const Field& owner,
                  const Field& field, double tolerance);

}  // namespace anticrack::mesh
