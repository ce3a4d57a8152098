// SPDX-License-Identifier: GPL-3.0-or-later
//
// The cones that bounds of A are searched in: how many are tried, each of which costs fields and a
// flux, and how much wider the bounds are than in the best of many.
#include "operators/bound_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "estimate/solved.hpp"
#include "support/random_seed.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::estimate {
namespace {

struct Searched {
  int searches = 0, clipped = 0, tries = 0;  ///< tries: where something is clipped
  std::vector<double> widths;                ///< over those in the best cones
};

/// The bound by the z and tau of the present try of a search or, with c, of that cone.
Bound bound_in(const Solved& in, const operators::Search& search, Side side, double c) {
  const operators::Target& target = search.target();
  const double sign = side == Side::upper ? 1 : -1;
  const contact::Adjoint& adjoint = target.adjoints.adjoint;
  const contact::Adjoint::Room room{c * target.adjoints.room.jumps,
                                    c * target.adjoints.room.forces};
  const Eigen::VectorXd load = c > 0 ? adjoint.load(target.goal, sign, room) : search.load();
  const contact::Opened opened = std::move(in.parts.contact->solve_open({}, {&load, 1}).front());
  if (!opened.solved) return {};
  const contact::Displaced pair[] = {
      {&target.aim().goal, c > 0 ? adjoint.jumps(target.goal, sign, room) : search.jumps()},
      {&target.aim().goal, opened.d}};
  const std::vector<std::vector<double>> fields = in.parts.contact->fields_of(pair);
  Aimed aimed = search.aimed(fields[0], fields[1]);
  if (c > 0) aimed.dual.c = c;
  return bounds(in.cut, {&aimed, 1}).front();
}

void check_searches(const Solved& in, Searched& tally) {
  if (!in.converged() || !in.cut.obstacle.empty()) return;
  const EquilibratedFlux sigma(in.cut, in.balance());
  LoadBalance load;
  load.force = in.force;
  load.traction = in.traction;
  const std::vector<Lift> none;
  const Primal primal{in.cut, sigma, load, none, in.u};
  const Bracket bracket = estimate::bracket(in.cut, sigma, load, none, in.u, in.answer.energy_mesh);
  contact::Answer answer = in.answer;
  const std::stop_token stop;
  const operators::Bounded of{in.load, primal, bracket, answer, stop};
  const std::vector<operators::Aim> goals = operators::aims(in.parts);
  const std::vector<contact::UnitForce> forces = operators::unit_forces(in.parts, goals);
  operators::Adjoints adjoints{of,
                               {in.parts.contact->conditions(), answer.closed},
                               operators::room_of(in.parts, primal, answer.closed)};
  for (std::size_t k = 0; k < goals.size(); ++k) {
    const contact::Opened kept =
        std::move(in.parts.contact->solve_open(answer.closed, {&forces[k].r, 1}).front());
    if (!kept.solved) continue;
    operators::Target target{adjoints, goals, k, goals[k].unit(answer.inclusions.size()),
                             adjoints.adjoint.aim(forces[k], kept)};
    if (!(target.goal.compliance > 1e-9) || !(sigma.norm_squared() > 1e-9)) continue;
    double width = 0, least = 0;
    const double first = first_cone(target.goal.compliance, sigma.norm_squared());
    for (const Side side : {Side::lower, Side::upper}) {
      const double sign = side == Side::upper ? 1 : -1;
      operators::Search search(in.parts, target, side);
      const bool clips = search.clips();
      int tries = 0;
      for (; !search.done(); ++tries) {
        const Bound found = bound_in(in, search, side, 0);
        search.take(found);
      }
      double best = std::numeric_limits<double>::infinity();
      for (int i = -16; i <= 36; ++i) {
        const Bound found = bound_in(in, search, side, first * std::exp2(0.25 * i));
        if (std::isfinite(found.value)) best = std::min(best, sign * found.value);
      }
      width += sign * search.best().value;
      least += best;
      ++tally.searches;
      tally.clipped += clips ? 1 : 0;
      tally.tries += clips ? tries : 0;
    }
    if (std::isfinite(width) && least > 1e-9) tally.widths.push_back(width / least);
  }
}

void report(const char* what, unsigned first, Searched& tally) {
  std::ranges::sort(tally.widths);
  const auto part = [&](double of) {
    return tally.widths.at(
        static_cast<std::size_t>(of * static_cast<double>(tally.widths.size() - 1)));
  };
  std::printf(
      "[ figures  ] %s, seeds from %u: %d searches, %d with clipping, for which %.2f cones are "
      "tried; widths over the best %.3f, %.3f, %.3f (half, 95 %%, all)\n",
      what, first, tally.searches, tally.clipped,
      static_cast<double>(tally.tries) / std::max(1, tally.clipped), part(0.5), part(0.95),
      part(1));
}

TEST(BoundSearch, OfRandomMembranesTriesOneConeAsARule) {
  const unsigned first = testing::random_seed();
  for (const bool rich : {false, true}) {
    Searched tally;
    for (unsigned seed = first; seed < first + 60; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const Nested nested(seed, rich);
      if (nested.fine) check_searches(*nested.fine, tally);
    }
    report(rich ? "rich" : "plain", first, tally);
  }
}

/// The paper's domain, one side of the bar pressed and the other pulled.
Solved bar(unsigned seed, int refinements) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  mesh::Mesh mesh = testing::structured_mesh({32, 16, {}, {}, {"bar"}});
  for (int i = 0; i < refinements; ++i) mesh = mesh::refine_uniform(mesh);
  const double end = uniform(-0.4, 0.4), below = uniform(0.5, 2), beside = -uniform(0.5, 2),
               above = uniform(-1, 1), sign = seed % 2 == 0 ? 1 : -1;
  std::vector<double> force;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    double x = 0;
    for (std::size_t i = 0; i < 3; ++i) x += mesh.xy[2 * at(mesh.triangles[3 * t + i])] / 3;
    force.push_back(mesh.subdomain[t] == 1 ? above : sign * (x < end ? below : beside));
  }
  fem::Load load;
  load.name = "random";
  load.inclusion_forces["bar"] = uniform(-0.3, 0.3);
  return {mesh, load, force};
}

TEST(BoundSearch, OfABarThatIsPartlyInContactTriesOneConeAsARule) {
  const unsigned first = testing::random_seed();
  for (const int refinements : {0, 1, 2}) {
    Searched tally;
    for (unsigned seed = first; seed < first + 20; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      check_searches(bar(seed, refinements), tally);
    }
    report("bar", first, tally);
  }
}

}  // namespace
}  // namespace anticrack::estimate
