// SPDX-License-Identifier: GPL-3.0-or-later
//
// Uniform refinement into similar triangles.
#pragma once

#include "mesh/mesh.hpp"

namespace anticrack::mesh {

/// Every triangle becomes four of half its size and of its shape: the midpoints of its sides are
/// joined. The middle of a bent edge lies on its bend instead, unless a triangle would lose its
/// shape by that: then it and the parts of the edge stay on the chord. Nodes of the base keep their
/// numbers, triangle t becomes 4t to 4t + 3; interfaces and Dirichlet edges are cut with it. Throws
/// errors::Error (limit_exceeded) if the nodes could not be numbered. O(n + m).
Mesh refine_uniform(const Mesh& base);

}  // namespace anticrack::mesh
