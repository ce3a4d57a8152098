// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"

namespace anticrack::ddm {

/// The Neumann boundary: edges of one triangle that are not in Mesh::dirichlet, each as 3t + k when
/// it runs from corner k to corner k+1 of triangle t. O(m), memory 8 bytes an edge of a triangle.
std::vector<std::int32_t> free_boundary(const mesh::Mesh& mesh);

}  // namespace anticrack::ddm
