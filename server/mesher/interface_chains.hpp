// SPDX-License-Identifier: GPL-3.0-or-later
//
// The edges of interfaces, put in order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesher/edge_roles.hpp"

namespace anticrack::mesher {

/// A chain of nodes with subdomain `left` on its left and `right` on its right all along; both are
/// the same for a slit.
struct Chain {
  std::int32_t left = 0;
  std::int32_t right = 0;
  std::vector<std::int32_t> nodes;          ///< k; a closed chain has its first again as last
  std::vector<const InterfaceEdge*> edges;  ///< k-1

  /// Whether it ends where it began.
  bool closed() const noexcept { return nodes.front() == nodes.back(); }
};

/// Chains end at free ends, at the boundary, and in cross points, where other than two edges meet.
/// By (lower, higher) subdomain, then by node. An open chain starts from its lower end node, a ring
/// from its lowest node. `on_boundary` (n). O(e log e) in the edges.
std::vector<Chain> build_chains(std::span<const InterfaceEdge> edges,
                                const std::vector<bool>& on_boundary);

/// The same chain walked the other way.
Chain reversed(Chain chain);

}  // namespace anticrack::mesher
