// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_primitives.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
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

namespace {

/// Projections of segments onto a direction; the sweep visits pairs whose projections overlap.
struct Sweep {
  std::vector<double> low, high;   ///< ends of the projection of each segment
  std::vector<std::size_t> order;  ///< by `low`
};

Sweep sweep_along(std::span<const Segment> segments, double dx, double dy) {
  Sweep sweep;
  sweep.low.reserve(segments.size());
  sweep.high.reserve(segments.size());
  for (const Segment& each : segments) {
    const double a = dx * each.a[0] + dy * each.a[1];
    const double b = dx * each.b[0] + dy * each.b[1];
    sweep.low.push_back(std::min(a, b));
    sweep.high.push_back(std::max(a, b));
  }
  sweep.order.resize(segments.size());
  std::iota(sweep.order.begin(), sweep.order.end(), std::size_t{0});
  std::ranges::stable_sort(sweep.order, {}, [&](std::size_t i) { return sweep.low[i]; });
  return sweep;
}

/// The number of pairs that overlap along the direction.
double pairs_of(const Sweep& sweep, double reach) {
  std::vector<double> lows;
  lows.reserve(sweep.order.size());
  for (const std::size_t i : sweep.order) lows.push_back(sweep.low[i]);
  double pairs = 0;
  for (std::size_t i = 0; i < lows.size(); ++i) {
    const double end = sweep.high[sweep.order[i]] + reach;
    const auto after =
        std::upper_bound(lows.begin() + static_cast<std::ptrdiff_t>(i), lows.end(), end);
    pairs += static_cast<double>(after - lows.begin()) - static_cast<double>(i) - 1;
  }
  return pairs;
}

/// Along x or, where very many lie over the same x, along the direction with the fewest pairs.
Sweep best_sweep(std::span<const Segment> segments, double reach) {
  constexpr std::size_t few = 5'000;
  constexpr double many = 1e7;
  constexpr int directions = 16;
  Sweep best = sweep_along(segments, 1, 0);
  if (segments.size() < few) return best;
  double pairs = pairs_of(best, reach);
  for (int i = 1; i < directions && pairs > many; ++i) {
    const double angle = std::numbers::pi * i / directions;
    Sweep other = sweep_along(segments, std::cos(angle), std::sin(angle));
    const double fewer = pairs_of(other, reach);
    if (fewer >= pairs) continue;
    pairs = fewer;
    best = std::move(other);
  }
  return best;
}

/// Whether all of `t` lies on one side of the line through `s`, further off than `reach`.
bool beside(const Segment& s, const Segment& t, double reach) noexcept {
  const double a = cross(s.a, s.b, t.a);
  const double b = cross(s.a, s.b, t.b);
  if ((a > 0) != (b > 0)) return false;
  const double dx = s.b[0] - s.a[0];
  const double dy = s.b[1] - s.a[1];
  constexpr double rounding = 1 + 1e-5;
  const double least = std::min(a * a, b * b);
  return least > rounding * reach * reach * (dx * dx + dy * dy);
}

}  // namespace

void each_near_pair(std::span<const Segment> segments, double reach,
                    const std::function<void(std::size_t, std::size_t)>& visit) {
  const auto [low, high, order] = best_sweep(segments, reach);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Segment& s = segments[order[i]];
    const double end = high[order[i]] + reach;
    for (std::size_t j = i + 1; j < order.size() && low[order[j]] <= end; ++j) {
      const Segment& t = segments[order[j]];
      if (boxes_meet(s, t, reach) && !beside(s, t, reach) && !beside(t, s, reach))
        visit(order[i], order[j]);
    }
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

std::string shown(const Point& p) { return errors::shown(p[0], p[1]); }

std::string indexed(const std::string& name, std::size_t i) {
  return fmt::format("{}[{}]", name, i);
}

}  // namespace anticrack::mesh
