// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inclusions and cracks on the interfaces, and the Neumann boundary, as parameter stretches of
// lines.
#pragma once

#include <string>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/geometry_network.hpp"

namespace anticrack::mesh {

/// A stretch of an interface that is not glue. On a closed one `end` may lie past the line's last
/// parameter.
struct Stretch {
  int line = 0;
  double begin = 0;
  double end = 0;
  Kind kind = Kind::crack;
  int inclusion = -1;
};

/// A whole inclusion or crack.
struct PlacedPart {
  int line = 0;
  Station begin;
  Station end;
  std::string field;      ///< of the inclusion or crack
  int inclusion = -1;     ///< -1: a crack
  bool reversed = false;  ///< `begin` is the part's `to`
};

struct Layout {
  std::vector<PlacedPart> parts;
  std::vector<Stretch> stretches;
  std::vector<Stretch> neumann;  ///< of line 0
};

/// Places the parts on the lines, which get stations at their ends; a tip keeps the coordinates it
/// was given. Throws errors::Error (geometry_invalid) at "inclusions[1].part.from",
/// "neumann[0].to",
/// ... for a part off every interface, without length, or overlapping another one.
Layout lay_parts(const Geometry& geometry, Network& network);

/// The stretch that holds a chord; none: null.
const Stretch* stretch_of(const std::vector<Stretch>& stretches, const Network& network,
                          const Chord& chord) noexcept;

}  // namespace anticrack::mesh
