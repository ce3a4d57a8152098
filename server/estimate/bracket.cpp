// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/bracket.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/at.hpp"

namespace anticrack::estimate {

Bracket bracket(const CutMesh& cut, const EquilibratedFlux& flux, double energy,
                std::span<const double> oscillation) {
  Bracket result;
  result.indicator = flux.distance();
  double squared = 0, work = 0;
  for (std::size_t t = 0; t < result.indicator.size(); ++t) {
    double& one = result.indicator[t];
    one = std::max(0.0, one);
    if (!oscillation.empty() && oscillation[t] > 0) {
      const double size = std::sqrt(one) + oscillation[t];
      one = size * size;
    }
    squared += one;
  }
  const std::vector<double> work_of_face = flux.work_of_pressure();
  for (std::size_t face = 0; face < work_of_face.size(); ++face) {
    if (work_of_face[face] == 0) continue;
    work += work_of_face[face];
    result.indicator[at(cut.faces[face].side / 3)] += 2 * std::max(0.0, work_of_face[face]);
  }
  work = std::max(0.0, work);
  // No interval arithmetic: rounding is some 1e-14.
  const double rounding = 1e-12 * (std::abs(energy) + flux.norm_squared());
  result.lower = energy - 0.5 * squared - work - rounding;
  result.upper = energy + rounding;
  result.error = 0.5 * (std::sqrt(squared) + std::sqrt(squared + 4 * work + 4 * rounding));
  result.error_relative = result.error > 0 ? result.error / std::sqrt(flux.norm_squared()) : 0;
  return result;
}

}  // namespace anticrack::estimate
