// SPDX-License-Identifier: GPL-3.0-or-later
//
// Nodes and triangles of a file, checked and repaired, before groups are looked at.
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

/// Drops nodes that no triangle uses, turns clockwise triangles round, lets z go where it is the
/// same everywhere (to 1e-9 of the extent), each with a warning unless z = 0.
/// Throws errors::Error (mesh_invalid): no triangle, too many nodes, a node there twice or not at
/// all, coordinates too large, z that varies, a triangle without area. O(n + m).
PlaneMesh read_plane(const MshFile& file);

}  // namespace anticrack::mesher
