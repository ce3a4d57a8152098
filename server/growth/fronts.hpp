// SPDX-License-Identifier: GPL-3.0-or-later
//
// The paths along which fronts may grow, on a mesh on which they are what they become: delaminated,
// or a crack. A path holds at first; fronts are where it meets what is open already.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "growth/evolution.hpp"
#include "growth/path.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::growth {

/// Radii of the integral for G over the edges at the front. On meshes without symmetry a smaller
/// one errs by some per cent, whatever the mesh.
constexpr double least_radius = 10, radius = 16;

/// A path as nodes: of `first` to `last` of the interface nothing comes off before a front passes.
struct Stretch {
  std::size_t interface = 0;        ///< index into Mesh::interfaces
  std::size_t first = 0, last = 0;  ///< indices into Interface::nodes
  int forward = -1, backward = -1;  ///< the fronts that start at `first` and at `last`
  /// Whether the membrane holds beyond, so that the end is no tip as long as the path holds.
  bool holds_before = false, holds_beyond = false;
};

struct Front {
  std::size_t stretch = 0;
  bool forward = true;
  Track track;
  /// Of a crack that leaves an open delaminated end: the index of that end among the nodes of the
  /// interface, and how long the crack is in the first position; -1: it does not.
  std::ptrdiff_t end = -1;
  double length = 0;
  bool leaves() const { return end >= 0; }

  /// Index of position k among the nodes of the interface.
  std::size_t node(const Stretch& on, std::size_t k) const {
    return forward ? on.first + k : on.last - k;
  }
};

struct Fronts {
  std::vector<Stretch> stretches;  ///< one per path
  std::vector<Front> fronts;
};

/// Finds the fronts, in the order of the paths, of each first the one at its first end. Ends of
/// paths are moved to the nearest nodes. A crack that leaves the end of a delaminated inclusion
/// begins as long as least_radius edges, which is as near to the end as G can be computed. Throws
/// errors::Error at "paths[i]": invalid_argument for a path that leaves its interface by more than
/// an edge, crosses or touches another interface or path, is not open on the mesh, or has no front;
/// expression_invalid for Gc. O(k) for k interface edges, and O(m log m).
Fronts find_fronts(const mesh::Mesh& mesh, std::span<const Path> paths);

}  // namespace anticrack::growth
