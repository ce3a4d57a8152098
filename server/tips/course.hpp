// SPDX-License-Identifier: GPL-3.0-or-later
//
// The straight line on which a crack or an inclusion reaches its tip. Curves are chords in a mesh,
// and so the line is that of the chord at the tip.
#pragma once

#include "mesh/mesh.hpp"

namespace anticrack::tips {

using mesh::Point;

/// Products and differences of vectors of the plane.
inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1]; }
inline Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1]}; }

/// Directions are unit vectors at right angles; (ahead, normal) may be of either orientation.
struct Course {
  Point tip{};
  Point ahead{};   ///< out of the open part, or out of the inclusion
  Point normal{};  ///< from the minus to the plus side

  /// How far a point is ahead of the tip, and on the plus side of the line.
  double along(const Point& x) const { return dot(minus(x, tip), ahead); }
  double across(const Point& x) const { return dot(minus(x, tip), normal); }
};

}  // namespace anticrack::tips
