// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <stop_token>
#include <vector>

#include "contact/adjoint.hpp"
#include "estimate/interval.hpp"
#include "operators/mesh_parts.hpp"

namespace anticrack::operators {

/// Whether u_h solves the discrete problem well enough for bounds, to 1e-10.
bool bounded(const contact::Answer& answer);

/// u in the copies of estimate::CutMesh.
std::vector<double> of_copies(const std::vector<contact::Field>& fields);

/// z and z' of each pair in the copies.
using AdjointFields = std::array<std::vector<double>, 2>;
std::vector<AdjointFields> adjoint_fields(const MeshOperator::Parts& parts,
                                          std::span<const contact::Adjoint::Pair> pairs);

/// An answer that has bounds of its energy.
struct Bounded {
  const LoadOnTraces& load;
  const estimate::Primal& primal;
  contact::Answer& answer;
  const std::stop_token& stop;
};

/// Bounds of A, and of the slopes where it tilts, of each inclusion that moves; none of more than
/// 16 inclusions. By estimate/interval.hpp, a few solves each. Where contact::Adjoint is not
/// possible, or not in the cone, from bounds of the energy, which are wider, O(h) instead of
/// O(h^2): three load cases each.
/// Several answers at once: bits are those of each alone.
void bound_displacements(const MeshOperator::Parts& parts, std::span<const Bounded> answers);

}  // namespace anticrack::operators
