// SPDX-License-Identifier: GPL-3.0-or-later
//
// Points, segments and polylines of the plane. Lengths in the unit of the geometry.
#pragma once

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

/// From a point to a point, or to the nearest one of a segment.
double distance(const Point& a, const Point& b) noexcept;
double distance(const Point& p, const Segment& s) noexcept;
/// a + t (b - a).
constexpr Point point_on(const Segment& s, double t) noexcept {
  return {s.a[0] + t * (s.b[0] - s.a[0]), s.a[1] + t * (s.b[1] - s.a[1])};
}
/// The t of the point of `s` nearest to `p`, in [0, 1].
double nearest(const Point& p, const Segment& s) noexcept;
/// 0 where they cross.
double distance(const Segment& s, const Segment& t) noexcept;
/// Where two segments come nearest, as parts of each of them; where they cross, if they do.
std::pair<double, double> meeting_point(const Segment& s, const Segment& t) noexcept;
/// Whether the bounding boxes, grown by `tolerance`, have a point in common. Cheap.
bool boxes_meet(const Segment& s, const Segment& t, double tolerance) noexcept;

/// Calls visit(i, j) once for each pair of segments within `reach`, and some others, in a sweep
/// along x or, where there are very many over the same x, along the best of 16 directions. O(n log
/// n + pairs that overlap along it).
void each_near_pair(std::span<const Segment> segments, double reach,
                    const std::function<void(std::size_t, std::size_t)>& visit);

/// Positive for a counterclockwise polygon. Shoelace about the first vertex.
double signed_area(std::span<const Point> polygon) noexcept;
/// Whether a point that is not on the boundary lies inside.
bool inside(const Point& p, std::span<const Point> polygon) noexcept;
/// Whether a ray from `p` crosses an odd number of these edges.
bool ray_meets(const Point& p, std::span<const Segment> edges) noexcept;
/// Diagonal of the bounding box.
double diagonal(std::span<const Point> points) noexcept;

/// For messages.
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
