// SPDX-License-Identifier: GPL-3.0-or-later
//
// Identities behind bounds of the energy and of A, exact for the solution u of any finer mesh in
// place of the membrane's: containment alone would not show a wrong term. v is the solution of the
// coarse mesh, X = <p,[v]> + int p_s [u], m = grad u - (grad v + sigma/T)/2.
#include "estimate/interval.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "contact/adjoint.hpp"
#include "estimate/solved.hpp"
#include "operators/bound_search.hpp"
#include "support/random_seed.hpp"

namespace anticrack::estimate {
namespace {

/// Integrals over the fine membrane, of energies.
struct Energies {
  double error = 0;           ///< |u - v|^2
  double from_u = 0;          ///< |sigma - T grad u|^2
  double from_v = 0;          ///< |sigma - T grad v|^2
  double middle = 0;          ///< |m|^2
  double of_u = 0, of_v = 0;  ///< |u|^2, |v|^2
};

Energies energies(const Nested& nested, const EquilibratedFlux& sigma) {
  Energies sum;
  integrate(nested, [&](std::size_t t, std::size_t in, const auto& place, double weight) {
    const double tension = nested.fine->tension(t);
    const Vector own = nested.fine->gradient(t, nested.fine->u),
                 before = nested.coarse->gradient(in, nested.coarse->u),
                 off = sigma.difference(in, place);
    for (std::size_t d = 0; d < 2; ++d) {
      const double difference = own[d] - before[d], w = weight * tension;
      sum.error += w * difference * difference;
      sum.from_u += w * std::pow(off[d] / tension - difference, 2);
      sum.from_v += w * std::pow(off[d] / tension, 2);
      sum.middle += w * std::pow(difference - off[d] / tension / 2, 2);
      sum.of_u += w * own[d] * own[d];
      sum.of_v += w * before[d] * before[d];
    }
  });
  return sum;
}

struct Figures {
  int brackets = 0, intervals = 0, left = 0, pulled = 0;
  double energy = 0, displacement = 0, cone = 0, nearest = 1;
};

double sum_of(std::span<const double> values) {
  double sum = 0;
  for (const double one : values) sum += one;
  return sum;
}

/// A of the fine solution from the coarse one, its bounds' own middle and what bounds them. `rest`:
/// l(z) - a(v, z).
double displacement_from(const Nested& nested, const EquilibratedFlux& sigma,
                         const EquilibratedFlux& tau, const Dual& dual, const Bound& found,
                         double rest) {
  const Solved &coarse = *nested.coarse, &fine = *nested.fine;
  const std::vector<double> z(dual.z.begin(), dual.z.end()),
      reacting(dual.reacting.begin(), dual.reacting.end());
  double product = 0, pressure = -rest;  // <p,[z]> = a(u,z) - l(z)
  integrate(nested, [&](std::size_t t, std::size_t in, const auto& place, double weight) {
    const double tension = fine.tension(t);
    const Vector own = fine.gradient(t, fine.u), before = coarse.gradient(in, coarse.u),
                 of_z = coarse.gradient(in, z), of_reacting = coarse.gradient(in, reacting),
                 off = sigma.difference(in, place), off_tau = tau.difference(in, place);
    for (std::size_t d = 0; d < 2; ++d) {
      const double dual_off = off_tau[d] + tension * (of_reacting[d] - of_z[d]);
      product += weight * dual_off * (own[d] - before[d] - off[d] / tension / 2);
      pressure += weight * tension * (own[d] - before[d]) * of_z[d];
    }
  });
  return found.middle + product + pressure - work_of_pressure(nested, tau);
}

/// How far the jumps of z and the pressures of tau leave the cone of the bounds.
double outside_cone(const Solved& in, const EquilibratedFlux& sigma, const EquilibratedFlux& tau,
                    const Dual& dual, double c) {
  const double sign = dual.side == Side::upper ? 1 : -1;
  const std::vector<double> z(dual.z.begin(), dual.z.end());
  WeightOf weights(sigma, dual.weight);
  double jumps = 0, pressures = 0, largest_jump = 1e-12, largest_pressure = 1e-12;
  for (std::size_t f = 0; f < in.cut.faces.size(); ++f) {
    const Face& face = in.cut.faces[f];
    if (!presses(face.condition)) continue;
    const Weight::OnFace on = weights.on(f);
    for (const std::size_t end : {0U, 1U}) {
      const double of_z = in.jump(z, face, end), of_v = in.jump(in.u, face, end);
      jumps = std::max(jumps, sign * of_z - c * on.least * of_v);
      largest_jump = std::max(largest_jump, std::abs(of_z));
    }
    const auto pressure = [f](const EquilibratedFlux& flux) {
      return -flux.through_faces()[2 * f] - flux.through_faces()[2 * f + 1];
    };
    const double q = pressure(tau);
    pressures = std::max(pressures, -sign * q - c * (on.bound[0] + on.bound[1]));
    largest_pressure = std::max(largest_pressure, std::abs(q));
  }
  return std::max(jumps / std::max(1.0, largest_jump), pressures / std::max(1.0, largest_pressure));
}

void check_identities(unsigned seed, bool rich, double decades, Figures& tally) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  const Nested nested(seed, rich, decades);
  if (!nested.solved() || !nested.coarse->cut.obstacle.empty()) return;
  const Solved &coarse = *nested.coarse, &fine = *nested.fine;
  const EquilibratedFlux sigma(coarse.cut, coarse.balance());
  const Energies of = energies(nested, sigma);
  const double scale = std::abs(coarse.answer.energy) + sigma.norm_squared();

