// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include "estimate/interval.hpp"
#include "operators/mesh_parts.hpp"

namespace anticrack::operators {

/// Whether u_h solves the discrete problem well enough for bounds: what is left widens them where
/// estimate::Ways lead out of the membrane; elsewhere it has to be 1e-10 and is taken for rounding.
bool bounded(const contact::Answer& answer, const estimate::CutMesh& cut);

/// What is left; nothing is known of it, and 0 given, where Ways lead nowhere.
estimate::Lack lack_of(const estimate::CutMesh& cut, const estimate::EquilibratedFlux& flux,
                       const estimate::LoadBalance& balance, const LoadOnTraces& load);

/// u in the copies of estimate::CutMesh.
std::vector<double> of_copies(const std::vector<contact::Field>& fields);

/// An answer that has bounds of its energy.
struct Bounded {
  const LoadOnTraces& load;
  const estimate::Primal& primal;
  contact::Answer& answer;
  const std::stop_token& stop;
};

/// Bounds of A, and of the slopes where it tilts, of each inclusion that moves. By
/// estimate/interval.hpp, a few solves each, O(h^2) wide. Where contact::Adjoint is not possible,
/// or not in the cone, from bounds of the energy, O(h): three load cases each. Of more than 16
/// inclusions from the error bound and a norm that the mesh keeps, O(h) as well; of very many on
/// very many triangles none, and a warning.
/// Several answers at once: bits are those of each alone. One that is stopped keeps what it has.
void bound_displacements(const MeshOperator::Parts& parts, std::span<const Bounded> answers);

}  // namespace anticrack::operators
