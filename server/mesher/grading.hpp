// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the mesh options ask for beyond the base mesh: bisection, towards the tips or everywhere.
#pragma once

#include <cstddef>

#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesher {

/// The base graded towards its tips; as it is where spec.h0 is 0. The result has its
/// `bisection_bound`.
///
/// tip_size = 0 goes down to mesh::smallest_tip_size, not so far where the bound is below 10
/// degrees: the shortest side of such a triangle would be lost in the rounding of coordinates.
///
/// Throws errors::Error: invalid_argument at "options.size", "options.grading" or
/// "options.tip_size"; limit_exceeded at "options.size" (and "options.tip_size", where a coarser
/// tip would do); internal if an angle is below the bound. Complexity: that of mesh::grade.
mesh::Mesh graded(mesh::Mesh base, const mesh::GradingSpec& spec, std::size_t max_triangles);

/// The same as an upload's options ask for it: preset graded with size 0 takes the longest edge of
/// the base for h0; preset uniform with a size bisects until no edge is longer, without one it
/// leaves the base as it is.
mesh::Mesh graded(mesh::Mesh base, const mesh::MeshOptions& options, std::size_t max_triangles);

}  // namespace anticrack::mesher
