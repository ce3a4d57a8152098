// SPDX-License-Identifier: GPL-3.0-or-later
//
// Proved bounds of an expression along edges, as in load_proof.hpp on triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "expression/enclosure.hpp"
#include "expression/function.hpp"
#include "fem/load_parts.hpp"
#include "fem/load_proof.hpp"
#include "fem/triangulation.hpp"

namespace anticrack::fem {

/// A piece of a line, relative to its middle: points (x, y) + s (dx, dy), -1/2 <= s <= 1/2.
struct Piece {
  double x, y, dx, dy;
};

/// Bounds of a function g along a piece.
struct EnclosedPiece {
  double mean = 0;  ///< mean of g, right within `radius`
  double radius = 0;
  double middle = 0;            ///< about g in the middle
  double deviation = 0;         ///< >= root of the mean of (g - middle)^2
  expression::Interval values;  ///< of g
  expression::Interval slope;   ///< of dg/ds; not finite where g may jump
};
EnclosedPiece enclose(expression::Enclosure& g, const Piece& piece);

/// Fills `beyond` and `unknown` of the parts, whose load was integrated by samples, by halving
/// the edges of which most is unknown. Replaces moments that are proved to be wrong, and adds the
/// difference to `load` (n). Throws errors::Error (cancelled).
Proof prove_traction(const Triangulation& part, std::span<const std::array<std::int32_t, 2>> edges,
                     const expression::Function& g, TractionParts& parts, std::span<double> load,
                     double work);

}  // namespace anticrack::fem
