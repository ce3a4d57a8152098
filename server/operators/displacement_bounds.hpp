// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "estimate/bracket.hpp"
#include "estimate/interval.hpp"
#include "operators/mesh_parts.hpp"

namespace anticrack::operators {

/// Whether u_h solves the discrete problem well enough for bounds. Where estimate::Ways lead out of
/// the membrane, its residual widens the bounds; elsewhere the relative residuals must be at most
/// 1e-10 and are taken for rounding.
bool bounded(const contact::Answer& answer, const estimate::CutMesh& cut);

/// What the flux lacks of equilibrium; 0 where Ways lead nowhere, as nothing is known of it there.
estimate::Lack lack_of(const estimate::CutMesh& cut, const estimate::EquilibratedFlux& flux,
                       const estimate::LoadBalance& balance, const LoadOnTraces& load);

/// The forces of a load on each inclusion.
std::vector<estimate::ForceOn> forces_on(const LoadOnTraces& load);

/// u in the copies of estimate::CutMesh.
std::vector<double> of_copies(const std::vector<contact::Field>& fields);

/// An answer that has bounds of its energy.
struct Bounded {
  const LoadOnTraces& load;
  const estimate::Primal& primal;
  const estimate::Bracket& bracket;
  contact::Answer& answer;
  const std::stop_token& stop;
  // As MeshOperator::Estimate.
  bool closely = false;
  std::optional<bool> of_largest{};
  std::vector<double>* indicator = nullptr;
  std::span<const double> across_chords{};  ///< estimate::slopes_across_chords of g_D
};

/// Bounds A, and the slopes if it tilts, of each inclusion that moves. estimate/interval.hpp gives
/// bounds O(h^2) wide for a few solves each. If contact alone holds a part, or contact::Adjoint
/// leaves the cone, bounds of the energy give them, O(h) wide, for three load cases each. For more
/// than 16 inclusions on many triangles, pairs that the mesh keeps give them
/// (estimate/mesh_dual.hpp), O(h) wide too; for very many inclusions on very many triangles there
/// are none, but a warning. Takes several answers at once; the bits of each are as if it were
/// alone. An answer that is stopped keeps its bounds so far. Where the mesh has
/// chords, estimates what they do to A: by the adjoint, or where there is none as if chords changed
/// the energy of the unit force as much, for its size, as that of u.
void bound_displacements(const MeshOperator::Parts& parts, std::span<const Bounded> answers);

}  // namespace anticrack::operators
