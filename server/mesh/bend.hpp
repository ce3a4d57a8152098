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

/// An edge from node a to node b of a mesh, where a bend has the parameters `from` and `to`.
struct BentEdge {
  std::int32_t a = 0;
  std::int32_t b = 0;
  std::int32_t bend = 0;  ///< index into Mesh::bends
  double from = 0;
  double to = 0;
  double chord = 0;  ///< length of the chord of which it is a part, and stays; 0: it is a chord
  bool operator==(const BentEdge&) const = default;

  double middle() const noexcept { return 0.5 * (from + to); }
};
ANTICRACK_FIELDS(BentEdge, a, b, bend, from, to, chord)

/// An edge from node a to node b on a chord of a curve, and how far to the left of it the curve
/// lies, as a parabola through its distances beside a, the middle and b.
struct ChordEdge {
  std::int32_t a = 0;
  std::int32_t b = 0;
  double at_a = 0, at_middle = 0, at_b = 0;
  double chord = 0;    ///< length of the whole chord
  double stretch = 0;  ///< length of the curve over that of the edge, less 1
  bool operator==(const ChordEdge&) const = default;

  /// Both halves; `middle` is the node between.
  std::array<ChordEdge, 2> halved(std::int32_t middle) const noexcept;
};
ANTICRACK_FIELDS(ChordEdge, a, b, at_a, at_middle, at_b, chord, stretch)

/// `a`, `b`: the places of the edge's nodes; `bend`: its own.
ChordEdge chord_edge(const BentEdge& edge, const Bend& bend, const Point& a, const Point& b);

}  // namespace anticrack::mesh
