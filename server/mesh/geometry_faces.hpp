// SPDX-License-Identifier: GPL-3.0-or-later
//
// The faces into which a planar straight-line graph cuts the plane (M. de Berg et al.,
// Computational Geometry, chapter 2).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {

/// A loop walks edges with the face on its left: +-(edge + 1), negative from end to start of the
/// edge.
using Loop = std::vector<int>;

struct Face {
  Loop outer;               ///< counterclockwise
  std::vector<Loop> holes;  ///< clockwise
  double area = 0;          ///< within `outer`
  Segment box{};            ///< bounding box, from the lowest to the highest coordinates
};

struct Arrangement {
  static constexpr int outside = -1;

  std::vector<Face> faces;
  std::vector<int> left;   ///< per edge, used or not: the face on its left, or `outside`
  std::vector<int> right;  ///< per edge: the face on its right
};

/// The faces between the used edges, which meet only at their ends. A loop passes each vertex once.
/// O(e log e) for e edges, and O(e) for each connected part after the first.
Arrangement arrange(std::span<const Point> points, std::span<const std::array<int, 2>> edges,
                    const std::vector<bool>& used);

/// The face that contains a point not on an edge, or `outside`.
int face_at(const Arrangement& arrangement, std::span<const Point> points,
            std::span<const std::array<int, 2>> edges, const Point& p);

}  // namespace anticrack::mesh
