// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_outline.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

constexpr double max_coordinate = 1e100;

Segment edge_of(std::span<const Point> polygon, std::size_t i) {
  return {polygon[i], polygon[(i + 1) % polygon.size()]};
}

std::string edge_name(const std::string& field, std::size_t i, std::size_t vertices) {
  return "the edge from " + indexed(field, i) + " to " + indexed(field, (i + 1) % vertices);
}

void check_points(const std::vector<Point>& points, const std::string& field) {
  if (points.size() > max_vertices) {
    throw errors::Error(errors::Reason::limit_exceeded,
                        field + " has " + std::to_string(points.size()) + " vertices; at most " +
                            std::to_string(max_vertices) + " are taken")
        .at(field);
  }
  for (std::size_t i = 0; i < points.size(); ++i) check_point(points[i], indexed(field, i));
}

void check_distinct(std::span<const Point> points, const std::string& field, double tolerance) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (distance(points[i - 1], points[i]) <= tolerance) {
      refuse(indexed(field, i), indexed(field, i), " ", show(points[i]), " repeats ",
             indexed(field, i - 1), "; leave one of them out");
    }
  }
}

/// Whether two edges with a common vertex lie on one another: `middle` is common.
bool folds_back(const Point& before, const Point& middle, const Point& after, double tolerance) {
  return distance(before, Segment{middle, after}) <= tolerance ||
         distance(after, Segment{middle, before}) <= tolerance;
}

/// `closed`: the last vertex is joined to the first.
void check_simple(std::span<const Point> points, bool closed, const std::string& field,
                  double tolerance) {
  const std::size_t n = points.size();
  const std::size_t edges = closed ? n : n - 1;
  for (std::size_t i = 0; i < edges; ++i) {
    const Segment s = edge_of(points, i);
    for (std::size_t j = i + 1; j < edges; ++j) {
      const Segment t = edge_of(points, j);
      if (!boxes_meet(s, t, tolerance)) continue;
      const bool follows = j == i + 1;
      const bool precedes = closed && i == 0 && j + 1 == edges;
      if (follows || precedes) {
        const bool folded =
            follows ? folds_back(s.a, s.b, t.b, tolerance) : folds_back(t.a, t.b, s.b, tolerance);
        if (folded) {
          refuse(field, field, " folds back on itself: ", edge_name(field, i, n), " and ",
                 edge_name(field, j, n), " lie on one another at ", show(follows ? s.b : s.a));
        }
      } else if (distance(s, t) <= tolerance) {
        refuse(field, field, " crosses or touches itself: ", edge_name(field, i, n), " ", show(s.a),
               "-", show(s.b), " meets ", edge_name(field, j, n), " ", show(t.a), "-", show(t.b));
      }
    }
  }
}

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

double check_boundary(const std::vector<Point>& boundary) {
  if (boundary.size() < 3) {
    refuse("boundary", "boundary has ", boundary.size(), " vertices; a polygon takes at least 3");
  }
  check_points(boundary, "boundary");
  const double extent = diagonal(boundary);
  const double tolerance = relative_tolerance * extent;
  double largest = 0;
  for (const Point& p : boundary) {
    largest = std::max({largest, std::abs(p[0]), std::abs(p[1])});
  }
  if (extent > 0 && extent < 1e-6 * largest) {
    refuse("boundary", "boundary is ", show(extent), " across, but lies ", show(largest),
           " from the origin: too far for the digits of a number; move it to the origin");
  }
  check_distinct(boundary, "boundary", tolerance);
  if (distance(boundary.front(), boundary.back()) <= tolerance) {
    const std::size_t last = boundary.size() - 1;
    refuse(indexed("boundary", last), indexed("boundary", last), " ", show(boundary.back()),
           " repeats boundary[0]; the polygon closes by itself, leave it out");
  }
  if (collinear(boundary, tolerance)) {
    refuse("boundary", "boundary encloses no area: its ", boundary.size(),
           " vertices lie on one straight line from ", show(boundary.front()));
  }
  check_simple(boundary, true, "boundary", tolerance);
  return tolerance;
}

struct Nearest {
  std::size_t edge = 0;
  double distance = 0;
};

Nearest nearest_edge(const Point& p, std::span<const Point> boundary) {
  Nearest best{0, distance(p, edge_of(boundary, 0))};
  for (std::size_t i = 1; i < boundary.size(); ++i) {
    const double d = distance(p, edge_of(boundary, i));
    if (d < best.distance) best = {i, d};
  }
  return best;
}

/// Where an end of the interface lies on the boundary; refused if it does not.
BoundaryPlace place_of(const Point& p, std::span<const Point> boundary, double tolerance,
                       std::size_t index, const char* verb) {
  const Nearest found = nearest_edge(p, boundary);
  if (found.distance > tolerance) {
    refuse("interface", "interface ", verb, " at interface[", index, "] ", show(p), ", ",
           show(found.distance), (inside(p, boundary) ? " inside" : " outside"),
           " the boundary; it must ", (index == 0 ? "start" : "end"),
           " on the boundary to cut the polygon in two");
  }
  const std::size_t next = (found.edge + 1) % boundary.size();
  if (distance(p, boundary[found.edge]) <= tolerance) return {found.edge, 0};
  if (distance(p, boundary[next]) <= tolerance) return {next, 0};
  return {found.edge, nearest(p, edge_of(boundary, found.edge))};
}

