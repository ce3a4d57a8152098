// SPDX-License-Identifier: GPL-3.0-or-later
//
// Plane meshes as FreeFEM's savemesh writes them.
#pragma once

#include <cstddef>
#include <string_view>

#include "mesher/msh_file.hpp"

namespace anticrack::mesher {

// The label of an edge is its group, 0 for none; the label of a triangle is its surface. Nodes are
// numbered from 1. Both throw errors::Error: mesh_invalid (damaged, a negative label, elements
// other than edges and triangles), limit_exceeded (more than `max_triangles`). Linear in the size
// of the file.

/// Reads FreeFEM's own .msh: the counts of vertices, triangles and edges, then x y label, three
/// vertices and a label, two vertices and a label.
MshFile read_freefem(std::string_view bytes, std::size_t max_triangles);

/// Reads a .mesh (Medit's format, which gmsh writes as well) as text, in a plane.
MshFile read_medit(std::string_view bytes, std::size_t max_triangles);

}  // namespace anticrack::mesher
