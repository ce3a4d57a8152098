// SPDX-License-Identifier: GPL-3.0-or-later
//
// The loops of EquilibratedFlux, for one load or several at once, compiled for several instruction
// sets (flux_loops.hpp). The bits of a load depend neither on the others nor on the processor: all
// do the same operations in the same order, none fused.
#pragma once

#include <cstddef>
#include <cstdint>

#include "estimate/cut_mesh.hpp"

namespace anticrack::estimate {

/// Loads at once; more are not faster, as their numbers leave the cache.
constexpr std::size_t flux_lanes = 4;

/// What of a CutMesh the loops need.
struct FluxMesh {
  std::size_t triangles, fans, faces, largest_fan;
  const std::int32_t *copy, *first_corner, *first_stop;
  const double *edge, *tension, *softness;  // edge: (corners, 2)
  const FanCorner* around;
  const Stop* stops;
  const Face* face;
  /// Called each `flux_turn` triangles or fans; throws where the work is to end.
  void (*look)();
};

constexpr std::size_t flux_turn = 8192;

/// A load; no traction and no force: 0.
struct FluxLane {
  const double* u;
  const double* force;
  const double* traction;
  const double* bounds;  ///< none: the pressure
  double* mean;          ///< (triangles, 2) of sigma - T grad u, times sqrt(area / T)
  double* distance;      ///< (triangles) int |sigma - T grad u|^2 / T
  double* through;       ///< (faces, 2)
  double norm_squared;
  double imbalance;
};

/// All lanes have a force or none, bounds or none. `scratch`: scratch_of() doubles for each lane.
using FluxLoop = void (*)(const FluxMesh& mesh, FluxLane* lanes, int polish, double* scratch);

constexpr std::size_t scratch_of(const FluxMesh& mesh) {
  return 9 * mesh.triangles + 2 * mesh.faces + mesh.largest_fan + 1;
}

struct FluxKernels {
  FluxLoop one, several;  ///< 1 lane, `flux_lanes`
};

/// The versions that this processor supports, from 0, the best first; null beyond the last.
const FluxKernels* supported_flux_kernels(int rank) noexcept;

}  // namespace anticrack::estimate
