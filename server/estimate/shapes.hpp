// SPDX-License-Identifier: GPL-3.0-or-later
//
// What fluxes need of the shapes of triangles, worked out once for a mesh.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/at.hpp"
#include "fem/tension.hpp"

namespace anticrack::estimate {

using Vector = std::array<double, 2>;

constexpr double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1]; }

/// A corner of a fan: corner i of a triangle, and what loops over fans need.
struct FanCorner {
  std::int32_t triangle;
  std::int32_t i;
  double edge[2];  ///< e_i
};

/// Of triangles after the map of their tension (fem::Isotropic): fluxes s become A s, what goes
/// through an edge and all integrals stay.
struct Shapes {
  std::vector<double> area;     ///< (triangles)
  std::vector<double> tension;  ///< (triangles) T after the map
  double largest_tension = 0;
  std::vector<fem::Variation> variation;  ///< (triangles) empty: T is constant on each
  /// (corners) e_i: the side opposite to the corner, counterclockwise, over 2 sqrt(area T), so that
  /// a flux a e_i / (2 area) on a triangle, e_i the side itself, has |a e_i|^2 in the norm of 1/T.
  std::vector<Vector> edge;
  std::vector<FanCorner> around;  ///< of all fans
  std::vector<double> softness;   ///< (fans) 1 over the sum of e_i.e_i

  /// The length of a side over that of its e_i.
  double length(std::size_t triangle) const {
    return 2 * std::sqrt(area[triangle] * tension[triangle]);
  }
  /// The side itself.
  Vector side(std::size_t corner) const {
    const double by = length(corner / 3);
    return {by * edge[corner][0], by * edge[corner][1]};
  }
  std::size_t bytes() const noexcept;
};

struct Triangles {
  std::span<const std::int32_t> copy;            ///< (triangles, 3)
  std::span<const Vector> at;                    ///< (copies)
  std::span<const std::int32_t> first_triangle;  ///< (subdomains + 1)
  std::span<const fem::Tension* const> tension;  ///< (subdomains)
};

struct Fans {
  std::span<const std::int32_t> first_corner;  ///< (fans + 1)
  std::span<const std::int32_t> corners;
};

/// O(triangles).
Shapes shapes(const Triangles& triangles, const Fans& fans);

}  // namespace anticrack::estimate
