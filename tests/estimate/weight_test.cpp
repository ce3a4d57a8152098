// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of A by weights about the ends of contact zones, against meshes that are much finer: of z
// and tau at the limits of the cone, for which a weight that is too large would show, and of
// natural ones.
#include "estimate/weight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include "contact/adjoint.hpp"
#include "estimate/interval.hpp"
#include "estimate/solved.hpp"
#include "operators/bound_search.hpp"
#include "support/random_seed.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::estimate {
namespace {

/// The domain of the paper with a random load that is constant in boxes, and refined meshes.
struct Case {
  mesh::Mesh mesh;
  std::vector<double> force;
  fem::Load load;

  explicit Case(unsigned seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    mesh = testing::structured_mesh({32, 16, {}, {}, {"bar"}});
    // One side of the bar is pressed and the other one pulled.
    const double first = std::floor(uniform(-7, 5)) / 16,
                 second = seed % 2 == 0 ? 1 : first + std::floor(uniform(4, 7)) / 16,
                 sign = seed % 4 < 2 ? 1 : -1, below = sign * uniform(0.5, 2),
                 beside = -sign * uniform(0.5, 2), above = uniform(-1, 1);
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      double x = 0;
      for (std::size_t i = 0; i < 3; ++i) x += mesh.xy[2 * at(mesh.triangles[3 * t + i])] / 3;
      force.push_back(mesh.subdomain[t] == 1 ? above : x < first || x > second ? below : beside);
    }
    load.name = "random";
    load.inclusion_forces["bar"] = uniform(-0.3, 0.3);
  }

  /// A after some uniform refinements.
  double displacement(int refinements) const {
    mesh::Mesh fine = mesh;
    std::vector<double> values = force;
    for (int i = 0; i < refinements; ++i) {
      fine = mesh::refine_uniform(fine);
      std::vector<double> four;
      for (const double one : values) four.insert(four.end(), 4, one);
      values = std::move(four);
    }
    return Solved(fine, load, values).answer.inclusions.front().displacement;
  }
};

struct Found {
  int bounds = 0, extreme = 0, several = 0;
  double nearest = 1, most = 0;
};

/// w of the formulas about one end, in a point of the membrane.
struct Pointwise {
  const ContactEnd& end;
  double beta, l;
  Pointwise(const ContactEnd& about, const Weight& weight)
      : end(about),
        beta(weight.beta),
        l(about.reach * std::pow(weight.largest, -1 / weight.beta)) {}
  double distance(const Vector& x) const {
    return std::hypot(x[0] - end.place[0], x[1] - end.place[1]);
  }
  bool below(const Vector& x) const {
    return (x[0] - end.place[0]) * end.normal[0] + (x[1] - end.place[1]) * end.normal[1] < 0;
  }
  double w(double s) const { return std::pow(end.reach / std::clamp(s, l, end.reach), beta); }
  double b(double s) const { return s > l && s < end.reach ? beta * w(s) : 0; }
};

