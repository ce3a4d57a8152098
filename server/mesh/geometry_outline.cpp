// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_outline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/geometry_primitives.hpp"
#include "mesh/precision.hpp"

namespace anticrack::mesh {
namespace {

// so that products of three coordinates stay finite
constexpr double max_coordinate = 1e100;
constexpr double min_extent = 1e-60;

Segment edge_of(std::span<const Point> polygon, std::size_t i) {
  return {polygon[i], polygon[(i + 1) % polygon.size()]};
}

/// Whether two edges with the common vertex `middle` lie on each other.
bool folds_back(const Point& before, const Point& middle, const Point& after, double tolerance) {
  return distance(before, Segment{middle, after}) <= tolerance ||
         distance(after, Segment{middle, before}) <= tolerance;
}

std::string edge_name(const Field& field, std::size_t i, std::size_t vertices) {
  return "the edge from " + field[i].shown + " to " + field[(i + 1) % vertices].shown;
}

}  // namespace

void check_count(std::size_t count, const Field& field, const char* items, std::size_t limit) {
  if (count <= limit) return;
  throw errors::Error(errors::Reason::limit_exceeded, "{} has {} {}; at most {} are allowed",
                      field.shown, count, items, limit)
      .at(field.path);
}

void check_points(const std::vector<Point>& points, const Field& field) {
  check_count(points.size(), field, "vertices");
  for (std::size_t i = 0; i < points.size(); ++i) check_point(points[i], field[i]);
}

void check_distinct(std::span<const Point> points, const Field& field, double tolerance) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (distance(points[i - 1], points[i]) <= tolerance) {
      refuse(field[i], field[i], " ", shown(points[i]), " repeats ", field[i - 1],
             "; leave one of them out");
    }
  }
}

namespace {

/// Whether two edges of a line meet where they must not.
bool meet(std::span<const Point> points, bool closed, std::size_t edges, std::size_t i,
          std::size_t j, double tolerance) {
  const Segment s = edge_of(points, i), t = edge_of(points, j);
  if (j == i + 1) return folds_back(s.a, s.b, t.b, tolerance);
  if (closed && i == 0 && j + 1 == edges) return folds_back(t.a, t.b, s.b, tolerance);
  return distance(s, t) <= tolerance;
}

/// The first two edges that meet so; {edges, edges} if there are none.
std::pair<std::size_t, std::size_t> first_meeting(std::span<const Point> points, bool closed,
                                                  std::size_t edges, double tolerance) {
  std::vector<Segment> segments;
  segments.reserve(edges);
  for (std::size_t i = 0; i < edges; ++i) segments.push_back(edge_of(points, i));
  std::pair<std::size_t, std::size_t> first{edges, edges};
  each_near_pair(segments, tolerance, [&](std::size_t s, std::size_t t) {
    const std::pair<std::size_t, std::size_t> pair = std::minmax(s, t);
    if (pair < first && meet(points, closed, edges, pair.first, pair.second, tolerance))
      first = pair;
  });
  return first;
}

}  // namespace

void check_simple(std::span<const Point> points, bool closed, const Field& owner,
                  const Field& field, double tolerance) {
  const std::size_t n = points.size();
  const std::size_t edges = closed ? n : n - 1;
  const auto [i, j] = first_meeting(points, closed, edges, tolerance);
  if (i == edges) return;
  const Segment s = edge_of(points, i), t = edge_of(points, j);
  if (j == i + 1 || (closed && i == 0 && j + 1 == edges)) {
    refuse(owner, owner, " folds back on itself: ", edge_name(field, i, n), " and ",
           edge_name(field, j, n), " lie on one another at ", shown(j == i + 1 ? s.b : s.a));
  }
  refuse(owner, owner, " crosses or touches itself: ", edge_name(field, i, n), " ", shown(s.a), "-",
         shown(s.b), " meets ", edge_name(field, j, n), " ", shown(t.a), "-", shown(t.b));
}

namespace {

bool collinear(std::span<const Point> points, double tolerance) {
  const auto far = std::max_element(points.begin(), points.end(), [&](auto& a, auto& b) {
    return distance(points[0], a) < distance(points[0], b);
  });
  const double reach = distance(points[0], *far);
  if (reach <= tolerance) return true;
  return std::all_of(points.begin(), points.end(), [&](const Point& p) {
    const double twice_area = ((*far)[0] - points[0][0]) * (p[1] - points[0][1]) -
                              ((*far)[1] - points[0][1]) * (p[0] - points[0][0]);
    return std::abs(twice_area) / reach <= tolerance;
  });
}

double check_polygon(const std::vector<Point>& boundary) {
  if (boundary.size() < 3)
    refuse("boundary", "boundary has ", boundary.size(), " vertices; a polygon takes at least 3");
  check_points(boundary, "boundary");
  const double tolerance = check_extent(boundary, "boundary");
  check_distinct(boundary, "boundary", tolerance);
  if (distance(boundary.front(), boundary.back()) <= tolerance) {
    const std::size_t last = boundary.size() - 1;
    refuse(indexed("boundary", last), indexed("boundary", last), " ", shown(boundary.back()),
           " repeats boundary[0]; the polygon closes by itself, leave it out");
  }
  if (collinear(boundary, tolerance)) {
    refuse("boundary", "boundary encloses no area: its ", boundary.size(),
           " vertices lie on one straight line from ", shown(boundary.front()));
  }
  check_simple(boundary, true, "boundary", "boundary", tolerance);
  return tolerance;
}

}  // namespace

void check_point(const Point& p, const Field& field) {
  for (const double value : p) {
    if (!std::isfinite(value) || std::abs(value) > max_coordinate) {
      refuse(field, field, " is ", shown(p), "; both coordinates must be finite and at most ",
             shown(max_coordinate), " in size");
    }
  }
}

double check_extent(const std::vector<Point>& boundary, const Field& owner) {
  const double extent = diagonal(boundary);
  double largest = 0;
  for (const Point& p : boundary) largest = std::max({largest, std::abs(p[0]), std::abs(p[1])});
  if (extent > 0 && extent < least_extent * largest) {
    refuse(owner, "boundary is ", shown(extent), " across, but lies ", shown(largest),
           " from the origin: too far for double precision; move it to the origin");
  }
  if (extent > 0 && extent < min_extent) {
    refuse(owner, "boundary is ", shown(extent), " across; at least ", shown(min_extent),
           " is required; choose a smaller unit of length");
  }
  return std::max(relative_tolerance * extent, coordinate_rounding * largest);
}

Outline check_outline(const std::vector<Point>& boundary) {
  Outline outline;
  outline.tolerance = check_polygon(boundary);
  outline.boundary = boundary;
  if (signed_area(outline.boundary) < 0)
    std::reverse(outline.boundary.begin(), outline.boundary.end());
  return outline;
}

}  // namespace anticrack::mesh
