// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which triangles a graded mesh may not have.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/refine.hpp"

namespace anticrack::mesh {

/// The rule of `Grading`, its numbers checked and `tip_size` settled.
class SizeRule {
 public:
  /// Throws errors::Error (invalid_argument) at "h0", "m" or "tip_size". O(m + c log c).
  SizeRule(const Mesh& mesh, std::span<const std::int32_t> centres, const Grading& grading);

  /// Whether the longest edge exceeds what the distance to the nearest centre allows; distances
  /// from exact differences to the centre. O(log c + centres in reach).
  bool too_large(const std::array<Point, 3>& triangle) const noexcept;

 private:
  double _h0;
  double _tip_size;
  double _radius;     ///< R
  double _exponent;   ///< 1/(1-m)
  std::size_t _axis;  ///< the coordinate by which the centres are sorted: where they spread wider
  std::vector<Point> _centres;
};

}  // namespace anticrack::mesh
