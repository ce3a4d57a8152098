// SPDX-License-Identifier: GPL-3.0-or-later
//
// The sides of interface nodes: the fans into which interface edges cut the triangles around a
// node.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace anticrack::ddm {

/// A fan of triangles around an interface node that is not on the Dirichlet boundary.
struct Side {
  std::int32_t node = 0;  ///< index into Mesh::xy
  std::int32_t subdomain = 0;
};

/// An interface edge between its two ends, index 0 and 1; plus is on the left of 0 -> 1.
struct CutEdge {
  std::int32_t interface = 0;
  mesh::Kind kind = mesh::Kind::glue;
  std::int32_t inclusion = -1;
  std::array<std::int32_t, 2> node{};
  /// Side at each end, -1 in a Dirichlet node. The same one on both faces at the tip of a slit.
  std::array<std::int32_t, 2> minus{-1, -1};
  std::array<std::int32_t, 2> plus{-1, -1};
};

struct Sides {
  std::vector<Side> sides;           ///< in the order in which the interfaces meet them
  std::vector<CutEdge> edges;        ///< of all interfaces, one after another
  std::vector<std::int32_t> corner;  ///< (3m) side a triangle's corner belongs to, or -1
  std::vector<char> on_dirichlet;    ///< (n) the node is on the Dirichlet boundary
};

/// Throws errors::Error (mesh_invalid) for an interface edge without a triangle on each side, or
/// glue within one subdomain. O(m + k log k), k the number of interface edges.
Sides find_sides(const mesh::Mesh& mesh);

/// "(x, y)" of a node, for messages.
std::string place(const mesh::Mesh& mesh, std::int32_t node);

}  // namespace anticrack::ddm
