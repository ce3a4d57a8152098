// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "records/mesh_record.hpp"

namespace anticrack::meshes {

/// Checks the laws of a definition before there is a mesh. Throws errors::Error
/// (expression_invalid) with the field at fault, e.g. "regions[0].tension_law.along",
/// "options.tension_laws[top].across".
void check_laws(const records::MeshDefinition& definition, std::size_t max_expression_bytes);

/// Sets tension and law of the record's subdomains. Throws errors::Error (expression_invalid) at
/// "geometry.regions[0].tension_law.along" and the like if a law is not above 0 on the mesh. O(m).
void summarize_tension(const mesh::Mesh& mesh, records::MeshRecord& record);

}  // namespace anticrack::meshes
