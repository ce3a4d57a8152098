// SPDX-License-Identifier: GPL-3.0-or-later
//
// What fluxes need of the shapes of triangles, worked out once for a mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::estimate {

using Vector = std::array<double, 2>;

constexpr double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1]; }

/// A corner of a fan. e_i is the edge opposite to corner i, A the area, T the tension; j and k are
/// the corners after and before i, counterclockwise.
struct FanCorner {
  std::int32_t i, j, k, triangle;
  double out;         ///< e_i.(e_i - e_k) / (12 A T): of the flux that leaves it, through side j
  double in;          ///< e_i.(e_j - e_i) / (12 A T): of the flux that enters it, through side k
  Vector slope;       ///< e_i / (2 T)
  double compliance;  ///< T / A
};

struct Shapes {
  std::vector<double> area;                   ///< (triangles)
  std::vector<double> tension;                ///< (triangles)
  std::vector<Vector> edge;                   ///< (corners) opposite, counterclockwise
  std::vector<std::array<double, 3>> weight;  ///< (triangles, 3) -T e_j.e_k / (2 A) of corner i
  std::vector<FanCorner> around;              ///< of all fans
  std::vector<double> softness;  ///< (fans) 1 over the sum of e_i.e_i / (4 A T), the second
                                 ///< derivative of half the distance by the flux through all spokes

  std::size_t bytes() const noexcept;
};

struct Triangles {
  std::span<const std::int32_t> copy;            ///< (triangles, 3)
  std::span<const Vector> at;                    ///< (copies)
  std::span<const std::int32_t> first_triangle;  ///< (subdomains + 1)
  std::span<const double> tension;               ///< (subdomains)
};

struct Fans {
  std::span<const std::int32_t> first_corner;  ///< (fans + 1)
  std::span<const std::int32_t> corners;
};

/// O(triangles).
Shapes shapes(const Triangles& triangles, const Fans& fans);

}  // namespace anticrack::estimate
