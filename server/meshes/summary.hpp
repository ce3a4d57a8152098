// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is told of a triangulation, and the block it is read as.
#pragma once

#include "mesh/mesh.hpp"
#include "store/block.hpp"
#include "store/records.hpp"

namespace anticrack::meshes {

/// Fills in what is known of a record once it is meshed (not `sha256` and the times): counts,
/// areas, angles and edges of each subdomain and whether it floats; runs of edges with one kind and
/// inclusion; tips; lengths of the boundary; warnings. O(m log m).
void summarize(const mesh::Mesh& mesh, store::MeshRecord& record);

/// The arrays of ReadMesh: nodes (n,2), triangles (m,3), subdomain (m), boundary (b,2),
/// interfaces/NAME/nodes (k), interfaces/NAME/kind (k-1), interfaces/NAME/inclusion (k-1).
store::Block mesh_block(const mesh::Mesh& mesh);

}  // namespace anticrack::meshes
