// SPDX-License-Identifier: GPL-3.0-or-later
//
// The pairs that a mesh keeps for bounds of A: the identities behind them, exact for the solution
// of a finer mesh, and their norms, each against an integral. Containment alone would not show a
// term that is missing.
#include "estimate/mesh_dual.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "estimate/solved.hpp"
#include "operators/aims.hpp"
#include "operators/displacement_bounds.hpp"
#include "operators/load_bounds.hpp"
#include "reference/random_fibres.hpp"
#include "support/random_seed.hpp"

namespace anticrack::estimate {
namespace {

struct PairTally {
  int pairs = 0, jumping = 0, tilting = 0, passing = 0;
  double identity = 0, nearest = 1;
};

/// Integrals over the membrane with the fluxes in the norm of 1/T, D = (grad v - sigma / T) / 2.
struct PairIntegrals {
  double off = 0, mismatch = 0, norm = 0, d = 0, rho = 0;  ///< squares
  double product = 0;                                      ///< (tau - T grad z) . m
  double tau_d = 0, mismatch_d = 0;                        ///< tau . D, (tau - T grad z') . D
};

struct Pair {
  std::vector<double> closed, open;  ///< z, z'
  const EquilibratedFlux& tau;
};

PairIntegrals integrals(const Nested& nested, const EquilibratedFlux& sigma, const Pair& pair) {
  const Solved &coarse = *nested.coarse, &fine = *nested.fine;
  PairIntegrals sum;
  integrate(nested, [&](std::size_t t, std::size_t in, const auto& place, double weight) {
    const double tension = fine.tension(t);
    const Vector of_u = fine.gradient(t, fine.u), of_v = coarse.gradient(in, coarse.u),
                 of_z = coarse.gradient(in, pair.closed), of_open = coarse.gradient(in, pair.open),
                 off = sigma.difference(in, place), of_tau = pair.tau.difference(in, place);
    for (std::size_t k = 0; k < 2; ++k) {
      const double tau = of_tau[k] + tension * of_open[k], dual = tau - tension * of_z[k],
                   d = -off[k] / tension / 2, m = of_u[k] - of_v[k] + d;
      sum.off += weight * dual * dual / tension;
      sum.mismatch += weight * of_tau[k] * of_tau[k] / tension;
      sum.norm += weight * tau * tau / tension;
      sum.d += weight * tension * d * d;
      sum.product += weight * dual * m;
      sum.tau_d += weight * tau * d;
      sum.mismatch_d += weight * of_tau[k] * d;
    }
  });
  return sum;
}

void check_pairs(unsigned seed, bool rich, double decades, PairTally& tally) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  const Nested nested(seed, rich, decades);
  if (!nested.solved() || !nested.coarse->cut.obstacle.empty()) return;
  const Solved &coarse = *nested.coarse, &fine = *nested.fine;
  const EquilibratedFlux sigma(coarse.cut, coarse.balance());
  LoadBalance load;
  load.force = coarse.force;
  load.traction = coarse.traction;
  load.oscillation.assign(coarse.cut.triangle_count(), 0.0);
  const std::vector<Lift> none;
  const Primal primal{coarse.cut, sigma, load, none, coarse.u};
  const contact::ContactProblem& problem = *coarse.parts.contact;
  const std::size_t inclusions = coarse.answer.inclusions.size();
  for (std::size_t j = 0; j < inclusions; ++j) {
    const ddm::Terms& aim = coarse.parts.decomposition.skeleton.motions[j].displacement;
    const contact::UnitForce force = problem.unit_force(aim);
    const contact::Opened opened = std::move(problem.solve_open({}, {&force.r, 1}).front());
    if (!opened.solved || !(force.compliance > 1e-9)) continue;
    const contact::Displaced both[] = {{&aim, Eigen::VectorXd::Zero(opened.d.size())},
                                       {&aim, opened.d}};
    const std::vector<std::vector<double>> fields = problem.fields_of(both);
    const double compliance[] = {force.compliance};
    std::vector<std::vector<ForceOn>> unit{std::vector<ForceOn>(inclusions)};
    unit[0][j].force = 1;
    const MeshDual dual = mesh_duals(coarse.cut, {&fields[1], 1}, compliance, unit).front();
    const std::vector<double> nothing(2 * coarse.cut.faces.size(), 0.0);
    const EquilibratedFlux tau(coarse.cut, {fields[1], {}, {}}, {nothing, nothing}, 0);
    const PairIntegrals of = integrals(nested, sigma, {fields[0], fields[1], tau});

    double change = 0, dual_change = 0, primal_change = 0, work = 0, passed = 0;
    for (std::size_t f = 0; f < coarse.cut.faces.size(); ++f) {
      const Face& face = coarse.cut.faces[f];
      if (!presses(face.condition)) continue;
      const double* w = &sigma.through_faces()[2 * f];
      const double of_z = coarse.jump(fields[1], face, 0) - coarse.jump(fields[1], face, 1);
      change += (w[0] - w[1]) * of_z / 4;
      dual_change += of_z * of_z;
      primal_change += (w[0] - w[1]) * (w[0] - w[1]);
      for (const std::size_t end : {0U, 1U}) passed += std::abs(tau.through_faces()[2 * f + end]);
      work -= (w[0] + w[1]) * (coarse.jump(coarse.u, face, 0) + coarse.jump(coarse.u, face, 1)) / 2;
    }
    const double truth = fine.answer.inclusions[j].displacement_mesh,
                 value = coarse.answer.inclusions[j].displacement_mesh,
                 size = std::abs(truth) + std::sqrt(of.norm * sigma.norm_squared());
    // Crossing cracks that tie their sides carry a force there, which widens the bounds.
    if (passed > 1e-9) {
      ++tally.passing;
      EXPECT_LE(std::abs(truth - value),
                half_width(dual, primal_norms(
                                     primal, bracket(coarse.cut, sigma, load, none, coarse.u, 0))) +
                    1e-11 * size);
      continue;
    }
    for (const auto& [left, right] : {std::pair{truth, value + of.product - of.tau_d},
                                      std::pair{of.tau_d, of.mismatch_d - change}}) {
      tally.identity = std::max(tally.identity, std::abs(left - right) / size);
      EXPECT_NEAR(left, right, 1e-8 * size);
    }
    // Of `off` a part of 1e-6 of the square of `norm` is room for rounding.
    EXPECT_NEAR(dual.off * dual.off, of.off, 2e-6 * of.norm);
    EXPECT_GE(dual.off * dual.off, of.off);
    const double rounding = decades == 0 ? 1e-8 : 1e-4;
    for (const auto& [bound, square] :
         {std::pair{dual.norm, of.norm}, std::pair{dual.mismatch, of.mismatch}})
      EXPECT_NEAR(bound * bound, square, rounding * of.norm);
    EXPECT_NEAR(dual.change * dual.change, dual_change, 1e-8 * dual_change);

    // Loads that are balanced but for a part, of which each triangle has as much.
    for (const double rest : {0.0, 0.3}) {
      const double count = static_cast<double>(coarse.cut.triangle_count()),
                   scale = std::sqrt(of.d / count);
      for (double& one : load.oscillation) one = rest * scale;
      const Bracket bracketed =
          bracket(coarse.cut, sigma, load, none, coarse.u, coarse.answer.energy_mesh);
      const PrimalNorms norms = primal_norms(primal, bracketed);
      const double half = half_width(dual, norms), o = rest * scale * std::sqrt(count);
      double eta = 0;
      for (const double one : sigma.distance()) eta += std::pow(std::sqrt(one) + rest * scale, 2);
      if (rest == 0) {
        EXPECT_NEAR(eta, 4 * of.d, 1e-9 * eta);
      }
      const double whole = std::sqrt(of.off) * (std::sqrt(eta / 4 + work) + o / 2) +
                           std::sqrt(of.mismatch * eta) / 2 +
                           std::sqrt(dual_change * primal_change) / 4 +
                           std::sqrt(force.compliance) * o;
      const double room = std::sqrt(2e-6 * of.norm * (eta + work)) + 1e-6 * size;
      EXPECT_NEAR(half, whole, room);
      EXPECT_LE(std::abs(truth - value), half + 1e-11 * size);
      tally.nearest = std::min(tally.nearest, 1 - std::abs(truth - value) / (half + 1e-11 * size));
    }
    ++tally.pairs;
    tally.jumping += dual_change > 0 ? 1 : 0;
    tally.tilting += coarse.cut.tilts[j] != 0 ? 1 : 0;
  }
}

/// On membranes with many inclusions: all displacements of a mesh twice as fine are within.
void check_fibres(unsigned seed, PairTally& tally) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  reference::RandomFibres fibres(seed);
  const mesh::Mesh& mesh = fibres.mesh();
  std::vector<double> force, finer_force;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) force.push_back(fibres.uniform(-1, 1));
  for (const double one : force) finer_force.insert(finer_force.end(), 4, one);
  fem::Load load;
  load.name = "random";
  load.boundary_value = std::to_string(fibres.uniform(-1, 1)) + "*x - 0.4*y" + kink(mesh);
  for (const std::string& name : mesh.inclusions)
    load.inclusion_forces[name] = fibres.uniform(-3, 3);
  std::optional<Solved> coarse, fine;
  try {
    coarse.emplace(mesh, load, force);
    fine.emplace(mesh::refine_uniform(mesh), load, finer_force);
  } catch (const errors::Error&) {  // no solution
    return;
  }
  if (!coarse->cut.obstacle.empty() || !std::isfinite(coarse->cut.ways.triangle)) return;
  const operators::BalancedLoad balanced =
      operators::balanced(coarse->load.parts, coarse->parts.decomposition.subdomains, coarse->cut);
  const std::vector<Lift> of_boundary = lifts(coarse->cut, balanced.boundary, coarse->u);
  const EquilibratedFlux sigma(coarse->cut,
                               {coarse->u, balanced.balance.force, balanced.balance.traction});
  const Primal primal{
      coarse->cut,      sigma,
      balanced.balance, of_boundary,
      coarse->u,        operators::lack_of(coarse->cut, sigma, balanced.balance, coarse->load)};
  const PrimalNorms norms =
      primal_norms(primal, bracket(coarse->cut, sigma, balanced.balance, of_boundary, coarse->u,
                                   coarse->answer.energy_mesh, primal.lack.flux));
  EXPECT_GT(norms.lift, 0);
  PrimalNorms linear = norms;
  linear.lift = 0;
  const operators::MeshOperator::Parts joined(coarse->mesh, 1, 0);
  const std::vector<operators::Aim> goals = operators::aims(coarse->parts);
  const std::vector<MeshDual>&duals = operators::mesh_duals(coarse->parts, coarse->cut, goals),
        &same = operators::mesh_duals(joined, coarse->cut, goals);
  for (std::size_t k = 0; k < goals.size(); ++k) {
    const double off =
                     std::abs(goals[k].value_in(fine->answer) - goals[k].value_in(coarse->answer)),
                 half = half_width(duals[k], norms), rounding = 1e-9 * (1 + off);
    EXPECT_LE(off, half + rounding);
    EXPECT_NEAR(half - half_width(duals[k], linear),
                norms.lift * (duals[k].closed + duals[k].open / 2), 1e-9 * half);
    EXPECT_NEAR(duals[k].off, same[k].off, 1e-5 * (duals[k].norm + duals[k].off));
    EXPECT_NEAR(duals[k].norm, same[k].norm, 1e-5 * duals[k].norm);
    tally.nearest = std::min(tally.nearest, 1 - off / (half + rounding));
    ++tally.pairs;
  }
}

