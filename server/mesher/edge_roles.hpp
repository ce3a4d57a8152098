// SPDX-License-Identifier: GPL-3.0-or-later
//
// The role of every edge of the mesh, from its groups or from its surroundings.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/edges.hpp"
#include "mesh/mesh.hpp"
#include "mesher/curve_groups.hpp"
#include "mesher/welding.hpp"

namespace anticrack::mesher {

/// A line of the file with node numbers of the mesh.
struct CurveEdge {
  std::int32_t from = 0;
  std::int32_t to = 0;
  const CurveGroup* group = nullptr;  ///< null: no group
};

/// Walked from -> to, with subdomain `left` on its left; left == right inside a subdomain.
struct InterfaceEdge {
  std::int32_t from = 0;
  std::int32_t to = 0;
  std::int32_t left = 0;
  std::int32_t right = 0;
  CurveMeaning meaning;  ///< glue, crack, inclusion or delaminated
};

struct EdgeRoles {
  std::vector<std::array<std::int32_t, 2>> dirichlet;
  std::vector<InterfaceEdge> interfaces;  ///< by (low, high)
};

/// Groups with a meaning decide. Several groups must agree: names that are not keywords do not
/// count, inclusion:NAME with delaminated:NAME gives delaminated:NAME, and any two cracks agree.
/// Without a meaning the surroundings decide:
///   - on the boundary: dirichlet if the edge is in a group or no boundary edge is; else neumann;
///   - on doubled nodes: crack, unless both sides were meshed separately;
///   - between two subdomains: glue;
///   - inside a subdomain: nothing, as for glue.
/// mesh.warnings lists these decisions, except glue of edges in no group if the file gives any
/// curve a meaning. `mesh` has its nodes, triangles and subdomains. Throws errors::Error
/// (mesh_invalid): an edge with two meanings or one that does not fit its place, a line with a
/// meaning that is not an edge, no dirichlet edge. O(m log m).
EdgeRoles read_edges(const mesh::EdgeTable& edges, std::span<const CurveEdge> lines,
                     const CurveGroups& groups, const Welding& welding, mesh::Mesh& mesh);

}  // namespace anticrack::mesher
