// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/mesh_dual.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "estimate/flux_kernels.hpp"

namespace anticrack::estimate {
namespace {

/// The largest of each over all triangles.
fem::Variation largest_variation(const Shapes& shapes) {
  fem::Variation largest;
  for (const fem::Variation& one : shapes.variation) {
    largest.below = std::max(largest.below, one.below);
    largest.above = std::max(largest.above, one.above);
    largest.spread = std::max(largest.spread, one.spread);
    largest.unknown = std::max(largest.unknown, one.unknown);
  }
  return largest;
}

MeshDual mesh_dual(const CutMesh& cut, const EquilibratedFlux& tau, std::span<const double> open,
                   double closed, std::span<const ForceOn> unit) {
  constexpr double rounding = 1e-6;  // of what the factors gave; it changes no digit of `off`
  MeshDual dual;
  dual.largest = largest_of(open);
  double squared = 0, through = 0, distance = 0;
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    if (!presses(cut.faces[f].condition)) continue;
    const double change = tau.jump(f, 0) - tau.jump(f, 1);
    squared += change * change;
    for (const std::size_t end : {0, 1}) through += std::abs(tau.through_faces()[2 * f + end]);
  }
  for (const double one : tau.distance()) distance += std::max(0.0, one);
  const std::vector<double> nothing(cut.faces.size(), 0);
  const Lack found = lack_of(cut, tau, {}, unit, nothing);
  const Lack lack = std::isfinite(found.flux) ? found : Lack();
  const fem::Variation variation = largest_variation(cut.shapes);
  dual.change = std::sqrt(squared);
  dual.open = std::sqrt(tau.norm_squared()) * (1 + variation.unknown);
  dual.closed = std::sqrt(std::max(0.0, closed)) * (1 + variation.unknown);
  // A(z') and the integrals of tau with grad z' and grad z are wrong by what tau lacks.
  const double lacking = (lack.work + 2 * through) * dual.largest;
  const double energy = tau.norm_squared() + 2 * lacking + 2 * lack.flux * dual.open;
  const double off = distance + energy - closed + 2 * lack.flux * dual.closed + rounding * energy;
  dual.norm = variation.below * std::sqrt(distance + energy) + lack.flux;
  dual.mismatch = variation.below * std::sqrt(distance) + variation.spread * dual.open + lack.flux;
  dual.off =
      variation.below * std::sqrt(std::max(0.0, off)) + variation.spread * dual.closed + lack.flux;
  return dual;
}

}  // namespace

std::vector<MeshDual> mesh_duals(const CutMesh& cut, std::span<const std::vector<double>> open,
                                 std::span<const double> closed,
                                 std::span<const std::vector<ForceOn>> units) {
  const std::vector<double> none(2 * cut.faces.size(), 0.0);
  const std::vector<FaceBounds> bounds(flux_lanes, FaceBounds{none, none});
  std::vector<MeshDual> duals(open.size());
  for (std::size_t first = 0; first < open.size(); first += flux_lanes) {
    std::vector<Balance> balances;
    std::vector<std::size_t> of;
    for (std::size_t i = first; i < std::min(first + flux_lanes, open.size()); ++i) {
      if (open[i].empty()) continue;
      balances.push_back({open[i], {}, {}});
      of.push_back(i);
    }
    constexpr int polish = 0;  // a sweep would take 3 % off the mismatch, 1 % off the bounds
    const std::vector<EquilibratedFlux> taus =
        EquilibratedFlux::of_all(cut, balances, bounds, polish);
    for (std::size_t k = 0; k < of.size(); ++k)
      duals[of[k]] = mesh_dual(cut, taus[k], open[of[k]], closed[of[k]], units[of[k]]);
  }
  return duals;
}

PrimalNorms primal_norms(const Primal& primal, const Bracket& bracket) {
  const CutMesh& cut = primal.cut;
  const fem::Variation variation = largest_variation(cut.shapes);
  PrimalNorms of{bracket.distance, bracket.work};
  for (const double o : primal.load.oscillation) of.rest += o * o;
  of.rest = std::sqrt(of.rest);
  for (const Lift& lift : primal.lifts)  // no more than three in a triangle
    of.lift +=
        3 * primal.flux.tension(at(cut.faces[at(lift.face)].side / 3)) * lift.gradient_squared;
  of.lift = variation.above * std::sqrt(of.lift);
  of.unknown = variation.unknown * std::sqrt(primal.flux.norm_squared());
  if (std::isfinite(cut.ways.triangle)) {
    of.residual = primal.lack.work;
    of.way = cut.ways.triangle;
  }
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    if (!presses(cut.faces[f].condition)) continue;
    const double* w = &primal.flux.through_faces()[2 * f];
    of.change += (w[0] - w[1]) * (w[0] - w[1]);
    of.pulling += std::max(0.0, w[0] + w[1]);
  }
  of.change = std::sqrt(of.change);
  return of;
}

double half_width(const MeshDual& dual, const PrimalNorms& of) {
  if (!std::isfinite(dual.norm)) return dual.norm;
  const double rho = of.rest / 2 + std::sqrt(of.distance * of.distance / 4 + of.work);
  const double beyond = of.lift + of.unknown;
  // A nodal value is three means over sides at most, each of which a way out bounds.
  const double of_closed = of.rest + beyond + 3 * of.way * of.residual;
  return dual.off * rho + dual.mismatch * of.distance / 2 + dual.closed * of_closed +
         dual.change * of.change / 4 + dual.largest * (of.pulling + of.residual / 2) +
         dual.open * beyond / 2;
}

}  // namespace anticrack::estimate
