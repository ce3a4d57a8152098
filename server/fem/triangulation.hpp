// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace anticrack::fem {

/// Triangles of one subdomain with its own node numbers, index base 0, counterclockwise.
struct Triangulation {
  std::vector<double> xy;               ///< (n,2) row-major
  std::vector<std::int32_t> triangles;  ///< (m,3) row-major
  /// (m) areas(), or empty. Kept, they halve what it costs to integrate an array of a load: nodes
  /// are fetched from all over memory.
  std::vector<double> area = {};

  std::size_t node_count() const noexcept { return xy.size() / 2; }
  std::size_t triangle_count() const noexcept { return triangles.size() / 3; }

  /// Of the t-th triangle, from its corners.
  double area_of(std::size_t t) const noexcept {
    const auto corner = [this, t](std::size_t a) {
      return &xy[2 * static_cast<std::size_t>(triangles[3 * t + a])];
    };
    const double *o = corner(0), *p = corner(1), *q = corner(2);
    return 0.5 * ((p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]));
  }
  std::vector<double> areas() const {
    std::vector<double> result(triangle_count());
    for (std::size_t t = 0; t < result.size(); ++t) {
      result[t] = area_of(t);
    }
    return result;
  }
};

}  // namespace anticrack::fem
