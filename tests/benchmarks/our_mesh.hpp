// SPDX-License-Identifier: GPL-3.0-or-later
//
// From our mesh to the plain one and back.
#pragma once

#include <memory>

#include "benchmarks/plain_mesh.hpp"
#include "fem/load.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::benchmarks {

/// Throws std::runtime_error for a mesh with another tension than 1, which the file has no place
/// for.
PlainMesh to_plain(const mesh::Mesh& mesh);

/// Names are made up: "omega1", "inclusion1", "interface1".
std::shared_ptr<const mesh::Mesh> to_mesh(const PlainMesh& plain);

/// Load case `number` of plain_mesh.hpp on the nodes.
fem::Load nodal_load(const PlainMesh& plain, int number);

}  // namespace anticrack::benchmarks
