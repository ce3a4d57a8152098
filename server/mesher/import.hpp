// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes a mesh from a .msh file: by its groups, by the request's options, else by adjacency
// (import_steps.hpp). Mesh::warnings lists repairs and assumptions.
#pragma once

#include <cstddef>
#include <string_view>

#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"
#include "mesher/msh_file.hpp"

namespace anticrack::mesher {

/// The base mesh, not graded, from the bytes of a file. Throws errors::Error: mesh_invalid,
/// limit_exceeded, and invalid_argument at "options.curve_groups[TAG]",
/// "options.surface_groups[TAG]", "options.tension[NAME]" or "options.inclusion_motions[NAME]" for
/// options that do not fit the file.
mesh::Mesh import_msh(std::string_view bytes, const mesh::MeshOptions& options,
                      std::size_t max_triangles);

/// The mesh of a file that was read. It satisfies mesh::validate. Interfaces are called "interface"
/// (the only one) or "interface-1", "interface-2", ...; inclusions are numbered along them. O(m log
/// m).
mesh::Mesh to_mesh(const MshFile& file, const mesh::MeshOptions& options);

}  // namespace anticrack::mesher
