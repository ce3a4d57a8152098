// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

double angle_at(const Point& p, const Point& q, const Point& r) noexcept {
  const auto [ux, uy] = minus(q, p);
  const auto [vx, vy] = minus(r, p);
  return std::atan2(std::abs(ux * vy - uy * vx), ux * vx + uy * vy) * 180 / std::numbers::pi;
}

}  // namespace

std::array<double, 3> angles(const Point& a, const Point& b, const Point& c) noexcept {
  return {angle_at(a, b, c), angle_at(b, c, a), angle_at(c, a, b)};
}

Quality quality(const Mesh& mesh) noexcept {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Quality found{180, 0, infinity, 0, infinity};
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Point a = corner(mesh, t, 0);
    const Point b = corner(mesh, t, 1);
    const Point c = corner(mesh, t, 2);
    const auto [low, high] = std::ranges::minmax(angles(a, b, c));
    found.minimum_angle = std::min(found.minimum_angle, low);
    found.maximum_angle = std::max(found.maximum_angle, high);
    const auto [shortest, diameter] = std::minmax({distance(a, b), distance(b, c), distance(c, a)});
    found.shortest_edge = std::min(found.shortest_edge, shortest);
    found.smallest_diameter = std::min(found.smallest_diameter, diameter);
    found.largest_diameter = std::max(found.largest_diameter, diameter);
  }
  return found;
}

double minimum_angle(const Mesh& mesh) noexcept {
  double smallest = 180;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto of_triangle = angles(corner(mesh, t, 0), corner(mesh, t, 1), corner(mesh, t, 2));
    smallest = std::min(smallest, std::ranges::min(of_triangle));
  }
  return smallest;
}

}  // namespace anticrack::mesh
