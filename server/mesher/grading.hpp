// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bisection of the base mesh, towards the tips or everywhere.
#pragma once

#include <cstddef>

#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesher {

/// The base graded towards its tips, with `bisection_bound` set; unchanged if spec.h0 is 0. The
/// default exponent m becomes less where tensions differ at the end of a delaminated inclusion, so
/// that it stays below the exponent of the solution there (tips::least_exponent).
/// tip_size = 0 means mesh::smallest_tip_size, or more if the bound is below 10 degrees: the
/// shortest side of such a triangle would be lost in rounding. Throws errors::Error:
/// invalid_argument at "options.size", "options.grading" or "options.tip_size"; limit_exceeded at
/// "options.size" (and "options.tip_size" if a coarser tip helps); internal if an angle is below
/// the bound. Costs as mesh::grade.
mesh::Mesh graded(mesh::Mesh base, const mesh::GradingSpec& spec, std::size_t max_triangles);

/// The same for the options of an upload. Preset graded with size 0: h0 is the longest edge of the
/// base. Preset uniform bisects until no edge is longer than the size; size 0: not at all.
mesh::Mesh graded(mesh::Mesh base, const mesh::MeshOptions& options, std::size_t max_triangles);

}  // namespace anticrack::mesher
