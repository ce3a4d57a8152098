// SPDX-License-Identifier: GPL-3.0-or-later
//
// The line or circle on which a crack or an inclusion reaches its tip, and coordinates along it.
#pragma once

#include <array>

#include "mesh/mesh.hpp"

namespace anticrack::tips {

using mesh::Point;

inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1]; }
inline Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1]}; }

/// A point by its arc length s from the tip, positive ahead of it, and its distance d from the
/// course, positive on the plus side; with the gradients of both.
struct Along {
  double s = 0, d = 0;
  Point grad_s{}, grad_d{};
  double area = 1;  ///< ds dd over dx dy
};

/// Straight through the tip, or an arc. Directions are unit vectors at the tip.
struct Course {
  Point tip{};
  Point ahead{};      ///< out of the open part, or out of the inclusion
  Point normal{};     ///< from the minus to the plus side
  double radius = 0;  ///< the centre is tip + radius normal; 0: straight

  /// The unit tangent at (or, off the course, at the foot of) a point, ahead of the tip.
  Point tangent(const Point& x) const;
  /// Undefined in the centre of an arc.
  Along at(const Point& x) const;
  /// The point of the course at an arc length, from the tip, and the unit tangent there.
  Point place(double s) const;
  Point tangent_at(double s) const;
};

}  // namespace anticrack::tips
