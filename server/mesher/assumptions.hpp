// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the import took edges for without being told, in words.
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
  neumann,   ///< of the boundary, in no group
  glue,      ///< between two subdomains
  welded,    ///< glue, the subdomains meshed separately
  joined,    ///< nothing: parts of one subdomain meshed separately
  crack,     ///< doubled nodes
  nothing,   ///< a line inside one subdomain
  left_out,  ///< no edge of a triangle
};

class Assumptions {
 public:
  /// Of an edge in a group without meaning.
  void add(const CurveGroup& group, Assumed assumed);
  /// Of an edge in no group, at a node of it.
  void add(Assumed assumed, std::int32_t node);

  /// Into mesh.warnings: one a group and meaning, one a meaning for edges without group and for
  /// curves of a file without groups.
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
