// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_own_lines.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/geometry_outline.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

const char* name_of(Shape shape) {
  switch (shape) {
    case Shape::arc:
      return "arc";
    case Shape::spline:
      return "spline";
    case Shape::segment:
      return "segment";
    case Shape::circle:
      return "circle";
    case Shape::polyline:
      break;
  }
  return "polyline";
}

void check_length(double value, const Field& field, const char* what) {
  if (std::isfinite(value) && value > 0) return;
  refuse(field, field, " is ", shown(value), "; a ", what, " is a number above 0");
}

/// Cosine and sine of an angle, exact if they are 0 or 1.
Point direction(double degrees) {
  const double turn = std::remainder(degrees, 360);
  if (std::remainder(turn, 90) == 0) {
    const int quarter = static_cast<int>(std::lround(turn / 90));
    return {double(quarter == 0) - double(std::abs(quarter) == 2), double(quarter % 2)};
  }
  const double angle = turn * std::numbers::pi / 180;
  return {std::cos(angle), std::sin(angle)};
}

std::vector<Point> segment_ends(const LineSpec& line, const Field& field) {
  check_point(line.points.at(0), field + ".center");
  check_length(line.length, field + ".length", "length");
  if (!std::isfinite(line.angle))
    refuse(field + ".angle", field + ".angle", " is ", shown(line.angle), "; give it in degrees");
  const Point d = direction(line.angle);
  const auto [x, y] = line.points[0];
  const double half = line.length / 2;
  return {{x - half * d[0], y - half * d[1]}, {x + half * d[0], y + half * d[1]}};
}

}  // namespace

InterfaceSpec curve_of(const LineSpec& line, Field& field) {
  field = field.at(std::string(".") + name_of(line.shape), "");
  if (line.shape == Shape::segment) return {"", Shape::polyline, segment_ends(line, field), false};
  return {"", line.shape, line.points, false};
}

InterfaceSpec curve_of(const OutlineSpec& outline, Field& field) {
  const bool polygon = outline.shape == Shape::polyline;
  field = field.at(std::string(".") + (polygon ? "polygon" : name_of(outline.shape)), "");
  if (outline.shape != Shape::circle) return {"", outline.shape, outline.points, true};
  check_length(outline.radius, field + ".radius", "radius");
  const Point centre = outline.points.at(0);
  return {"", Shape::circle, {centre, {centre[0] + outline.radius, centre[1]}}, true};
}

Drawn draw(const Geometry& given) {
  check_count(given.interfaces.size(), "interfaces", "entries", max_interfaces);
  Drawn drawn(given);
  for (std::size_t i = 0; i < given.interfaces.size(); ++i) {
    Field field("interface", i, given.interfaces[i].name);
    if (given.interfaces.size() == 1 && given.interfaces[i].name.empty())
      field.shown = "the interface";
    drawn.fields.push_back(field.at(std::string(".") + name_of(given.interfaces[i].shape), ""));
  }
  const auto add = [&](const auto& line, const std::string& name, Field field) {
    if (!line) return -1;
    InterfaceSpec spec = curve_of(*line, field);
    spec.name = name;
    drawn.interfaces.push_back(std::move(spec));
    drawn.fields.push_back(std::move(field));
    return static_cast<int>(drawn.interfaces.size()) - 1;
  };
  const auto add_part = [&](auto& owner, const Field& field) {
    const int line = add(owner.line, owner.name, field.at(".line", ""));
    if (line >= 0) {
      const std::vector<Point>& points = drawn.interfaces.back().points;
      if (!points.empty()) owner.part = {points.front(), points.back()};
    }
    return line;
  };
  for (std::size_t i = 0; i < drawn.inclusions.size(); ++i)
    drawn.inclusion_lines.push_back(
        add_part(drawn.inclusions[i], {"inclusion", i, drawn.inclusions[i].name}));
  for (std::size_t i = 0; i < drawn.cracks.size(); ++i)
    drawn.crack_lines.push_back(add_part(drawn.cracks[i], {"crack", i, drawn.cracks[i].name}));
  for (std::size_t i = 0; i < drawn.regions.size(); ++i) {
    const RegionSpec& region = drawn.regions[i];
    drawn.region_lines.push_back(
        add(region.outline, region.name, Field("region", i, region.name).at(".outline", "")));
  }
  return drawn;
}

}  // namespace anticrack::mesh
