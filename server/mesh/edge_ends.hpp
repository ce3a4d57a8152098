// SPDX-License-Identifier: GPL-3.0-or-later
//
// Edges of interfaces as their ends see them, without those across which nothing changes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/edges.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesh {

/// An interface edge as one of its ends sees it.
struct EdgeEnd {
  std::int32_t node = 0;
  std::int32_t other = 0;
  Kind kind = Kind::glue;
  std::int32_t inclusion = -1;
  std::int32_t interface = 0;  ///< index into Mesh::interfaces
  bool forward = true;         ///< whether the chain runs from `node` to `other`
};

/// Both ends of all interface edges, sorted by (node, other), but for glue between subdomains of
/// the same tension. `edges`: those of the mesh's triangles. O(k log m) for k interface edges.
std::vector<EdgeEnd> edge_ends(const Mesh& mesh, const EdgeTable& edges);

/// The ends at a node. O(log k).
std::span<const EdgeEnd> ends_at(std::span<const EdgeEnd> ends, std::int32_t node) noexcept;

}  // namespace anticrack::mesh
