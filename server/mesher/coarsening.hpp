// SPDX-License-Identifier: GPL-3.0-or-later
//
// gmsh takes forty microseconds a triangle, halving one its fortieth part. So of a fine mesh gmsh
// makes a coarse one, whose triangles are then cut into similar ones.
#pragma once

#include "mesh/geometry.hpp"

namespace anticrack::mesher {

/// How often a coarse mesh of the plan is to be halved. As often as leaves gmsh a mesh fine enough
/// for its triangles to be in shape, and as gives hardly more triangles than meshing at once:
/// curves with edges shorter than others keep them, and those shorter than the coarse edges get
/// too short ones. 0 for plans of fewer than 40,000 triangles. O(c) for c curves.
int halvings(const mesh::Plan& plan);

/// The plan of the coarse mesh: halved as often, no curve has fewer intervals than in `plan`. O(c).
mesh::Plan coarsened(mesh::Plan plan, int halvings);

}  // namespace anticrack::mesher
