// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_primitives.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <vector>

namespace anticrack::mesh {
namespace {

double cross(const Point& o, const Point& a, const Point& b) noexcept {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

bool crosses(const Segment& s, const Segment& t) noexcept {
  const double a = cross(s.a, s.b, t.a);
  const double b = cross(s.a, s.b, t.b);
  const double c = cross(t.a, t.b, s.a);
  const double d = cross(t.a, t.b, s.b);
  return ((a > 0) != (b > 0)) && ((c > 0) != (d > 0));
}

}  // namespace

double distance(const Point& a, const Point& b) noexcept {
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

double nearest(const Point& p, const Segment& s) noexcept {
  const double dx = s.b[0] - s.a[0];
  const double dy = s.b[1] - s.a[1];
  const double square = dx * dx + dy * dy;
  if (square == 0) return 0;
  return std::clamp(((p[0] - s.a[0]) * dx + (p[1] - s.a[1]) * dy) / square, 0.0, 1.0);
}

double distance(const Point& p, const Segment& s) noexcept {
  return distance(p, point_on(s, nearest(p, s)));
}

double distance(const Segment& s, const Segment& t) noexcept {
  if (crosses(s, t)) return 0;
  return std::min({distance(s.a, t), distance(s.b, t), distance(t.a, s), distance(t.b, s)});
}

std::pair<double, double> meeting_point(const Segment& s, const Segment& t) noexcept {
  if (crosses(s, t)) {
    const double a = cross(s.a, s.b, t.a);
    const double b = cross(s.a, s.b, t.b);
    const double c = cross(t.a, t.b, s.a);
    const double d = cross(t.a, t.b, s.b);
    return {c / (c - d), a / (a - b)};
  }
  const std::array<double, 4> off{distance(s.a, t), distance(s.b, t), distance(t.a, s),
                                  distance(t.b, s)};
  switch (std::min_element(off.begin(), off.end()) - off.begin()) {
    case 0:
      return {0, nearest(s.a, t)};
    case 1:
      return {1, nearest(s.b, t)};
    case 2:
      return {nearest(t.a, s), 0};
    default:
      return {nearest(t.b, s), 1};
  }
}

bool boxes_meet(const Segment& s, const Segment& t, double tolerance) noexcept {
  for (std::size_t i = 0; i < 2; ++i) {
    if (std::min(s.a[i], s.b[i]) > std::max(t.a[i], t.b[i]) + tolerance) return false;
    if (std::min(t.a[i], t.b[i]) > std::max(s.a[i], s.b[i]) + tolerance) return false;
  }
  return true;
}

void each_near_pair(std::span<const Segment> segments, double reach,
                    const std::function<void(std::size_t, std::size_t)>& visit) {
  const auto low = [&](std::size_t i) { return std::min(segments[i].a[0], segments[i].b[0]); };
  const auto high = [&](std::size_t i) { return std::max(segments[i].a[0], segments[i].b[0]); };
  std::vector<std::size_t> order(segments.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, low);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double end = high(order[i]) + reach;
    for (std::size_t j = i + 1; j < order.size() && low(order[j]) <= end; ++j)
      if (boxes_meet(segments[order[i]], segments[order[j]], reach)) visit(order[i], order[j]);
  }
}

double signed_area(std::span<const Point> polygon) noexcept {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    twice += cross(polygon[0], polygon[i], polygon[i + 1]);
  return twice / 2;
}

namespace {

/// Whether the ray from `p` along x crosses the edge.
bool ray_crosses(const Point& p, Point a, Point b) noexcept {
  if ((a[1] > p[1]) == (b[1] > p[1])) return false;
  if (a[1] > b[1]) std::swap(a, b);
  return cross(a, b, p) > 0;
}

}  // namespace

bool ray_meets(const Point& p, std::span<const Segment> edges) noexcept {
  bool odd = false;
  for (const Segment& edge : edges) odd = odd != ray_crosses(p, edge.a, edge.b);
  return odd;
}

bool inside(const Point& p, std::span<const Point> polygon) noexcept {
  bool odd = false;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    odd = odd != ray_crosses(p, polygon[i], polygon[(i + 1) % polygon.size()]);
  return odd;
}

double diagonal(std::span<const Point> points) noexcept {
  if (points.empty()) return 0;
  Point low = points[0];
  Point high = points[0];
  for (const Point& p : points) {
    for (std::size_t i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  return distance(low, high);
}

std::string show(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 std::chars_format::general, errors::shown_digits);
  return {digits.data(), end.ptr};
}

std::string show(const Point& p) { return "(" + show(p[0]) + ", " + show(p[1]) + ")"; }

std::string indexed(const std::string& name, std::size_t i) {
  return name + "[" + std::to_string(i) + "]";
}

}  // namespace anticrack::mesh
