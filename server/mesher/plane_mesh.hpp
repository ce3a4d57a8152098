// SPDX-License-Identifier: GPL-3.0-or-later
//
// Nodes and triangles of a file, checked and repaired; groups come later.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "mesher/msh_file.hpp"

namespace anticrack::mesher {

struct PlaneMesh {
  std::vector<double> xy;                              ///< (n,2), nodes of triangles only
  std::vector<std::uint64_t> tags;                     ///< (n) numbers in the file
  std::vector<std::int32_t> triangles;                 ///< (m,3), counterclockwise, as in the file
  std::unordered_map<std::uint64_t, std::int32_t> of;  ///< node of each number, -1: in no triangle
  std::vector<std::string> warnings;
};

/// Drops nodes that no triangle uses, turns clockwise triangles round and drops a constant z (to
/// 1e-9 of the extent), with warnings. Throws errors::Error (mesh_invalid): no triangle, too many
/// nodes, a node defined twice or not at all, too large coordinates, varying z, a triangle without
/// area. O(n + m).
PlaneMesh read_plane(const MshFile& file);

}  // namespace anticrack::mesher
