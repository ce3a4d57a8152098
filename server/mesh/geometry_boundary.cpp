// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "mesh/geometry_curves.hpp"
#include "mesh/geometry_own_lines.hpp"
#include "mesh/geometry_primitives.hpp"
#include "mesh/geometry_steps.hpp"

namespace anticrack::mesh {
namespace {

struct Curve {
  InterfaceSpec spec;
  Field field;
};

std::vector<Curve> curves_of(const Geometry& geometry) {
  const std::vector<SideSpec>& sides = geometry.sides;
  const std::vector<std::string> names = side_names(geometry);
  check_count(sides.size(), "sides", "sides", max_interfaces);
  if (sides.size() < 2) {
    refuse("sides",
           "a boundary of one side; at least two sides are needed, or give the points of a polygon "
           "as `boundary`");
  }
  std::vector<Curve> curves;
  std::size_t vertices = 0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    Field field = Field("side", i, names[i]).at(".line", "");
    InterfaceSpec spec = curve_of(sides[i].line, field);
    vertices += spec.points.size();
    check_count(vertices, "sides", "vertices");
    if (spec.points.empty()) refuse(field, field, " has no points");
    check_points(spec.points, field + ".points");
    curves.push_back({std::move(spec), std::move(field)});
  }
  return curves;
}

/// Joins the sides end to end: gaps by rounding are closed, larger ones refused.
void join(std::vector<Curve>& curves, double reach) {
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Curve& before = curves[(i + curves.size() - 1) % curves.size()];
    Curve& side = curves[i];
    const Point& end = before.spec.points.back();
    Point& begin = side.spec.points.front();
    const double gap = distance(begin, end);
    if (gap > reach) {
      refuse(side.field, side.field, " begins at ", shown(begin), ", but ", before.field,
             " ends at ", shown(end), ", ", shown(gap),
             " away; each side begins where the one before it ends, and the last ends where the "
             "first begins");
    }
    begin = end;
  }
}

std::vector<Point> polygon_of(std::span<const NetworkLine> lines) {
  std::vector<Point> polygon;
  for (const NetworkLine& line : lines) {
    std::vector<Point> own = polygon_of(line.line);
    if (!line.line.closed()) own.pop_back();  // it is the first point of the next line
    polygon.insert(polygon.end(), own.begin(), own.end());
  }
  return polygon;
}

std::vector<NetworkLine> lines_of(const std::vector<Curve>& curves, const Outline& outline) {
  std::vector<NetworkLine> lines;
  lines.reserve(curves.size());
  for (const Curve& curve : curves)
    lines.push_back(
        {curve.field, Role::dirichlet, lay_curve(curve.spec, curve.field, outline), {}});
  return lines;
}

Boundary lay_sides(const Geometry& geometry) {
  std::vector<Curve> curves = curves_of(geometry);
  std::vector<Point> points;
  for (const Curve& curve : curves)
    points.insert(points.end(), curve.spec.points.begin(), curve.spec.points.end());
  Boundary boundary;
  boundary.outline.tolerance = check_extent(points, "sides");
  boundary.outline.boundary = points;
  join(curves, boundary.outline.tolerance * (snap_reach / relative_tolerance));
  boundary.lines = lines_of(curves, boundary.outline);
  const double area = signed_area(polygon_of(boundary.lines));
  if (std::abs(area) <= std::pow(boundary.outline.tolerance, 2) / relative_tolerance)
    refuse("sides", "sides enclose no area, or cross each other");
  boundary.turned = area < 0;
  if (boundary.turned) {
    std::reverse(curves.begin(), curves.end());
    for (Curve& curve : curves) std::reverse(curve.spec.points.begin(), curve.spec.points.end());
    boundary.lines = lines_of(curves, boundary.outline);
  }
  return boundary;
}

Boundary lay_polygon(const Geometry& geometry) {
  Boundary boundary;
  boundary.outline = check_outline(geometry.boundary);
  boundary.turned = signed_area(geometry.boundary) < 0;
  boundary.lines.push_back(
      {"boundary", Role::dirichlet, Line::polyline(boundary.outline.boundary, true), {}});
  return boundary;
}

NetworkLine hole_line(const HoleSpec& hole, Field field, const Outline& outline) {
  InterfaceSpec spec = curve_of(hole.outline, field);
  Line line = lay_curve(spec, field, outline);
  if (signed_area(polygon_of(line)) > 0) {
    std::reverse(spec.points.begin(), spec.points.end());
    line = lay_curve(spec, field, outline);
  }
  return {std::move(field), Role::dirichlet, std::move(line), {}};
}

}  // namespace

Boundary lay_boundary(const Geometry& geometry) {
  if (!geometry.sides.empty() && !geometry.boundary.empty())
    refuse("sides", "both boundary and sides are given; leave one of them out");
  Boundary boundary = geometry.sides.empty() ? lay_polygon(geometry) : lay_sides(geometry);
  boundary.outer = boundary.lines.size();
  check_count(geometry.holes.size(), "holes", "holes", max_interfaces);
  const std::vector<std::string> names = side_names(geometry);
  std::size_t vertices = 0;
  for (std::size_t i = 0; i < geometry.holes.size(); ++i) {
    vertices += geometry.holes[i].outline.points.size();
    check_count(vertices, "holes", "vertices");
    boundary.lines.push_back(hole_line(
        geometry.holes[i],
        Field("hole", i, names[names.size() - geometry.holes.size() + i]).at(".outline", ""),
        boundary.outline));
  }
  return boundary;
}

std::vector<Point> outer_polygon(const Network& network) {
  return polygon_of(std::span(network.lines).first(network.outer));
}

double area_of(const Network& network) {
  double area = signed_area(outer_polygon(network));
  for (std::size_t l = network.outer; l < network.boundary; ++l)
    area += signed_area(polygon_of(network.lines[l].line));
  return area;
}

}  // namespace anticrack::mesh