  // <p,[v]> = a(u, v - u) - l(v - u)
  const double x =
      coarse.answer.energy - fine.answer.energy - of.error / 2 + work_of_pressure(nested, sigma);
  const double pressure = sum_of(sigma.work_of_pressure());
  const double rho_squared = of.from_v / 4 + pressure;
  EXPECT_NEAR(of.from_v, sum_of(sigma.distance()), 1e-10 * scale);
  for (const auto& [left, right] :
       {std::pair{of.error + of.from_u + 2 * x, of.from_v + 2 * pressure},
        std::pair{of.middle + x, rho_squared}}) {
    EXPECT_NEAR(left, right, 1e-10 * scale);
    tally.energy = std::max(tally.energy, std::abs(left - right) / scale);
  }
  // z = a (u - v), tau = a (sigma - T grad u) of the functional 0: the worst that c = a allows.
  for (const double a : {0.1, 1.0, 10.0}) {
    const HalfWidth half{rho_squared, 0, a * a * of.middle};
    EXPECT_NEAR(half(a), a * (2 * of.middle + x), 1e-10 * a * scale);
  }
  ++tally.brackets;

  const contact::Adjoint adjoint(coarse.parts.contact->conditions(), coarse.answer.closed);
  LoadBalance load;
  load.force = coarse.force;
  load.traction = coarse.traction;
  const std::vector<Lift> none;
  const Primal primal{coarse.cut, sigma, load, none, coarse.u};
  const contact::ContactProblem& problem = *coarse.parts.contact;
  const Eigen::VectorXd load_on_contacts =
      problem
          .reduce(coarse.load.subdomains,
                  contact::held_values(coarse.parts.decomposition, coarse.load.subdomains), true)
          .r;
  const Eigen::VectorXd pulling =
      problem.solve_open(coarse.answer.closed, {&load_on_contacts, 1}).front().residual;
  for (std::size_t j = 0; j < coarse.answer.inclusions.size(); ++j) {
    const ddm::Terms& aim = coarse.parts.decomposition.skeleton.motions[j].displacement;
    const contact::UnitForce force = problem.unit_force(aim);
    const contact::Opened kept =
        std::move(problem.solve_open(coarse.answer.closed, {&force.r, 1}).front());
    const contact::Adjoint::Goal goal = adjoint.aim(force, kept);
    if (!kept.solved || !(goal.compliance > 1e-9)) continue;
    const double unit = std::sqrt(goal.compliance / std::max(scale, 1e-9));
    const double truth = fine.answer.inclusions[j].displacement;
    const double size = std::abs(truth) + std::sqrt(goal.compliance * scale);
    for (const double c : {0.5 * unit, 2 * unit, 16 * unit}) {
      for (const Side side : {Side::lower, Side::upper}) {
        const double sign = side == Side::upper ? 1 : -1;
        contact::Adjoint::Room room =
            operators::room_of(coarse.parts, primal, coarse.answer.closed);
        room.jumps *= c;
        room.forces *= c;
        const Eigen::VectorXd clipped = adjoint.load(goal, sign, room);
        const contact::Opened free = std::move(problem.solve_open({}, {&clipped, 1}).front());
        if (!free.solved) continue;
        contact::Displaced pair[] = {{&aim, adjoint.jumps(goal, sign, room)}, {&aim, free.d}};
        // On the other side of 0 jumps may be anything, also where contact is closed.
        if (c == 2 * unit && free.d.size() > 0 && problem.conditions().rows().empty())
          pair[0].d.array() -= sign * 0.1 * free.d.lpNorm<Eigen::Infinity>();
        const double rest = pulling.dot(pair[0].d);
        tally.pulled += std::abs(rest) > 1e-6 * size ? 1 : 0;
        const std::vector<std::vector<double>> fields = problem.fields_of(pair);
        const std::vector<double>&z = fields[0], &reacting = fields[1];
        std::vector<ForceOn> on_inclusions(coarse.answer.inclusions.size());
        on_inclusions[j].force = 1;
        Dual dual{z, reacting, coarse.answer.inclusions[j].displacement, side, c, on_inclusions};
        const auto bound_by = [&](const Dual& by) {
          const Aimed one{&primal, by};
          return bounds(coarse.cut, {&one, 1}).front();
        };
        const Bound found = bound_by(dual);
        tally.left += std::isfinite(found.value) ? 0 : 1;
        if (!std::isfinite(found.value)) continue;
        const EquilibratedFlux tau = dual_flux(primal, dual);
        const double from_coarse = displacement_from(nested, sigma, tau, dual, found, rest);
        tally.displacement = std::max(tally.displacement, std::abs(truth - from_coarse) / size);
        EXPECT_NEAR(truth, from_coarse, 1e-8 * size);  // rounding: 1.4e-9 in one of some 10,000
        const double outside = outside_cone(coarse, sigma, tau, dual, found.c);
        tally.cone = std::max(tally.cone, outside);
        EXPECT_LT(outside, 1e-10);
        // A bound is wider than the formula by its own rounding, which is of A(u_h) and the middle.
        const double rounding = 1e-11 * (size + std::abs(dual.value) + std::abs(found.middle)) +
                                (decades > 0 ? 1e-5 * found.half(found.c) : 0);
        EXPECT_NEAR(found.value, found.middle + sign * found.half(found.c), rounding);
        EXPECT_NEAR(found.half.primal, rho_squared, 1e-9 * scale);
        const double half = found.half(found.c);
        if (half > 1e-9)
          tally.nearest = std::min(tally.nearest, sign * (found.value - truth) / half);
        EXPECT_GT(sign * (found.value - truth), -1e-11 * size);
        // Jumps solved as well as on millions of triangles leave the cone, and bounds remain.
        Eigen::VectorXd jumps = free.d;
        const double z_size = Eigen::Map<const Eigen::VectorXd>(
                                  reacting.data(), static_cast<Eigen::Index>(reacting.size()))
                                  .lpNorm<Eigen::Infinity>();
        for (Eigen::Index i = 0; i < jumps.size(); ++i)
          jumps[i] += (i % 2 == 0 ? 1 : -1) * 3e-13 * z_size;
        const contact::Displaced rounded{&aim, jumps};
        const std::vector<double> near = problem.fields_of({&rounded, 1}).front();
        dual.reacting = near;
        const Bound wider = bound_by(dual);
        EXPECT_GT(sign * (wider.value - truth), -1e-11 * size);
        EXPECT_LT(sign * (wider.value - wider.middle), found.half(c) * 2 * (1 + 1e-6));
        ++tally.intervals;
      }
    }
  }
}

struct Membranes {
  const char* name;
  bool rich = false;
  double decades = 0;  // of the tension
  unsigned seeds = 100;
};
class Identities : public ::testing::TestWithParam<Membranes> {};

TEST_P(Identities, HoldOnNestedMeshes) {
  const unsigned first = testing::random_seed();
  Figures tally;
  for (unsigned k = 0; k < GetParam().seeds; ++k)
    check_identities(first + k, GetParam().rich, GetParam().decades, tally);
  std::printf(
      "[ figures  ] seeds from %u: %d energies to %.1e, %d intervals to %.1e (%d with a z that "
      "pulls "
      "at contacts), cone %.1e (left %d times), nearest %.2f\n",
      first, tally.brackets, tally.energy, tally.intervals, tally.displacement, tally.pulled,
      tally.cone, tally.left, tally.nearest);
  EXPECT_GT(tally.brackets, static_cast<int>(GetParam().seeds) / 2);
  EXPECT_GT(tally.intervals, 100);
  EXPECT_GT(tally.pulled, 10);
}

INSTANTIATE_TEST_SUITE_P(Random, Identities,
                         ::testing::Values(Membranes{"Plain"}, Membranes{"Rich", true},
                                           Membranes{"Contrast", true, 8, 30}),
                         [](const auto& one) { return one.param.name; });

/// Without a weight R(c) is the largest eta y + c (rho^2 - y^2) for 0 <= y <= rho.
TEST(HalfWidth, IsTheWorstThatTheConeAllows) {
  for (const double c : {0.0, 0.01, 0.4, 3.0}) {
    const double eta = 0.7, rho = 1.3;
    double worst = 0;
    for (int k = 0; k <= 10'000; ++k) {
      const double y = rho * k / 10'000;
      worst = std::max(worst, eta * y + c * (rho * rho - y * y));
    }
    const HalfWidth half{rho * rho, 0, eta * eta / 4};
    EXPECT_NEAR(half(c), worst, 1e-7);
  }
}

}  // namespace
}  // namespace anticrack::estimate
