// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points, segments and polylines of the plane. Lengths in the unit of the geometry.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <sstream>
#include <string>
#include <utility>

#include "errors/errors.hpp"
#include "mesh/geometry.hpp"
#include "mesh/geometry_field.hpp"

namespace anticrack::mesh {

constexpr Point minus(const Point& a, const Point& b) noexcept {
  return {a[0] - b[0], a[1] - b[1]};
}

struct Segment {
  Point a{};
  Point b{};
};

/// Distance of two points, or of a point from a segment.
double distance(const Point& a, const Point& b) noexcept;
double distance(const Point& p, const Segment& s) noexcept;
/// a + t (b - a).
constexpr Point point_on(const Segment& s, double t) noexcept {
  return {s.a[0] + t * (s.b[0] - s.a[0]), s.a[1] + t * (s.b[1] - s.a[1])};
}
/// The t in [0, 1] of the point of `s` that is nearest to `p`.
double nearest(const Point& p, const Segment& s) noexcept;
/// Distance of two segments, 0 if they cross.
double distance(const Segment& s, const Segment& t) noexcept;
/// The parameters of the points where two segments are nearest to each other, or cross.
std::pair<double, double> meeting_point(const Segment& s, const Segment& t) noexcept;
/// Whether the bounding boxes, grown by `tolerance`, have a point in common. Cheap.
inline bool boxes_meet(const Segment& s, const Segment& t, double tolerance) noexcept {
  for (std::size_t i = 0; i < 2; ++i) {
    if (std::min(s.a[i], s.b[i]) > std::max(t.a[i], t.b[i]) + tolerance) return false;
    if (std::min(t.a[i], t.b[i]) > std::max(s.a[i], s.b[i]) + tolerance) return false;
  }
  return true;
}

/// Calls visit(i, j) once for each pair of segments within `reach`, and some others, in a sweep
/// along x or, where there are very many over the same x, along the best of 16 directions. O(n log
/// n + pairs that overlap along it).
void each_near_pair(std::span<const Segment> segments, double reach,
                    const std::function<void(std::size_t, std::size_t)>& visit);

/// The area of a polygon, positive if counterclockwise. Shoelace formula about the first vertex.
double signed_area(std::span<const Point> polygon) noexcept;
/// Whether a point that is not on the boundary lies inside.
bool inside(const Point& p, std::span<const Point> polygon) noexcept;
/// Whether a ray from `p` crosses an odd number of these edges.
bool ray_meets(const Point& p, std::span<const Segment> edges) noexcept;
/// The length of the diagonal of the bounding box.
double diagonal(std::span<const Point> points) noexcept;

/// A point as text, for messages.
using errors::shown;
std::string shown(const Point& p);

/// Throws geometry_invalid with `field` at fault; the parts make up the message.
template <class... Parts>
[[noreturn]] void refuse(const Field& field, const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  throw errors::Error(errors::Reason::geometry_invalid, text.str()).at(field.path);
}

/// "name[i]"
std::string indexed(const std::string& name, std::size_t i);

}  // namespace anticrack::mesh
