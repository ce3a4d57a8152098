// SPDX-License-Identifier: GPL-3.0-or-later
//
// Joins edges of interfaces to chains.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesher/edge_roles.hpp"

namespace anticrack::mesher {

/// A chain of nodes with subdomain `left` on its left and `right` on its right; both are equal for
/// a slit.
struct Chain {
  std::int32_t left = 0;
  std::int32_t right = 0;
  std::vector<std::int32_t> nodes;          ///< k; a closed chain repeats its first node
  std::vector<const InterfaceEdge*> edges;  ///< k-1

  /// Whether it is a ring.
  bool closed() const noexcept { return nodes.front() == nodes.back(); }
};

/// Chains end at free ends, at the boundary and at cross points (nodes without exactly two edges).
/// An open chain starts at its lower end node, a ring at its lowest node. Sorted by (lower, higher)
/// subdomain, then by node. `on_boundary` (n). O(e log e) for e edges.
std::vector<Chain> build_chains(std::span<const InterfaceEdge> edges,
                                const std::vector<bool>& on_boundary);

/// The chain in the opposite direction.
Chain reversed(Chain chain);

}  // namespace anticrack::mesher
