// SPDX-License-Identifier: GPL-3.0-or-later
//
// From surfaces of the file to subdomains.
#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "mesh/edges.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"
#include "mesher/msh_file.hpp"

namespace anticrack::mesher {

/// Fills mesh.subdomain, mesh.subdomains and mesh.tension, with assumptions in mesh.warnings. Every
/// physical surface is a subdomain, in the order of tags; its name comes from
/// options.surface_groups, else from the file, else it is the tag. Without physical surfaces the
/// elementary ones count; a single one without a name in the options is divided into pieces by
/// `cuts`, the sorted pairs (low, high) of edges on lines of the file or doubled. Throws
/// errors::Error: mesh_invalid; invalid_argument at "options.surface_groups[TAG]" or
/// "options.tension[NAME]". O(m log m).
void read_surfaces(const MshFile& file, const mesh::MeshOptions& options,
                   const mesh::EdgeTable& edges,
                   std::span<const std::pair<std::int32_t, std::int32_t>> cuts, mesh::Mesh& mesh);

}  // namespace anticrack::mesher
