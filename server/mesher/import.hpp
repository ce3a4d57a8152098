// SPDX-License-Identifier: GPL-3.0-or-later
//
// From a .msh file to a mesh: by its groups, by the request's options, else by adjacency
// (import_steps.hpp). Mesh::warnings lists repairs and assumptions.
#pragma once

#include <cstddef>
#include <string_view>

#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"
#include "mesher/msh_file.hpp"

namespace anticrack::mesher {

/// From the bytes of a file; the base mesh, not graded. Throws errors::Error: mesh_invalid,
/// limit_exceeded, and invalid_argument at "options.curve_groups[TAG]",
/// "options.surface_groups[TAG]", "options.tension[NAME]" or "options.inclusion_motions[NAME]" for
/// options that do not fit the file.
mesh::Mesh import_msh(std::string_view bytes, const mesh::MeshOptions& options,
                      std::size_t max_triangles);

/// From a file that was read. The result satisfies mesh::validate. Interfaces are called
/// "interface" (the only one) or "interface-1", "interface-2", ...; inclusions are numbered along
/// them. O(m log m).
mesh::Mesh to_mesh(const MshFile& file, const mesh::MeshOptions& options);

}  // namespace anticrack::mesher
