// SPDX-License-Identifier: GPL-3.0-or-later
//
// Unites doubled nodes of a file: along cracks made by gmsh's plugin Crack, or along the common
// line of surfaces that were meshed separately. A mesh::Mesh has each node once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::mesher {

/// Two edges of the file at the same place: after welding one edge with a triangle on each side.
struct DoubledEdge {
  std::int32_t low = 0;   ///< welded nodes, low < high
  std::int32_t high = 0;  ///< as above
  /// The two sides are not connected over common nodes of the file: they were meshed separately.
  /// The sides of a crack are connected at its tips.
  bool apart = false;
};

struct Welding {
  std::vector<std::int32_t> node;    ///< (n) new number of each node, in order of first occurrence
  std::size_t node_count = 0;        ///< afterwards
  std::vector<DoubledEdge> doubled;  ///< by (low, high)

  /// Null if the edge is not doubled. O(log).
  const DoubledEdge* find(std::int32_t a, std::int32_t b) const noexcept;
};

/// Unites nodes of the rim (edges of one triangle) within 1e-9 of the mesh's extent and a
/// thousandth of their shortest rim edge. `xy` (n,2), `triangles` (m,3) counterclockwise, both
/// row-major; `tags` (n) for messages. Throws errors::Error (mesh_invalid): hanging nodes, nodes at
/// the same place without a common edge, overlapping triangles. O(m log m).
Welding weld(std::span<const double> xy, std::span<const std::int32_t> triangles,
             std::span<const std::uint64_t> tags);

}  // namespace anticrack::mesher