/// The terms of R(c) by samples of each triangle: those of a bound are at least as large, and not
/// much larger.
void check_terms(const Solved& in, const Primal& primal, const Dual& dual, const ContactEnd& end,
                 const Bound& found, Found& tally) {
  const Pointwise at_point(end, *dual.weight);
  const EquilibratedFlux& sigma = primal.flux;
  const EquilibratedFlux tau = dual_flux(primal, dual);
  std::vector<double> rest(dual.z.size());
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = dual.reacting[i] - dual.z[i];
  HalfWidth sum;
  constexpr int pieces = 12;
  for (std::size_t t = 0; t < in.cut.triangle_count(); ++t) {
    const Vector shift = sigma.flux_of(t, rest);
    for (int i = 0; i < pieces; ++i)
      for (int half = 0; half < 2 * (pieces - i) - 1; ++half) {
        const int j = half / 2;
        const double third = half % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
        const double beside = (i + third) / pieces, above = (j + third) / pieces;
        const std::array<double, 3> place{1 - beside - above, beside, above};
        Vector x{};
        for (std::size_t k = 0; k < 3; ++k)
          for (std::size_t d = 0; d < 2; ++d) x[d] += place[k] * in.place(3 * t + k)[d];
        const double s = at_point.distance(x), inside = at_point.below(x) ? 1 : 0,
                     w = inside != 0 ? at_point.w(s) : 1, b = inside * at_point.b(s);
        const Vector off = sigma.difference(t, place), of_tau = tau.difference(t, place);
        const double tension = in.tension(t), weight = in.area(t) / (pieces * pieces),
                     d = std::hypot(off[0], off[1]) / (2 * tension),
                     dz = std::hypot(of_tau[0] + shift[0], of_tau[1] + shift[1]);
        sum.primal += weight * (w + b + b * b / (w - b)) * tension * d * d;
        sum.mixed += weight * b / (w - b) * dz * d;
        sum.dual += weight * dz * dz / (4 * (w - b) * tension);
      }
  }
  for (const auto& [own, sampled] :
       {std::pair{found.half.primal, sum.primal}, std::pair{found.half.mixed, sum.mixed},
        std::pair{found.half.dual, sum.dual}}) {
    EXPECT_GE(own, 0.99 * sampled);
    EXPECT_LE(own, 2 * sampled);
    tally.most = std::max(tally.most, own / sampled);
  }
}

/// k p on the faces about an end, in some points of each.
void check_faces(const Solved& in, const EquilibratedFlux& sigma, const ContactEnd& end,
                 const Weight& weight) {
  const Pointwise at_point(end, weight);
  const auto pressure = [&](std::size_t f) {
    return std::max(0.0, -sigma.through_faces()[2 * f] - sigma.through_faces()[2 * f + 1]);
  };
  /// Of the places of the ends of a face along the line.
  const auto along = [&](std::size_t f, std::size_t k) {
    const Vector& x = in.cut.at[at(in.cut.ends(in.cut.faces[f])[k])];
    return (x[0] - end.place[0]) * end.along[0] + (x[1] - end.place[1]) * end.along[1];
  };
  const auto force_within = [&](double s) {
    double sum = 0;
    for (std::size_t f = 0; f < in.cut.faces.size(); ++f) {
      if (!presses(in.cut.faces[f].condition)) continue;
      const double low = std::min(along(f, 0), along(f, 1)),
                   high = std::max(along(f, 0), along(f, 1));
      sum += pressure(f) * std::max(0.0, std::min(high, s) - std::max(low, -s)) / (high - low);
    }
    return sum;
  };
  for (const Weight::OnFace& on : weight.faces) {
    const double low = std::min(along(on.face, 0), along(on.face, 1)),
                 high = std::max(along(on.face, 0), along(on.face, 1)), p = pressure(on.face);
    for (const double part : {0.01, 0.3, 0.6, 0.99}) {
      const double place = low + part * (high - low), s = std::abs(place), w = at_point.w(s);
      EXPECT_LE(on.least, w * (1 + 1e-9));
      EXPECT_GE(on.most, w * (1 - 1e-9));
      double k = w * p;
      if (place > at_point.l * (1 + 1e-9) && place < end.reach)
        k -= at_point.beta * w / s * force_within(s) * (high - low);
      EXPECT_LE(on.bound[0] + on.bound[1], k + 1e-9 * w * p + 1e-14) << place;
    }
  }
}

