// SPDX-License-Identifier: GPL-3.0-or-later
//
// The boundary of the membrane: a polygon or sides, and holes.
#pragma once

#include <vector>

#include "mesh/geometry_network.hpp"
#include "mesh/geometry_outline.hpp"

namespace anticrack::mesh {

struct Boundary {
  std::vector<NetworkLine> lines;  ///< the first lines of Network, without stations
  std::size_t outer = 0;           ///< how many of them, from the first, are not holes
  bool turned = false;             ///< whether the outer boundary was written clockwise
  Outline outline;
};

/// Makes and checks the lines of the boundary. Throws errors::Error (geometry_invalid,
/// limit_exceeded) at "boundary[2]", "sides[1].line", "holes[0].outline.circle.radius", ... O(v^2)
/// for v vertices.
Boundary lay_boundary(const Geometry& geometry);

/// The boundary without holes, counterclockwise, with chords of at most five degrees.
std::vector<Point> outer_polygon(const Network& network);

/// The area of the membrane with the same chords, length unit squared.
double area_of(const Network& network);

}  // namespace anticrack::mesh
