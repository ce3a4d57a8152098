// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_curves.hpp"

#include <array>
#include <cmath>

#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

/// Refuses points far outside the membrane, before products of such coordinates can overflow.
void check_near(const Point& p, const Field& field, const Outline& outline) {
  if (distance(p, outline.boundary.front()) > 10 * outline.tolerance / relative_tolerance)
    refuse(field, field, " ", shown(p), " lies outside the boundary; it must lie in the membrane");
}

/// Checks the points of a polyline or spline.
void check_vertices(const std::vector<Point>& points, const Field& owner, const Field& field,
                    const Outline& outline) {
  check_points(points, field);
  for (std::size_t i = 0; i < points.size(); ++i) check_near(points[i], field[i], outline);
  check_distinct(points, field, outline.tolerance);
  if (distance(points.front(), points.back()) <= outline.tolerance) {
    refuse(owner, owner, " starts and ends at the same point ", shown(points.front()),
           "; for a closed line set `closed` and leave the last point out");
  }
}

Line polyline_of(const std::vector<Point>& points, bool closed, const Field& owner,
                 const Field& field, const Outline& outline) {
  const std::size_t least = closed ? 3 : 2;
  if (points.size() < least) {
    refuse(owner, owner, " has ", points.size(), " vertices; a ", (closed ? "closed " : ""),
           "polyline takes at least ", least);
  }
  check_vertices(points, owner, field, outline);
  check_simple(points, closed, owner, field, outline.tolerance);
  return Line::polyline(points, closed);
}

Line spline_of(const InterfaceSpec& spec, const Field& owner, const Outline& outline) {
  if (spec.points.size() < 3)
    refuse(owner, owner, " has ", spec.points.size(), " points; a spline takes at least 3");
  check_vertices(spec.points, owner, owner + ".points", outline);
  return Line::spline(spec.points, spec.closed);
}

Line arc_of(const InterfaceSpec& spec, const Field& owner, const Outline& outline) {
  const double tolerance = outline.tolerance;
  if (spec.points.size() != 3) {
    refuse(owner, owner, " has ", spec.points.size(),
           " points; an arc is given by three: from, through, to");
  }
  if (spec.closed)
    refuse(owner, owner, " is closed, which an arc cannot be; make the circle a closed spline");
  const std::array<const char*, 3> names{".from", ".through", ".to"};
  for (std::size_t i = 0; i < 3; ++i) {
    check_point(spec.points[i], owner + names[i]);
    check_near(spec.points[i], owner + names[i], outline);
  }
  const Point& a = spec.points[0];
  const Point& b = spec.points[1];
  const Point& c = spec.points[2];
  if (distance(a, c) <= tolerance)
    refuse(owner + ".to", owner, " starts and ends at the same point ", shown(a));
  const double ab = distance(a, b), bc = distance(b, c), ac = distance(a, c);
  const double twice_area = std::abs(signed_area(std::array{a, b, c})) * 2;
  // The centre of a flatter arc is lost to rounding, since its radius ab bc ac / (2 twice_area)
  // exceeds the membrane by far. The negation also catches NaN.
  const bool flat = distance(b, Segment{a, c}) <= 1e3 * tolerance ||
                    !(ab * bc * ac <= 1e15 * tolerance * twice_area);
  if (flat || ab <= tolerance || bc <= tolerance) {
    refuse(owner + ".through", owner + ".through", " ", shown(b), " lies ", shown(twice_area / ac),
           " off the straight line through ", shown(a), " and ", shown(c),
           "; that is not an arc, give a polyline instead");
  }
  return Line::arc(a, b, c);
}

Line circle_of(const InterfaceSpec& spec, const Field& owner, const Outline& outline) {
  const Point& centre = spec.points[0];
  const double radius = distance(centre, spec.points[1]);
  check_point(centre, owner + ".center");
  check_near(centre, owner + ".center", outline);
  if (radius > 1e3 * outline.tolerance && radius <= outline.tolerance / relative_tolerance)
    return Line::circle(centre, radius);
  refuse(owner + ".radius", owner + ".radius", " is ", shown(radius),
         "; a circle in this membrane is ", shown(1e3 * outline.tolerance), " to ",
         shown(outline.tolerance / relative_tolerance), " in radius");
}

}  // namespace

Line lay_curve(const InterfaceSpec& spec, const Field& field, const Outline& outline) {
  switch (spec.shape) {
    case Shape::arc:
      return arc_of(spec, field, outline);
    case Shape::spline:
      return spline_of(spec, field, outline);
    case Shape::circle:
      return circle_of(spec, field, outline);
    case Shape::polyline:
    case Shape::segment:
      break;
  }
  return polyline_of(spec.points, spec.closed, field, field + ".points", outline);
}

std::vector<Point> polygon_of(const Line& line) {
  if (line.straight()) return line.vertices();
  std::vector<Point> polygon;
  for (int k = 0; k < line.spans(); ++k) {
    polygon.push_back(line.at(k));
    for (const double t : line.cuts_between(k, k + 1, {line.length()}))
      polygon.push_back(line.at(t));
  }
  if (!line.closed()) polygon.push_back(line.at(line.spans()));
  return polygon;
}

}  // namespace anticrack::mesh
