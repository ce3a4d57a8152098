// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which edges a refinement cut, and what becomes of the interfaces and the boundary then.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"

namespace anticrack::mesh {

/// The nodes a refinement put on edges. Memory 16 bytes an edge cut.
class Midpoints {
 public:
  /// Node `first + i` is the midpoint of the edge between the two nodes parents[i]. O(k log k).
  Midpoints(std::int32_t first, std::span<const std::array<std::int32_t, 2>> parents);

  /// The midpoint of the edge, in either direction; -1 if it was not cut. O(log k).
  std::int32_t find(std::int32_t a, std::int32_t b) const noexcept;

 private:
  std::vector<std::pair<std::uint64_t, std::int32_t>> _cuts;  ///< (edge, midpoint), ascending
};

/// Replaces the edges of all interfaces and of the Dirichlet boundary by their pieces, recursively.
/// Pieces take the place, direction, kind and inclusion of the edge.
void cut_lines(Mesh& mesh, const Midpoints& midpoints);

}  // namespace anticrack::mesh
