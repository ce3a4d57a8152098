// SPDX-License-Identifier: GPL-3.0-or-later
//
// What holds the membrane: a part that could move as a whole makes a matrix singular.
#pragma once

#include "ddm/decomposition.hpp"

namespace anticrack::ddm {

/// Sets Subdomain::floating. Throws errors::Error: mesh_invalid for a part with neither Dirichlet
/// nor interface nodes; numerical for one that no chain of tied sides joins to a Dirichlet node,
/// for contact pushes but does not hold. O(n).
void find_floating_parts(Decomposition& decomposition);

}  // namespace anticrack::ddm
