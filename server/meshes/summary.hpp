// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes the summary of a triangulation, and its arrays.
#pragma once

#include "mesh/mesh.hpp"
#include "records/block.hpp"
#include "records/mesh_record.hpp"

namespace anticrack::meshes {

/// Fills in the fields of a record that follow from its triangulation (not `sha256` and times):
/// subdomains, interfaces in segments of one kind and inclusion, tips, boundary lengths, warnings.
/// O(m log m).
void summarize(const mesh::Mesh& mesh, records::MeshRecord& record);

/// The arrays of ReadMesh: nodes (n,2), triangles (m,3), subdomain (m), boundary (b,2),
/// interfaces/I/nodes (k), interfaces/I/edge_kind (k-1), interfaces/I/edge_inclusion (k-1).
records::Block mesh_block(const mesh::Mesh& mesh);

}  // namespace anticrack::meshes