/// Bounds of one case by weights.
void check(unsigned seed, Found& tally) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  const Case one(seed);
  const Solved coarse(one.mesh, one.load, one.force);
  ASSERT_TRUE(coarse.converged());
  const EquilibratedFlux sigma(coarse.cut, coarse.balance());
  const std::vector<ContactEnd> ends = contact_ends(coarse.cut, sigma, {}, 0);
  if (ends.empty()) return;
  tally.several += ends.size() > 1 ? 1 : 0;
  for (const ContactEnd& a : ends)  // their discs are disjoint
    for (const ContactEnd& b : ends)
      if (&a != &b) {
        EXPECT_GE(std::hypot(a.place[0] - b.place[0], a.place[1] - b.place[1]), a.reach + b.reach);
      }
  const double fine = one.displacement(2), finer = one.displacement(3);
  const double truth = finer + (finer - fine), doubt = 2 * std::abs(finer - fine);

  LoadBalance load;
  load.force = coarse.force;
  const std::vector<Lift> none;
  const Primal primal{coarse.cut, sigma, load, none, coarse.u};
  const contact::ContactProblem& problem = *coarse.parts.contact;
  const contact::Adjoint adjoint(problem.conditions(), coarse.answer.closed);
  const ddm::Terms& aim = coarse.parts.decomposition.skeleton.motions.front().displacement;
  const contact::UnitForce force = problem.unit_force(aim);
  const contact::Opened kept =
      std::move(problem.solve_open(coarse.answer.closed, {&force.r, 1}).front());
  const contact::Adjoint::Goal goal = adjoint.aim(force, kept);
  const double c0 = std::sqrt(goal.compliance / sigma.norm_squared());
  const std::vector<ForceOn> unit{{1, {}}};
  for (const double beta : {0.3, 0.6})
    for (const double inner : {0.1, 0.3})
      for (const double c : {c0, 4 * c0, 16 * c0})
        for (const Side side : {Side::lower, Side::upper})
          for (const bool extreme : {false, true}) {
            const Weight weight = weight_about(coarse.cut, sigma, ends, inner, beta);
            if (weight.faces.empty()) continue;
            const double sign = side == Side::upper ? 1 : -1;
            contact::Adjoint::Room room =
                operators::room_of(coarse.parts, primal, coarse.answer.closed, &weight);
            room.jumps *= c;
            room.forces *= c;
            contact::Adjoint::Goal own = goal;
            if (extreme) {  // as far as the cone goes
              own.jumps.array() += sign * 1e6 * room.jumps.array();
              own.reactions.array() -= sign * 1e6 * room.forces.array();
            }
            const Eigen::VectorXd clipped = adjoint.load(own, sign, room);
            const contact::Opened free = std::move(problem.solve_open({}, {&clipped, 1}).front());
            const contact::Displaced pair[] = {{&aim, adjoint.jumps(own, sign, room)},
                                               {&aim, free.d}};
            const std::vector<std::vector<double>> fields = problem.fields_of(pair);
            const Aimed aimed{&primal,
                              {fields[0], fields[1], coarse.answer.inclusions.front().displacement,
                               side, c, unit, &weight}};
            const Bound found = bounds(coarse.cut, {&aimed, 1}).front();
            ASSERT_TRUE(std::isfinite(found.value));
            if (ends.size() == 1) {
              check_terms(coarse, primal, aimed.dual, ends.front(), found, tally);
              check_faces(coarse, sigma, ends.front(), weight);
            }
            EXPECT_GT(sign * (found.value - truth), -doubt) << beta << " " << inner << " " << c;
            tally.nearest = std::min(tally.nearest, (sign * (found.value - truth) + doubt) /
                                                        (sign * (found.value - found.middle)));
            ++(extreme ? tally.extreme : tally.bounds);
          }
}

TEST(Weight, BoundsHoldOnFinerMeshes) {
  const unsigned first = testing::random_seed();
  Found tally;
  for (unsigned k = 0; k < 40; ++k) check(first + k, tally);
  std::printf(
      "[ figures  ] seeds from %u: %d bounds (%d membranes with several ends), %d at the limits of "
      "the cone, nearest %.3f; terms "
      "at most %.2f times their samples\n",
      first, tally.bounds, tally.several, tally.extreme, tally.nearest, tally.most);
  EXPECT_GT(tally.most, 1);
  EXPECT_GT(tally.bounds, 50);
  EXPECT_GT(tally.extreme, 50);
}

}  // namespace
}  // namespace anticrack::estimate
