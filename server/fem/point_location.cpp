// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/point_location.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace anticrack::fem {
namespace {

double cross(const PlanePoint& a, const PlanePoint& b, const PlanePoint& p) {
  return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

Location locate_in(const std::array<PlanePoint, 3>& corners, const PlanePoint& point) {
  Location found;
  found.depth = std::numeric_limits<double>::infinity();
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const PlanePoint &a = corners[(i + 1) % 3], &b = corners[(i + 2) % 3];
    const double doubled = cross(a, b, point);
    found.depth = std::min(found.depth, doubled / std::hypot(b[0] - a[0], b[1] - a[1]));
    found.weight[i] = std::max(doubled, 0.0);
    sum += found.weight[i];
  }
  for (double& weight : found.weight) weight /= sum;
  return found;
}

}  // namespace

PointSet::PointSet(std::span<const PlanePoint> points)
    : _points(points.begin(), points.end()), _order(points.size()) {
  std::iota(_order.begin(), _order.end(), std::size_t{0});
  std::sort(_order.begin(), _order.end(), [this](std::size_t a, std::size_t b) {
    return _points[a][0] != _points[b][0] ? _points[a][0] < _points[b][0] : a < b;
  });
}

std::size_t PointSet::first_from(double x) const {
  const auto first =
      std::lower_bound(_order.begin(), _order.end(), x,
                       [this](std::size_t i, double limit) { return _points[i][0] < limit; });
  return static_cast<std::size_t>(first - _order.begin());
}

std::vector<Location> locate(const Triangulation& part, const PointSet& points, double tolerance) {
  std::vector<Location> found(points.size());
  for (std::size_t t = 0; t < part.triangle_count(); ++t) {
    std::array<PlanePoint, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto node = static_cast<std::size_t>(part.triangles[3 * t + i]);
      corners[i] = {part.xy[2 * node], part.xy[2 * node + 1]};
    }
    if (!(cross(corners[0], corners[1], corners[2]) > 0))  // too small for the coordinates
      continue;
    points.visit_near(corners, tolerance, [&](std::size_t i) {
      Location here = locate_in(corners, points[i]);
      if (here.depth >= -tolerance && here.depth > found[i].depth) {
        here.triangle = static_cast<std::int32_t>(t);
        found[i] = here;
      }
    });
  }
  return found;
}

double distance_to_segment(const PlanePoint& point, const PlanePoint& a, const PlanePoint& b) {
  const double dx = b[0] - a[0], dy = b[1] - a[1];
  const double square = dx * dx + dy * dy;
  const double along = ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / square;
  const double part = std::clamp(square > 0 ? along : 0.0, 0.0, 1.0);
  return std::hypot(point[0] - (a[0] + part * dx), point[1] - (a[1] + part * dy));
}

}  // namespace anticrack::fem
