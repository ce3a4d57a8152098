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

/// Checks every pair of chords and finds the crossings still to be made stations. Throws
/// geometry_invalid for a line that meets itself, leaves the polygon, touches the boundary other
/// than with its ends, runs along another or meets it at less than a degree.
/// O(c log c) and the pairs of chords over the same stretch of the x axis.
std::vector<Crossing> find_crossings(const Network& network);

}  // namespace anticrack::mesh