bool touches_place(std::size_t edge, const BoundaryPlace& place, std::size_t edges) {
  return edge == place.edge || (place.t == 0 && (edge + 1) % edges == place.edge);
}

/// The end of the interface that lies on this edge of the boundary, if `i` is the edge it belongs
/// to.
std::optional<Point> contact(const Segment& s, bool first, bool last, std::size_t edge,
                             const Outline& outline) {
  const std::size_t edges = outline.boundary.size();
  if (first && touches_place(edge, outline.start, edges)) return s.a;
  if (last && touches_place(edge, outline.end, edges)) return s.b;
  return std::nullopt;
}

/// Whether two segments with the common point `at` meet anywhere else.
bool meets_beyond(const Segment& s, const Segment& t, const Point& at, double tolerance) {
  for (const Point& p : {s.a, s.b}) {
    if (distance(p, at) > tolerance && distance(p, t) <= tolerance) return true;
  }
  for (const Point& p : {t.a, t.b}) {
    if (distance(p, at) > tolerance && distance(p, s) <= tolerance) return true;
  }
  return false;
}

void check_against_boundary(const std::vector<Point>& line, const Outline& outline) {
  const std::vector<Point>& boundary = outline.boundary;
  const std::size_t edges = line.size() - 1;
  for (std::size_t i = 0; i < edges; ++i) {
    const Segment s{line[i], line[i + 1]};
    for (std::size_t j = 0; j < boundary.size(); ++j) {
      const Segment t = edge_of(boundary, j);
      if (!boxes_meet(s, t, outline.tolerance)) continue;
      const auto common = contact(s, i == 0, i + 1 == edges, j, outline);
      const bool meets = common ? meets_beyond(s, t, *common, outline.tolerance)
                                : distance(s, t) <= outline.tolerance;
      if (meets) {
        refuse("interface", "interface leaves the polygon or touches its boundary in between: ",
               "the edge from interface[", i, "] ", show(s.a), " to interface[", i + 1, "] ",
               show(s.b), " meets the boundary's edge ", show(t.a), "-", show(t.b),
               "; only its two ends may lie on the boundary");
      }
    }
  }
  const Point middle{(line[0][0] + line[1][0]) / 2, (line[0][1] + line[1][1]) / 2};
  if (!inside(middle, boundary)) {
    refuse("interface", "interface runs outside the polygon, at ", show(middle),
           "; it must cut the polygon in two");
  }
}

}  // namespace

void check_point(const Point& p, const std::string& field) {
  for (const double value : p) {
    if (!std::isfinite(value) || std::abs(value) > max_coordinate) {
      refuse(field, field, " is ", show(p), "; both coordinates must be finite and at most ",
             show(max_coordinate), " in size");
    }
  }
}

Outline check_outline(const Geometry& geometry) {
  if (geometry.interfaces.size() != 1) refuse("interfaces", "one interface is taken");
  Outline outline;
  outline.tolerance = check_boundary(geometry.boundary);
  outline.boundary = geometry.boundary;
  if (signed_area(outline.boundary) < 0) {
    std::reverse(outline.boundary.begin(), outline.boundary.end());
  }
  const std::vector<Point>& line = geometry.interfaces.front().points;
  if (line.size() < 2) {
    refuse("interface", "interface has ", line.size(), " vertices; a polyline takes at least 2");
  }
  check_points(line, "interface");
  check_distinct(line, "interface", outline.tolerance);
  if (distance(line.front(), line.back()) <= outline.tolerance) {
    refuse("interface", "interface starts and ends at the same point ", show(line.front()),
           "; it must run from one point of the boundary to another to cut the polygon in two");
  }
  check_simple(line, false, "interface", outline.tolerance);
  outline.start = place_of(line.front(), outline.boundary, outline.tolerance, 0, "starts");
  outline.end = place_of(line.back(), outline.boundary, outline.tolerance, line.size() - 1, "ends");
  check_against_boundary(line, outline);
  return outline;
}

std::vector<std::size_t> vertices_between(const BoundaryPlace& from, const BoundaryPlace& to,
                                          std::size_t vertex_count) {
  std::size_t steps = (to.edge + vertex_count - from.edge) % vertex_count;
  if (steps == 0 && to.t <= from.t) steps = vertex_count;
  std::vector<std::size_t> passed;
  for (std::size_t k = 1; k <= steps; ++k) passed.push_back((from.edge + k) % vertex_count);
  // a place at t = 0 is the vertex itself
  if (to.t == 0 && !passed.empty()) passed.pop_back();
  return passed;
}

}  // namespace anticrack::mesh
