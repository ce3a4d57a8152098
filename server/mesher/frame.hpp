// SPDX-License-Identifier: GPL-3.0-or-later
//
// Between the user's coordinates and those gmsh works in.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/geometry.hpp"

namespace anticrack::mesher {

/// To a box of about (-1,1)^2, where gmsh's absolute tolerances fit. The factor is a power of two,
/// so it rounds nothing; the square of the paper stays as it is.
class Frame {
 public:
  /// `points`: at least one; the frame is that of their bounding box.
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
  /// A point of the geometry as gmsh is given it.
  mesh::Point to_gmsh(const mesh::Point& p) const {
    return {std::ldexp(p[0] - _centre[0], -_exponent), std::ldexp(p[1] - _centre[1], -_exponent)};
  }
  /// The way back.
  mesh::Point from_gmsh(double x, double y) const {
    return {std::ldexp(x, _exponent) + _centre[0], std::ldexp(y, _exponent) + _centre[1]};
  }

 private:
  mesh::Point _centre{};
  int _exponent = 0;
};

}  // namespace anticrack::mesher
