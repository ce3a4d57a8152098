// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds parts of the membrane that could move as a whole, which makes matrices singular.
#pragma once

#include "ddm/decomposition.hpp"

namespace anticrack::ddm {

/// Sets Subdomain::floating. O(n). Throws errors::Error: mesh_invalid for a part with neither
/// Dirichlet nor interface nodes; numerical for a part that no chain of tied sides joins to a
/// Dirichlet node.
void find_floating_parts(Decomposition& decomposition);

}  // namespace anticrack::ddm