TEST(MeshDuals, HoldTheDisplacementsOfManyFibres) {
  PairTally tally;
  for (unsigned seed = 1; seed <= 12; ++seed) check_fibres(seed, tally);
  std::printf("[ figures  ] %d pairs, nearest %.2f\n", tally.pairs, tally.nearest);
  EXPECT_GT(tally.pairs, 100);
}

struct PairKind {
  const char* name;
  bool rich;
  double decades;
  unsigned seeds;
};
class NestedMeshDuals : public ::testing::TestWithParam<PairKind> {};

TEST_P(NestedMeshDuals, HaveTheNormsOfTheirIntegrals) {
  const unsigned first = testing::random_seed();
  PairTally tally;
  for (unsigned k = 0; k < GetParam().seeds; ++k)
    check_pairs(first + k, GetParam().rich, GetParam().decades, tally);
  std::printf(
      "[ figures  ] seeds from %u: %d pairs (%d that jump, %d that tilt), identities to %.1e, "
      "nearest %.2f; %d whose flux passes contacts\n",
      first, tally.pairs, tally.jumping, tally.tilting, tally.identity, tally.nearest,
      tally.passing);
  EXPECT_GT(tally.jumping, 20);
}

INSTANTIATE_TEST_SUITE_P(Random, NestedMeshDuals,
                         ::testing::Values(PairKind{"Plain", false, 0, 40},
                                           PairKind{"Rich", true, 0, 40},
                                           PairKind{"Contrast", true, 16, 40}),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace anticrack::estimate
