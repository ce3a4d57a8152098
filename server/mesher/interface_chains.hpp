// SPDX-License-Identifier: GPL-3.0-or-later
//
// The edges between subdomains, put in order.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/edges.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesher {

/// A chain of nodes with subdomain `left` on its left and `right` on its right all along.
struct Chain {
  std::int32_t left = 0;
  std::int32_t right = 0;
  std::vector<std::int32_t> nodes;
};

/// One chain for each connected set of edges between the same two subdomains, by (lower, higher)
/// subdomain and then by its lowest end node, from which it starts.
/// Throws errors::Error (mesh_invalid) where edges branch, close to a ring, or change sides.
/// O(e log e) in the edges between subdomains.
std::vector<Chain> build_chains(const mesh::Mesh& mesh, const mesh::EdgeTable& edges);

/// The same chain walked the other way.
Chain reversed(Chain chain);

}  // namespace anticrack::mesher
