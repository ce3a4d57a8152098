// SPDX-License-Identifier: GPL-3.0-or-later
//
// Uniform refinement into similar triangles.
#pragma once

#include "mesh/mesh.hpp"

namespace anticrack::mesh {

/// Every triangle becomes four of half its size and of its shape: the midpoints of its sides are
/// joined. Nodes of the base keep their numbers, triangle t becomes 4t to 4t + 3; interfaces and
/// Dirichlet edges are cut with it. Throws errors::Error (limit_exceeded) if the nodes could not be
/// numbered. O(n + m).
Mesh refine_uniform(const Mesh& base);

}  // namespace anticrack::mesh
