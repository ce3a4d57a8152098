// SPDX-License-Identifier: GPL-3.0-or-later
//
// Nodes that a file holds twice: along a crack, as gmsh's plugin Crack leaves them, or along the
// common line of surfaces that were meshed each for itself. A mesh::Mesh holds them once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::mesher {

/// Two edges of the file that lie on one another; welded, one edge with a triangle on each side.
struct DoubledEdge {
  std::int32_t low = 0;   ///< welded nodes, low < high
  std::int32_t high = 0;  ///< as above
  /// No way over common nodes joins its two sides in the file: they were meshed separately. A crack
  /// is held together at its tips.
  bool apart = false;
};

struct Welding {
  std::vector<std::int32_t> node;    ///< (n) number of each node afterwards, ascending by its first
  std::size_t node_count = 0;        ///< afterwards
  std::vector<DoubledEdge> doubled;  ///< by (low, high)

  /// Null where the edge is not doubled. O(log).
  const DoubledEdge* find(std::int32_t a, std::int32_t b) const noexcept;
};

/// Nodes of the rim (edges of one triangle) lie on one another when they are no further apart than
/// 1e-9 of the mesh's extent and a thousandth of their shortest rim edge.
/// `xy` (n,2), `triangles` (m,3) counterclockwise, both row-major; `tags` (n) for messages.
/// Throws errors::Error (mesh_invalid): edges that lie on one another but do not end in the same
/// nodes (hanging nodes), nodes that do so without a common edge, triangles that overlap.
/// O(m log m).
Welding weld(std::span<const double> xy, std::span<const std::int32_t> triangles,
             std::span<const std::uint64_t> tags);

}  // namespace anticrack::mesher
