// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the physical groups of curves say about edges.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mesh/edges.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesher {

enum class CurveRole { natural, dirichlet, crack, inclusion, delaminated };

struct CurveGroup {
  CurveRole role = CurveRole::natural;
  std::string name;  ///< of the inclusion or crack, else empty
  std::string full;  ///< as in the file, for messages
};

/// Groups by physical tag. Throws errors::Error (mesh_invalid) for a name that means nothing,
/// naming those that do, and for a name shared by a crack and an inclusion.
std::map<int, CurveGroup> read_curve_groups(const std::map<int, std::string>& names);

/// A line of the file, its nodes as indices into the mesh.
struct CurveEdge {
  std::int32_t from = 0;
  std::int32_t to = 0;
  int group = 0;
};

/// The named edges, checked against the triangles: dirichlet and neumann on the boundary, the
/// others between two subdomains, none with two meanings.
class NamedEdges {
 public:
  /// `groups` must outlive it. Throws errors::Error (mesh_invalid).
  NamedEdges(const mesh::Mesh& mesh, const mesh::EdgeTable& edges, std::span<const CurveEdge> lines,
             const std::map<int, CurveGroup>& groups);

  /// The group of an edge, in either direction, or null. O(log).
  const CurveGroup* find(std::int32_t a, std::int32_t b) const;

 private:
  struct Entry {
    std::int32_t low = 0;
    std::int32_t high = 0;
    const CurveGroup* group = nullptr;
  };
  std::vector<Entry> _entries;
};

/// "(x, y)" of a node.
std::string place_of(const mesh::Mesh& mesh, std::int32_t node);

}  // namespace anticrack::mesher
