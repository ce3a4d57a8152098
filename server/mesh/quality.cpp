// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

Angle angle_at(const Point& p, const Point& q, const Point& r) noexcept {
  const auto [ux, uy] = minus(q, p);
  const auto [vx, vy] = minus(r, p);
  const double across = std::abs(ux * vy - uy * vx);
  return {across, across > 0 ? ux * vx + uy * vy : 1};
}

}  // namespace

Angle least_angle(const Point& a, const Point& b, const Point& c) noexcept {
  const auto squared = [](const Point& p, const Point& q) {
    const Point along = minus(q, p);
    return along[0] * along[0] + along[1] * along[1];
  };
  // It is opposite to the shortest edge.
  const double at_a = squared(b, c), at_b = squared(c, a), at_c = squared(a, b);
  if (at_a <= at_b && at_a <= at_c) return angle_at(a, b, c);
  return at_b <= at_c ? angle_at(b, c, a) : angle_at(c, a, b);
}

double Angle::degrees() const noexcept {
  return std::atan2(across, along) * 180 / std::numbers::pi;
}

double minimum_angle(const Mesh& mesh) noexcept {
  Angle smallest;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    smallest =
        std::min(smallest, least_angle(corner(mesh, t, 0), corner(mesh, t, 1), corner(mesh, t, 2)));
  return smallest.degrees();
}

double longest_edge(const Mesh& mesh) noexcept {
  double longest = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Point a = corner(mesh, t, 0), b = corner(mesh, t, 1), c = corner(mesh, t, 2);
    longest = std::max({longest, distance(a, b), distance(b, c), distance(c, a)});
  }
  return longest;
}

}  // namespace anticrack::mesh
