// SPDX-License-Identifier: GPL-3.0-or-later
//
// How the chords of a network meet.
#pragma once

#include <array>
#include <vector>

#include "mesh/geometry_network.hpp"

namespace anticrack::mesh {

/// Two lines that meet where at least one has no station.
struct Crossing {
  std::array<int, 2> line{};
  std::array<double, 2> t{};
  Point at{};
};

/// Checks every pair of chords and returns the crossings that are no stations yet. Throws
/// geometry_invalid for a line that meets itself, leaves the polygon, touches the boundary other
/// than with its ends, runs along another line or meets it at less than a degree.
/// O(c log c + pairs of chords over the same x).
std::vector<Crossing> find_crossings(const Network& network);

}  // namespace anticrack::mesh
