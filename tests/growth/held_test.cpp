// SPDX-License-Identifier: GPL-3.0-or-later
//
// Meshes of states of the fronts, and bounds of the mean rate between states against exact
// energies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "contact/answer.hpp"
#include "contact/options.hpp"
#include "estimate/marking.hpp"
#include "growth/crack_in_square.hpp"
#include "growth/held.hpp"
#include "growth/on_line.hpp"
#include "mesh/refine.hpp"
#include "operators/grow.hpp"
#include "support/silent_observer.hpp"

namespace anticrack::growth {
namespace {

using mesh::Kind;
using namespace anticrack::testing;

constexpr int n = 32;
constexpr double end = 0.75;

State both_at(std::size_t k) { return {{k, k}, {Fate::grows, Fate::grows}}; }

/// Pi on the mesh of a state, with bounds.
contact::Answer solved(const mesh::Mesh& mesh, const fem::Load& load) {
  const OnMesh on = prepared(mesh, load);
  Silent silent;
  contact::Answer answer = on.op->solve(on.load, contact::ActiveSetOptions{}, false, silent);
  on.op->estimate(on.load, answer);
  EXPECT_TRUE(answer.energy_lower) << answer.no_bracket;
  return answer;
}

/// The same after so many bisections where the bounds come from.
Bracket bracket_of(mesh::Mesh mesh, const fem::Load& load, int times = 0) {
  for (;; --times) {
    const OnMesh on = prepared(mesh, load);
    Silent silent;
    contact::Answer answer = on.op->solve(on.load, contact::ActiveSetOptions{}, false, silent);
    const std::vector<double> indicator = on.op->estimate(on.load, answer);
    if (times == 0) return {*answer.energy_lower, *answer.energy_upper};
    mesh = mesh::refine(mesh, estimate::levels(indicator, 4), 1'000'000);
  }
}

/// The square whose line is a crack for |x| < end, in one piece beside it.
mesh::Mesh one_piece() {
  mesh::Mesh mesh = with_free_sides(square(within(end, Kind::crack, Kind::glue), n));
  std::ranges::fill(mesh.subdomain, 0);
  mesh.subdomains = {"plate"};
  mesh::Interface& line = mesh.interfaces[0];
  const auto first = std::ranges::find(line.kind, Kind::crack) - line.kind.begin();
  const auto count = std::ranges::count(line.kind, Kind::crack);
  line.nodes = {line.nodes.begin() + first, line.nodes.begin() + first + count + 1};
  line.kind.assign(static_cast<std::size_t>(count), Kind::crack);
  line.inclusion.assign(static_cast<std::size_t>(count), -1);
  return mesh;
}

/// The same problem twice: contacts that are tied, and a mesh without them.
void expect_the_states_of(const mesh::Mesh& open, const fem::Load& load,
                          const std::vector<Path>& paths, const std::vector<State>& states) {
  const OnMesh on = prepared(open, load);
  operators::Growth growth(on.op, on.load, paths);
  for (const State& state : states) {
    const mesh::Mesh own = mesh_of(open, growth.fronts(), state);
    mesh::validate(own);
    EXPECT_EQ(own.triangles, open.triangles);
    const double energy = growth.measure(state).energy;
    EXPECT_NEAR(solved(own, load).energy_mesh, energy, 1e-10 * std::abs(energy));
  }
}

TEST(MeshOfAState, HasTheEnergyOfContactsThatAreTied) {
  const std::vector<State> states = {both_at(0),
                                     {{3, 7}, {Fate::grows, Fate::grows}},
                                     {{n / 2, 5}, {Fate::end_of_path, Fate::grows}}};
  expect_the_states_of(with_free_sides(square(within(end, Kind::crack, Kind::glue), n)),
                       load_of("y"), both_ways, states);
  expect_the_states_of(one_piece(), load_of("y"), both_ways, states);
}

TEST(MeshOfAState, IsBondedWhereAnInclusionHolds) {
  const mesh::Mesh open = square(Bonded::opened, n);
  expect_the_states_of(open, Bonded::load(), Bonded::paths(),
                       {{{0}, {Fate::grows}}, {{9}, {Fate::grows}}, {{12}, {Fate::snapped}}});
  const Fronts fronts = find_fronts(open, Bonded::paths());
  const auto bonded = [&](const State& state) {
    const mesh::Mesh mesh = mesh_of(open, fronts, state);
    return std::ranges::count(mesh.interfaces[0].kind, Kind::inclusion) -
           std::ranges::count(open.interfaces[0].kind, Kind::inclusion);
  };
  EXPECT_EQ(bonded({{0}, {Fate::grows}}), end * n);
  EXPECT_EQ(bonded({{9}, {Fate::grows}}), end * n - 9);
  EXPECT_EQ(bonded({{9}, {Fate::snapped}}), 0);
}

TEST(Opened, HasTheLengthAndTheCostOfWhatComesOff) {
  const mesh::Mesh open = square(within(end, Kind::crack, Kind::glue), n);
  const std::vector<Path> paths = {on_line(0.25, 0.75, "1 + x^2"),
                                   on_line(1.25, 1.75, "x < 0.5 ? 1 : 3")};
  const Fronts fronts = find_fronts(open, paths);
  const State from{{4, 0}, {Fate::grows, Fate::grows}}, to{{16, 12}, {Fate::grows, Fate::grows}};
  const Opened some = opened(open, fronts, paths, from, to);
  EXPECT_NEAR(some.length, 24.0 / n, 1e-14);
  // The left front goes from -0.375 to -0.75, the right one from 0.25 to 0.625.
  const double left = 0.375 + (std::pow(0.75, 3) - std::pow(0.375, 3)) / 3,
               right = 0.25 + 3 * 0.125;
  EXPECT_LE(some.cost_lower, left + right);
  EXPECT_GE(some.cost_upper, left + right);
  EXPECT_NEAR(some.cost_lower, some.cost_upper, 5e-3);
  const Opened rest = opened(open, fronts, paths, from, {{4, 12}, {Fate::snapped, Fate::grows}});
  EXPECT_NEAR(rest.length, 24.0 / n, 1e-14) << "all that held of a path that snaps";
  EXPECT_EQ(opened(open, fronts, paths, from, from).length, 0);
}

/// Each bound is attained by some energies within the brackets, and passed by none.
TEST(MeanRelease, IsAsCloseAsTheBracketsLetItBe) {
  const Bracket from{-3.5, -3.25}, to{-4.5, -3.75};
  const Opened between{0.5, 0.125, 0.1875};
  const MeanRelease mean = mean_release(from, to, between);
  double least = 1e300, most = 0, low = 1e300, high = 0;
  for (const double a : {from.lower, from.upper})
    for (const double b : {to.lower, to.upper}) {
      least = std::min(least, (a - b) / between.length);
      most = std::max(most, (a - b) / between.length);
      for (const double cost : {between.cost_lower, between.cost_upper}) {
        low = std::min(low, std::sqrt(cost / (a - b)));
        high = std::max(high, std::sqrt(cost / (a - b)));
      }
    }
  EXPECT_DOUBLE_EQ(mean.lower, least);
  EXPECT_DOUBLE_EQ(mean.upper, most);
  EXPECT_DOUBLE_EQ(*mean.load_lower, low);
  EXPECT_DOUBLE_EQ(*mean.load_upper, high);
  const MeanRelease unknown = mean_release(from, from, between);
  EXPECT_EQ(unknown.lower, 0) << "Pi falls where something comes off";
  EXPECT_FALSE(unknown.load_upper);
  EXPECT_TRUE(unknown.load_lower);
}

/// Of the crack between free edges, whose energy is known.
TEST(MeanRelease, HoldsTheExactOneBetweenAllPositions) {
  for (const bool whole : {false, true}) {
    const mesh::Mesh open =
        whole ? one_piece() : with_free_sides(square(within(end, Kind::crack, Kind::glue), n));
    const Fronts fronts = find_fronts(open, both_ways);
    constexpr std::size_t step = 4;
    std::optional<Bracket> before;
    double width = 0;
    for (std::size_t k = 0; k <= n / 2; k += step) {
      const Bracket here = bracket_of(mesh_of(open, fronts, both_at(k)), load_of("y"), 3);
      const double a = 0.25 + static_cast<double>(k) / n, b = a - static_cast<double>(step) / n;
      EXPECT_LE(here.lower, exact_energy(a));
      EXPECT_GE(here.upper, exact_energy(a));
      if (before) {
        const Opened between = opened(open, fronts, both_ways, both_at(k - step), both_at(k));
        const MeanRelease mean = mean_release(*before, here, between);
        const double exact = (exact_energy(b) - exact_energy(a)) / (2 * (a - b)),
                     load = std::sqrt(1 / exact);
        EXPECT_LE(mean.lower, exact);
        EXPECT_GE(mean.upper, exact);
        EXPECT_LE(*mean.load_lower, load);
        EXPECT_GE(*mean.load_upper, load);
        width = std::max(width, (mean.upper - mean.lower) / exact);
      }
      before = here;
    }
    std::printf("[ figures  ] bounds of the mean G1, %s: %.2f %% wide at most\n",
                whole ? "one piece" : "two", 100 * width);
    EXPECT_LT(width, 0.2);
  }
}

/// Where contact holds beside the front no solution is known: all that finer meshes say agrees.
TEST(MeanRelease, UnderContactHoldsThatOfFinerMeshes) {
  const mesh::Mesh open = square(Bonded::opened, n);
  const Fronts fronts = find_fronts(open, Bonded::paths());
  const auto mean_of = [&](std::size_t from, int times) {
    const State a{{from}, {Fate::grows}}, b{{from + 6}, {Fate::grows}};
    return mean_release(bracket_of(mesh_of(open, fronts, a), Bonded::load(), times),
                        bracket_of(mesh_of(open, fronts, b), Bonded::load(), times),
                        opened(open, fronts, Bonded::paths(), a, b));
  };
  for (const std::size_t from : {0U, 6U}) {
    const State a{{from}, {Fate::grows}};
    EXPECT_GT(solved(mesh_of(open, fronts, a), Bonded::load()).contact_length, 0);
    const MeanRelease coarse = mean_of(from, 1), fine = mean_of(from, 3);
    EXPECT_LT(fine.upper - fine.lower, coarse.upper - coarse.lower);
    EXPECT_LE(coarse.lower, (fine.lower + fine.upper) / 2);
    EXPECT_GE(coarse.upper, (fine.lower + fine.upper) / 2);
    std::printf("[ figures  ] under contact: mean G1 in [%g, %g], coarser [%g, %g]\n", fine.lower,
                fine.upper, coarse.lower, coarse.upper);
  }
}

}  // namespace
}  // namespace anticrack::growth
