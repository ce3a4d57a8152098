// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which triangles make a subdomain.
#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "mesh/edges.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"
#include "mesher/msh_file.hpp"

namespace anticrack::mesher {

/// Fills mesh.subdomain, mesh.subdomains, mesh.tension and what was assumed into mesh.warnings.
///
/// Every physical surface is a subdomain, in the order of the numbers, called as
/// options.surface_groups says, else by its name in the file, else by its number. In a file without
/// physical surfaces its elementary ones take their place; if that is a single one of which the
/// options say nothing, the pieces into which `cuts` part it.
///
/// `cuts` (sorted pairs low, high): edges with lines of the file, or doubled.
/// Throws errors::Error: mesh_invalid; invalid_argument at "options.surface_groups[TAG]" for a tag
/// the file lacks, at "options.tension[NAME]" for a name that is not a subdomain's or a tension
/// that is not a finite number above 0. O(m log m).
void read_surfaces(const MshFile& file, const mesh::MeshOptions& options,
                   const mesh::EdgeTable& edges,
                   std::span<const std::pair<std::int32_t, std::int32_t>> cuts, mesh::Mesh& mesh);

}  // namespace anticrack::mesher
