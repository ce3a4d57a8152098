// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points, segments and polylines of the plane. Lengths in the unit of the geometry.
#pragma once

#include <span>
#include <sstream>
#include <string>
#include <utility>

#include "errors/errors.hpp"
#include "mesh/geometry.hpp"

namespace anticrack::mesh {

/// a - b.
constexpr Point minus(const Point& a, const Point& b) noexcept {
  return {a[0] - b[0], a[1] - b[1]};
}

struct Segment {
  Point a{};
  Point b{};
};

/// From a point to a point, or to the nearest one of a segment.
double distance(const Point& a, const Point& b) noexcept;
double distance(const Point& p, const Segment& s) noexcept;
/// Where on `s` the point nearest to `p` lies: 0 at a, 1 at b.
double nearest(const Point& p, const Segment& s) noexcept;
/// 0 where they cross.
double distance(const Segment& s, const Segment& t) noexcept;
/// Where two segments come nearest, as parts of each of them; where they cross, if they do.
std::pair<double, double> meeting_point(const Segment& s, const Segment& t) noexcept;
/// Whether the bounding boxes, grown by `tolerance`, have a point in common. Cheap.
bool boxes_meet(const Segment& s, const Segment& t, double tolerance) noexcept;

/// Positive for a counterclockwise polygon. Shoelace about the first vertex.
double signed_area(std::span<const Point> polygon) noexcept;
/// Whether a point that is not on the boundary lies inside.
bool inside(const Point& p, std::span<const Point> polygon) noexcept;
double polyline_length(std::span<const Point> line) noexcept;
/// Diagonal of the bounding box.
double diagonal(std::span<const Point> points) noexcept;

/// For messages; the fewest digits that read back as the same number.
std::string show(const Point& p);
std::string show(double value);

/// Throws geometry_invalid with `field` at fault; the parts make up the message.
template <class... Parts>
[[noreturn]] void refuse(const std::string& field, const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  throw errors::Error(errors::Reason::geometry_invalid, text.str()).at(field);
}

/// "name[i]"
std::string indexed(const std::string& name, std::size_t i);

}  // namespace anticrack::mesh
