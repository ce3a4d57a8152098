// SPDX-License-Identifier: GPL-3.0-or-later
//
// What lies on the interface, as intervals of its arc length.
#pragma once

#include <vector>

#include "mesh/geometry.hpp"

namespace anticrack::mesh {

/// A stretch of the interface between two arc lengths that is not glue.
struct Stretch {
  double begin = 0;
  double end = 0;
  Kind kind = Kind::crack;
  int inclusion = -1;
};

/// A point where curves of the interface meet.
struct Station {
  double s = 0;  ///< arc length from the interface's start
  Point point{};
};

struct InterfaceLayout {
  std::vector<Stretch> stretches;  ///< in order, not overlapping
  std::vector<Station> stations;   ///< in order: ends, vertices, ends of stretches
};

/// Checks names and places of inclusions and cracks and sorts them along the interface, which is
/// known to be a simple polyline. A tip takes the coordinates it was given.
/// Throws errors::Error (geometry_invalid) with fields like "inclusions[1].part.from".
InterfaceLayout lay_out(const Geometry& geometry);

}  // namespace anticrack::mesh
