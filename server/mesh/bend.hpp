// SPDX-License-Identifier: GPL-3.0-or-later
//
// Smooth pieces of curves, and the edges of a mesh that are chords of them.
#pragma once

#include <array>
#include <cstdint>

#include "fields/fields.hpp"

namespace anticrack::mesh {

using Point = std::array<double, 2>;

/// A piece of a curve by a parameter u in [0, 1], to which `at` and `derivative` clip it: an arc,
/// whose angle is linear in u, or a cubic given by its ends and the derivatives there.
struct Bend {
  Point a{};
  Point b{};
  Point centre{};
  double radius = 0;  ///< of an arc; 0: a cubic
  double angle = 0;   ///< arc: of its first point, radians
  double sweep = 0;   ///< arc: to its last point, positive if counterclockwise
  Point out{};        ///< cubic: derivative at u = 0
  Point in{};         ///< cubic: derivative at u = 1
  bool operator==(const Bend&) const = default;

  Point at(double u) const noexcept;
  Point derivative(double u) const noexcept;
};
ANTICRACK_FIELDS(Bend, a, b, centre, radius, angle, sweep, out, in)

/// An edge from node a to node b of a mesh, which lie on a bend at the parameters `from` and `to`.
struct BentEdge {
  std::int32_t a = 0;
  std::int32_t b = 0;
  std::int32_t bend = 0;  ///< index into Mesh::bends
  double from = 0;
  double to = 0;
  bool operator==(const BentEdge&) const = default;

  double middle() const noexcept { return 0.5 * (from + to); }
};
ANTICRACK_FIELDS(BentEdge, a, b, bend, from, to)

}  // namespace anticrack::mesh
