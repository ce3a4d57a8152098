// SPDX-License-Identifier: GPL-3.0-or-later
//
// What every edge of the mesh is, by the groups it is in or by what lies beside it.
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

/// A line of the file, its nodes as numbers of the mesh.
struct CurveEdge {
  std::int32_t from = 0;
  std::int32_t to = 0;
  const CurveGroup* group = nullptr;  ///< null: in none
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

/// Groups with a meaning decide; an edge in several takes the one they agree on (a name of one's
/// own says nothing; inclusion:NAME and delaminated:NAME are delaminated:NAME; all cracks are
/// alike). Else adjacency does:
///   - on the boundary: dirichlet in a group, or where no boundary edge is; else neumann;
///   - on doubled nodes: crack; but where both sides were meshed separately as between two
///     subdomains;
///   - between two subdomains: glue;
///   - inside one: nothing, as for glue.
/// What was so decided is told in mesh.warnings, except that an edge in no group between two
/// subdomains is glue where the file says anything of its curves.
/// `mesh` has its nodes, triangles and subdomains.
/// Throws errors::Error (mesh_invalid): an edge with two meanings, a meaning that does not fit the
/// place, a line with a meaning that is not an edge, nothing dirichlet. O(m log m).
EdgeRoles read_edges(const mesh::EdgeTable& edges, std::span<const CurveEdge> lines,
                     const CurveGroups& groups, const Welding& welding, mesh::Mesh& mesh);

/// "(x, y)" of a node.
std::string place_of(const mesh::Mesh& mesh, std::int32_t node);

}  // namespace anticrack::mesher
