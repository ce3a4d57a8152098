// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/bracket.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

/// Sums over all edges of one triangle on the boundary.
struct OnTriangle {
  double norm = 0;        ///< >= |w| in the energy norm
  double difference = 0;  ///< int (sigma - T grad u_h) . grad w
  double energy = 0;      ///< Pi(u_h + w) - Pi(u_h) - |w|^2 / 2
};

struct TriangleSums {
  /// eta^2 / 2; if T is known, without |w|^2 / 2, which cancels in Pi(v).
  double half_distance = 0;
  double squared = 0;  ///< eta^2
  double lift_energy = 0, lift_norm = 0, upper = 0, unknown = 0;

  void operator+=(const TriangleSums& by) {
    half_distance += by.half_distance;
    squared += by.squared;
    lift_energy += by.lift_energy;
    lift_norm += by.lift_norm;
    upper += by.upper;
    unknown += by.unknown;
  }
};

/// Triangles that are summed together.
constexpr std::size_t summed_together = 8192;

}  // namespace

LiftIntegrals integrals_of(const CutMesh& cut, const EquilibratedFlux& flux,
                           const LoadBalance& load, const Lift& lift, std::span<const double> u) {
  LiftIntegrals to;
  const auto side = at(cut.faces[at(lift.face)].side);
  const std::size_t t = side / 3, i = side % 3;
  to.norm = std::sqrt(flux.tension(t) * lift.gradient_squared);
  const double* force = &load.force[3 * t];
  const double sum = force[0] + force[1] + force[2];
  const auto value = [&](std::size_t corner) { return 12 * (force[corner % 3] - sum / 4); };
  to.work = 0.5 * (value(i + 1) * (lift.mean - lift.first) + value(i + 2) * lift.first) +
            value(i) * lift.mean / 6;
  to.product = lift.mean * flux.flux_through(side, u);
  const double* through = &flux.through_faces()[2 * at(lift.face)];
  to.through = (through[0] + through[1]) * lift.mean;
  to.unknown = lift.unknown *
               (0.5 * (std::abs(value(i + 1)) + std::abs(value(i + 2))) + std::abs(value(i)) / 6 +
                std::abs(flux.flux_through(side, u)) + std::abs(through[0]) + std::abs(through[1]));
  return to;
}

bool in_range(double tension, double largest) noexcept {
  const double squared = tension * largest * largest;
  return largest == 0 || (squared >= 1e-250 && squared <= 1e280);
}

double rounding_of(double energy, double norm_squared, double tension, double largest) noexcept {
  return 1e-12 * (std::abs(energy) + norm_squared) + 1e-13 * tension * largest * largest;
}

Bracket bracket(const CutMesh& cut, const EquilibratedFlux& flux, const LoadBalance& load,
                const std::vector<Lift>& lifts, std::span<const double> u, double energy,
                double lack) {
  std::vector<OnTriangle> lifted;
  if (!lifts.empty()) lifted.resize(cut.triangle_count());
  double unknown = 0;
  for (const Lift& lift : lifts) {
    const LiftIntegrals one = integrals_of(cut, flux, load, lift, u);
    OnTriangle& all = lifted[at(cut.faces[at(lift.face)].side / 3)];
    all.norm += one.norm;
    all.difference += one.difference();
    all.energy += one.product - one.work;
    unknown += 2 * one.unknown;  // once for each of them
  }

  Bracket result;
  result.indicator.resize(cut.triangle_count());
  const bool varies = !cut.shapes.variation.empty();
  const auto sum_to = [&](std::size_t t, TriangleSums& sums) {
    double& one = result.indicator[t];
    one = std::max(0.0, flux.distance()[t]);
    const double oscillation = load.oscillation.empty() ? 0 : load.oscillation[t];
    const fem::Variation of = varies ? cut.shapes.variation[t] : fem::Variation();
    const double own = varies ? flux.energy_of(t, u) : 0, spread = of.spread * std::sqrt(own);
    sums.unknown += of.unknown * own;
    if (lifted.empty()) {
      if (varies || oscillation > 0) {
        const double size = of.below * std::sqrt(one) + spread + oscillation;
        one = size * size;
      }
      sums.half_distance += 0.5 * one;
      sums.squared += one;
      return;
    }
    const OnTriangle& w = lifted[t];
    const double distance = std::max(0.0, one - 2 * w.difference + w.norm * w.norm);
    const double rest = oscillation * (j_11 / std::numbers::pi * w.norm);  // error of int f w
    const double norm = of.above * w.norm, beyond = spread * norm + rest;  // of int T grad u.grad w
    const double size = of.below * std::sqrt(distance) + spread + of.most() * w.norm + oscillation;
    sums.half_distance += 0.5 * size * size + beyond + rest;
    if (!varies) sums.half_distance -= 0.5 * norm * norm;
    sums.lift_energy += w.energy;
    sums.upper += 0.5 * norm * norm + beyond;
    sums.lift_norm += norm * norm;
    one = size * size;
    sums.squared += one;
  };
  std::vector<TriangleSums> parts((result.indicator.size() + summed_together - 1) /
                                  summed_together);
  base::at_once(parts.size(), base::Threads::allowed(), [&] {
    return [&](std::size_t part) {
      stop::look("computing bounds of the energy");
      const std::size_t end = std::min(result.indicator.size(), (part + 1) * summed_together);
      for (std::size_t t = part * summed_together; t < end; ++t) sum_to(t, parts[part]);
    };
  });
  TriangleSums sums{.unknown = unknown};
  for (const TriangleSums& part : parts) sums += part;
  const std::vector<double> work_of_face = flux.work_of_pressure();
  for (std::size_t face = 0; face < work_of_face.size(); ++face) {
    if (!(work_of_face[face] > 0)) continue;
    result.work += work_of_face[face];
    result.indicator[at(cut.faces[face].side / 3)] += 2 * work_of_face[face];
  }
  result.distance = std::sqrt(sums.squared) + lack;
  sums.half_distance += lack * (std::sqrt(sums.squared) + lack / 2);
  const double rounding =
      rounding_of(energy, flux.norm_squared(), cut.shapes.largest_tension, largest_of(u)) +
      sums.unknown;  // means of T are less accurate
  result.lower = energy + sums.lift_energy - sums.half_distance - result.work - rounding;
  result.upper = energy + sums.lift_energy + sums.upper + rounding;
  result.error =
      0.5 * (result.distance + std::sqrt(result.distance * result.distance + 4 * result.work)) +
      std::sqrt(sums.lift_norm);
  result.error_relative = result.error > 0 ? result.error / std::sqrt(flux.norm_squared()) : 0;
  return result;
}

}  // namespace anticrack::estimate
