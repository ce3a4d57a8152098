// SPDX-License-Identifier: GPL-3.0-or-later
//
// Between the user's coordinates and gmsh's.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/geometry.hpp"

namespace anticrack::mesher {

/// Scales to a box of about (-1,1)^2, for gmsh's absolute tolerances. The factor is a power of two,
/// so nothing is rounded; the paper's square does not change.
class Frame {
 public:
  /// The frame of the bounding box of `points`, at least one.
  explicit Frame(const std::vector<mesh::Point>& points) {
    mesh::Point low = points.at(0);
    mesh::Point high = low;
    for (const mesh::Point& p : points) {
      for (std::size_t i = 0; i < 2; ++i) {
        low[i] = std::min(low[i], p[i]);
        high[i] = std::max(high[i], p[i]);
      }
    }
    for (std::size_t i = 0; i < 2; ++i) _centre[i] = low[i] + (high[i] - low[i]) / 2;
    const double extent = std::max(high[0] - low[0], high[1] - low[1]);
    _exponent = static_cast<int>(std::lround(std::log2(extent / 2)));
  }
  /// From the user's coordinates.
  mesh::Point to_gmsh(const mesh::Point& p) const {
    return {std::ldexp(p[0] - _centre[0], -_exponent), std::ldexp(p[1] - _centre[1], -_exponent)};
  }
  /// To the user's coordinates.
  mesh::Point from_gmsh(double x, double y) const {
    return {std::ldexp(x, _exponent) + _centre[0], std::ldexp(y, _exponent) + _centre[1]};
  }

 private:
  mesh::Point _centre{};
  int _exponent = 0;
};

}  // namespace anticrack::mesher
