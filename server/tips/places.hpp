// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where the tips of a mesh are, and what they are.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "mesh/edge_ends.hpp"
#include "mesh/edges.hpp"
#include "mesh/mesh.hpp"
#include "mesh/tip_kind.hpp"
#include "tips/course.hpp"

namespace anticrack::tips {

/// A tip, and the piece of interface on which it lies, as far as the piece is straight and of one
/// condition on either side of the tip.
struct Place {
  std::int32_t node = 0;
  std::int32_t interface = 0;               ///< index into Mesh::interfaces
  std::int32_t inclusion = -1;              ///< index into Mesh::inclusions
  std::array<std::int32_t, 2> subdomain{};  ///< on the minus and the plus side behind the tip
  mesh::TipKind kind = mesh::TipKind::other;
  bool unilateral = false;  ///< its faces touch but do not penetrate each other: it may be closed
  std::string reason;       ///< why nothing can be computed there; empty if it can
  Course course{};
  std::vector<std::array<std::int32_t, 2>> edges;  ///< of the piece, the lower node first; sorted
  /// Nodes of the piece behind the tip, from there on, where faces may part.
  std::vector<std::int32_t> behind;
  /// The piece ends at this distance.
  double reach = std::numeric_limits<double>::infinity();
};

/// One for each of mesh::tips(mesh), in their order. `edges`: those of the mesh's triangles; `ends`
/// those of mesh::edge_ends. O(m log m).
std::vector<Place> find_places(const mesh::Mesh& mesh, const mesh::EdgeTable& edges,
                               const std::vector<mesh::EdgeEnd>& ends);

}  // namespace anticrack::tips
