// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "operators/displacement_bounds.hpp"

namespace anticrack::operators {

/// Bounds the resultant of each part of the boundary that an answer has (BoundaryAnswer), or says
/// there why it has none: where u is given and no other part touches this one where u is given. As
/// the bounds of A, with z = 1 on the part in place of a unit force (estimate/interval.hpp,
/// THEORY.md). A few solves a part, whatever the contact. An answer that is stopped keeps what it
/// has.
void bound_resultants(const MeshOperator::Parts& parts, std::span<const Bounded> answers);

}  // namespace anticrack::operators
