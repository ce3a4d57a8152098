// SPDX-License-Identifier: GPL-3.0-or-later
//
// The steps of cut(): find the sides of interface nodes, tie sides, find parts that nothing holds.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ddm/decomposition.hpp"
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
  /// Side at each end, -1 in a Dirichlet node. At the tip of a slit both are the same.
  std::array<std::int32_t, 2> minus{-1, -1};
  std::array<std::int32_t, 2> plus{-1, -1};
};

struct Sides {
  std::vector<Side> sides;           ///< in the order in which the interfaces meet them
  std::vector<CutEdge> edges;        ///< of all interfaces, one after another
  std::vector<std::int32_t> corner;  ///< (3m) side to which a triangle's corner belongs, or -1
  std::vector<char> on_dirichlet;    ///< (n) the node is on the Dirichlet boundary
};

/// Finds the sides. Throws errors::Error (mesh_invalid) for an interface edge without a triangle on
/// each side, or for glue within one subdomain. O(m + k log k), k the number of interface edges.
Sides find_sides(const mesh::Mesh& mesh);

/// The position of a node as "(x, y)", for messages.
std::string place(const mesh::Mesh& mesh, std::int32_t node);

// Tells which sides share one value, and the conditions that remain between the others.

/// Two sides of a node with an interface edge between them.
struct Couple {
  std::int32_t minus = 0;
  std::int32_t plus = 0;
  std::int32_t contact = -1;
};

struct Ties {
  std::vector<std::int32_t> unknown;  ///< (sides) its entry of w
  std::vector<std::int32_t> rigid;    ///< (sides) inclusion whose plus side it is, or -1
  Skeleton skeleton;
  std::vector<Couple> couples;                      ///< in the order of the edges
  std::vector<std::array<std::int32_t, 2>> of_end;  ///< (edges) couple at each end, or -1
};

/// Gives tied sides one unknown and numbers the conditions between the other sides, the independent
/// ones first. Throws errors::Error as `cut` does. O(k log k).
Ties tie(const mesh::Mesh& mesh, const Sides& sides);

// Parts of the membrane that could move as a whole, which would make matrices singular.

/// Sets Subdomain::floating. O(n). Throws errors::Error: mesh_invalid for a part with neither
/// Dirichlet nor interface nodes; numerical for a part that no chain of tied sides joins to a
/// Dirichlet node.
void find_floating_parts(Decomposition& decomposition, int threads);

/// Sorts nodes along a Z-order curve (G. Morton, 1966) over their bounding box, 2^16 cells a side,
/// stable within a cell, so that nearby nodes share cache lines. `xy`: (n,2) row-major. O(k).
void sort_along_curve(std::vector<std::int32_t>& nodes, std::span<const double> xy);

}  // namespace anticrack::ddm
