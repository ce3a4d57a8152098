// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rule of `Grading` for the tips of a mesh, applied to one triangle after another.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/box_tree.hpp"
#include "mesh/refine.hpp"

namespace anticrack::mesh {

/// A tree of bounding boxes of the tips. Keeps no reference to the mesh.
class SizeRule {
 public:
  /// Throws errors::Error (invalid_argument) at "h0", "m" or "tip_size". O(m + c log c) for m
  /// triangles and c centres.
  SizeRule(const Mesh& mesh, std::span<const std::int32_t> centres, const Grading& grading);

  /// Whether the longest edge is longer than some centre allows. Distances are computed from exact
  /// differences to the centre. Usually O(log c).
  bool too_large(const std::array<Point, 3>& triangle) const noexcept;

 private:
  struct Centre {
    Point at{};
    double reach = 0;     ///< R of the tip
    double tip_size = 0;  ///< h_tip
  };

  struct Sought {
    const std::array<Point, 3>& triangle;
    Point low, high;  ///< the bounding box of the triangle
    double diameter;
    double part;  ///< of its reach: how near to a centre the diameter is too large
    /// Whether its box is farther than `reach` from another one.
    bool beyond(const Point& box_low, const Point& box_high, double reach) const noexcept;
  };

  bool search(std::size_t box, const Sought& of) const noexcept;

  double _h0;
  double _exponent = 1;  ///< 1/(1-m)
  double _tip_size;      ///< the smallest of all
  std::vector<Centre> _centres;
  std::vector<Box> _boxes;  ///< value: the largest reach
};

}  // namespace anticrack::mesh
