// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds the triangle, and the edge, in which given points lie.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fem/triangulation.hpp"

namespace anticrack::fem {

using PlanePoint = std::array<double, 2>;

/// Points in an order that allows finding those in a box without looking at all of them.
class PointSet {
 public:
  /// Keeps the points with their indices. O(n log n).
  explicit PointSet(std::span<const PlanePoint> points);

  /// The number of points.
  std::size_t size() const noexcept { return _points.size(); }
  const PlanePoint& operator[](std::size_t i) const { return _points[i]; }

  /// Calls visit(i) for every point i in the bounding box of `corners` widened by `margin`, in no
  /// special order. O(log n + points in the box's range of x).
  template <std::size_t N, class Visit>
  void visit_near(const std::array<PlanePoint, N>& corners, double margin, Visit&& visit) const {
    PlanePoint low = corners[0], high = corners[0];
    for (const PlanePoint& corner : corners) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], corner[axis]);
        high[axis] = std::max(high[axis], corner[axis]);
      }
    }
    for (std::size_t k = first_from(low[0] - margin);
         k < _order.size() && _points[_order[k]][0] <= high[0] + margin; ++k) {
      const double y = _points[_order[k]][1];
      if (low[1] - margin <= y && y <= high[1] + margin) visit(_order[k]);
    }
  }

 private:
  std::size_t first_from(double x) const;

  std::vector<PlanePoint> _points;
  std::vector<std::size_t> _order;  ///< by x
};

/// The place of a point in a triangulation.
struct Location {
  std::int32_t triangle = -1;      ///< -1: outside
  std::array<double, 3> weight{};  ///< barycentric, none negative, sum 1
  /// Distance to the nearest side of the triangle, negative when the point is (just) outside.
  double depth = -std::numeric_limits<double>::infinity();
};

/// For each point the triangle in which it lies deepest, the first among equals; none if it is
/// outside all triangles by more than `tolerance` (length unit). O(m log k + hits) for k points.
std::vector<Location> locate(const Triangulation& part, const PointSet& points, double tolerance);

/// Distance of a point from the segment a b.
double distance_to_segment(const PlanePoint& point, const PlanePoint& a, const PlanePoint& b);

}  // namespace anticrack::fem
