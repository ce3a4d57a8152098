// SPDX-License-Identifier: GPL-3.0-or-later
//
// Warnings about edges whose meaning the import assumed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesher/curve_groups.hpp"

namespace anticrack::mesher {

enum class Assumed {
  dirichlet,
  neumann,   ///< on the boundary, in no group
  glue,      ///< between two subdomains
  welded,    ///< glue between subdomains that were meshed separately
  joined,    ///< nothing, between separately meshed parts of a subdomain
  crack,     ///< doubled nodes
  nothing,   ///< a line inside one subdomain
  left_out,  ///< no edge of a triangle
};

class Assumptions {
 public:
  /// Adds an edge in a group without meaning.
  void add(const CurveGroup& group, Assumed assumed);
  /// Adds an edge in no group, by one of its nodes.
  void add(Assumed assumed, std::int32_t node);

  /// Adds to mesh.warnings: one per group and meaning; one per meaning for edges without group, and
  /// for curves of a file without groups.
  void tell(const CurveGroups& groups, mesh::Mesh& mesh) const;

 private:
  struct Bare {
    std::size_t edges = 0;
    std::int32_t node = 0;  ///< of the first
  };

  std::map<std::pair<std::int32_t, Assumed>, std::size_t> _by_group;
  std::map<Assumed, Bare> _bare;
};

}  // namespace anticrack::mesher
