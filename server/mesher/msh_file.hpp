// SPDX-License-Identifier: GPL-3.0-or-later
//
// The content of a mesh file, not yet a membrane.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace anticrack::mesher {

/// An element with its nodes as tags of the file.
template <std::size_t Nodes>
struct MshElement {
  std::uint64_t tag = 0;
  std::array<std::uint64_t, Nodes> nodes{};
  int group = 0;   ///< physical tag, 0 for none
  int entity = 0;  ///< elementary tag
};

struct MshFile {
  std::map<int, std::string> curve_names;    ///< physical tag -> name, from $PhysicalNames
  std::map<int, std::string> surface_names;  ///< the same for surfaces
  std::vector<std::uint64_t> node_tags;      ///< (n)
  std::vector<double> xyz;                   ///< (n,3) row-major
  /// One entry for each physical group of a line. The direction is that of the file, reversed if
  /// the group contains the curve backwards.
  std::vector<MshElement<2>> lines;
  std::vector<MshElement<3>> triangles;
};

/// Reads MSH 2.0 to 2.2 and 4.1, ascii and binary, without gmsh: its reader tolerates damaged files
/// and may take a file for a script. Skips points and all that is no mesh (results, periodicity).
/// The parts of a partitioned mesh are in the groups of the whole. Throws errors::Error:
/// mesh_invalid (damaged, another version, geometry without a mesh, one part of a mesh saved in
/// parts, elements other than 2-node lines and 3-node triangles, names used twice), limit_exceeded
/// (more than `max_triangles`). Linear in the size of the file.
MshFile read_msh(std::string_view bytes, std::size_t max_triangles);

/// The same for a file of any format that can be read: a .msh, or a file of FreeFEM's savemesh
/// (freefem_file.hpp).
MshFile read_mesh_file(std::string_view bytes, std::size_t max_triangles);

/// Throws errors::Error (limit_exceeded) if the file has more than `max_triangles` triangles.
void check_triangle_limit(const MshFile& file, std::size_t max_triangles);

}  // namespace anticrack::mesher
