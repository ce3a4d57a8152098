// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inclusions that share nodes are one rigid body.
#pragma once

#include <string>
#include <vector>

#include "base/union_find.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesh {

/// The inclusions, those of one body in one set. O(k) for k interface edges.
base::UnionFind join_inclusions(const Mesh& mesh);

/// (inclusions) Why one that is to tilt (Motion::tilt) does not, with the cure; empty: it does, or
/// is not to. A body tilts if all its inclusions do. O(k).
std::vector<std::string> why_none_tilts(const Mesh& mesh);

}  // namespace anticrack::mesh
