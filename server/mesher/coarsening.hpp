// SPDX-License-Identifier: GPL-3.0-or-later
//
// gmsh takes forty microseconds a triangle, halving a fortieth of that. So for a fine mesh gmsh
// makes a coarse one, whose triangles are then cut into similar ones.
#pragma once

#include "mesh/geometry.hpp"

namespace anticrack::mesher {

/// How often a coarse mesh of the plan is to be halved. The coarse mesh must be fine enough for
/// good shapes, and the result must have hardly more triangles than meshing at once: curves with
/// edges shorter than others keep them in the coarse mesh, and curves shorter than the coarse edges
/// end with edges that are too short. Chords of one bend count as one curve. 0 for plans of fewer
/// than 40,000 triangles. O(c) for c curves.
int halvings(const mesh::Plan& plan);

/// The plan of the coarse mesh; once halved, no curve has fewer intervals than in `plan`. Chords of
/// a bend become longer ones, whose middles halving puts on the bend. O(c).
mesh::Plan coarsened(mesh::Plan plan, int halvings);

}  // namespace anticrack::mesher
