// SPDX-License-Identifier: GPL-3.0-or-later
//
// Data of the shapes of triangles that fluxes need, computed once for a mesh.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/at.hpp"
#include "base/large.hpp"
#include "fem/tension.hpp"

namespace anticrack::estimate {

using Vector = std::array<double, 2>;

constexpr double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1]; }

/// A corner of a fan, which is corner i of a triangle, with the data that loops over fans need.
struct FanCorner {
  std::int32_t triangle;
  std::int32_t i;
  double edge[2];  ///< e_i
};

/// Shapes of triangles after the map A of their tension (fem::Isotropic): a flux s becomes A s; the
/// flux through an edge and all integrals stay the same.
struct Shapes {
  std::vector<double> area;     ///< (triangles)
  std::vector<double> tension;  ///< (triangles) T after the map
  double largest_tension = 0;
  std::vector<fem::Variation> variation;  ///< (triangles) empty: T is constant on each
  /// (corners) e_i: the side opposite to the corner, counterclockwise, divided by 2 sqrt(area T).
  /// So a flux a E_i / (2 area) on a triangle, E_i the side itself, has the square |a e_i|^2 in the
  /// norm of 1/T.
  base::Large<Vector> edge;
  base::Large<FanCorner> around;  ///< of all fans
  std::vector<double> softness;   ///< (fans) 1 over the sum of e_i.e_i

  /// The length of a side divided by the length of its e_i.
  double length(std::size_t triangle) const {
    return 2 * std::sqrt(area[triangle] * tension[triangle]);
  }
  /// The side opposite to a corner, as a vector.
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

/// Computes the shapes. O(triangles).
Shapes shapes(const Triangles& triangles, const Fans& fans);

}  // namespace anticrack::estimate
