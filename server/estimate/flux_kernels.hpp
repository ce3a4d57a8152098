// SPDX-License-Identifier: GPL-3.0-or-later
//
// The loops of EquilibratedFlux, for one load or several at once, compiled for several instruction
// sets (flux_loops.hpp). The bits of a load depend neither on the other loads nor on the processor,
// since all versions do the same operations in the same order, and none is fused.
#pragma once

#include <cstddef>
#include <cstdint>

#include "estimate/cut_mesh.hpp"

namespace anticrack::estimate {

/// Loads at once; more are not faster, as their data exceed the cache.
constexpr std::size_t flux_lanes = 4;

/// The data of a CutMesh that the loops need.
struct FluxMesh {
  std::size_t largest_fan;
  const std::int32_t *copy, *first_corner, *first_stop;
  const double *edge, *tension, *softness;  // edge: (corners, 2)
  const FanCorner* around;
  const std::int32_t *met, *met_until;
  const Stop* stops;
  const Face* face;
  /// Called every `flux_turn` triangles or fans; throws if the work is to end.
  void (*look)();
};

constexpr std::size_t flux_turn = 8192;

/// The arrays of one load; null traction or force means 0.
struct FluxLane {
  const double* force;
  const double* traction;
  const double *least, *most;  ///< of w on minus faces; null: w <= 0
  double* distance;            ///< (triangles) int |sigma - T grad u|^2 / T; null: not wanted
};

/// Triangles and fans of a block of CutMesh, and what the step `build` finds for each lane. Blocks
/// with triangles share none, and may be worked on at once; the last block, which has none, comes
/// after them in each step.
struct FluxBlock {
  std::size_t first_triangle, last_triangle, first_fan, last_fan;
  double norm_squared[flux_lanes] = {};
  double imbalance[flux_lanes] = {};
};

/// Arrays of the loops, entries of the lanes side by side.
struct FluxScratch {
  const double* u;  ///< (copies)
  double* mean;     ///< (triangles, 2) of sigma - T grad u, times sqrt(area / T)
  double* through;  ///< (faces, 2)
  double* own;      ///< flux_scratch() a lane, for each thread
};

constexpr std::size_t flux_scratch(const FluxMesh& mesh, std::size_t triangles_of_a_block) {
  return 6 * triangles_of_a_block + mesh.largest_fan + 1;
}

/// The steps, in their order; `polish` may be repeated.
enum class FluxStep : std::uint8_t { build, polish, finish };

/// All lanes have a force or none has; the same holds for bounds.
using FluxLoop = void (*)(const FluxMesh& mesh, FluxLane* lanes, FluxStep step, FluxBlock& block,
                          const FluxScratch& scratch);

struct FluxKernels {
  FluxLoop one, two, several;  ///< for 1 lane, 2, and `flux_lanes`
};

/// The kernels that this processor supports: rank 0 is the best; null beyond the last.
const FluxKernels* supported_flux_kernels(int rank) noexcept;

}  // namespace anticrack::estimate
