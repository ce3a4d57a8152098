// SPDX-License-Identifier: GPL-3.0-or-later
//
// Growth beside a dead load: the loads that drive() finds on pieces in closed form, and those of a
// membrane against G of the sum of both loads at one t after another.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "errors/errors.hpp"
#include "growth/crack_in_square.hpp"
#include "growth/drive.hpp"
#include "growth/on_line.hpp"
#include "operators/grow.hpp"
#include "support/errors.hpp"

namespace anticrack::growth {
namespace {

using namespace anticrack::testing;

constexpr double never = std::numeric_limits<double>::infinity();

Rates rates(const Quadratic& q) { return {{q, q, q}}; }

/// Of one front: quadratics between `ends`, the last of which goes on.
Pieces pieces(std::vector<double> ends, std::vector<Quadratic> of) {
  return [=](double t, int way) {
    std::size_t k = 0;
    while (k < ends.size() && (way > 0 ? t >= ends[k] : t > ends[k])) ++k;
    const double end = way > 0 ? (k < ends.size() ? ends[k] : never) : (k > 0 ? ends[k - 1] : 0);
    return Piece{end, {rates(of[k])}};
  };
}

double start(const Pieces& on, double Gc, double from = 0, double highest = 0) {
  return drive(on, {{Gc}, from, highest}, {1}).starts[0];
}

/// G = (1 - 0.8 t)^2 falls to 0 at 1.25, where the front closes: a higher load does not start it.
TEST(DeadLoad, OfWhichALiveLoadTakesAway) {
  const Quadratic falls{{1, -1.6, 0.64}};
  const Pieces closing = pieces({1.25}, {falls, {}});
  EXPECT_EQ(start(closing, 0.9), 0);  // the dead load alone is enough
  EXPECT_EQ(start(closing, 1.1), never);
  const Driven found = drive(closing, {{1.1}, 0, 0.5}, {1});
  EXPECT_DOUBLE_EQ(found.most, falls.at(0.5) / 1.1);
  EXPECT_EQ(found.most_at, 0.5);
  // Without contact it would start on the other branch.
  const double other = (1 + std::sqrt(1.1)) / 0.8;
  EXPECT_NEAR(start(pieces({}, {falls}), 1.1), other, 1e-14);
}

TEST(DeadLoad, HasItsFirstLoadOnSomePiece) {
  // Rises to 1 at t = 1, falls to 0.5 at 2, rises again.
  const Pieces on = pieces({1, 2}, {{{0, 0, 1}}, {{1.5, -0.5, 0}}, {{-1.5, 1, 0}}});
  EXPECT_DOUBLE_EQ(start(on, 0.81), 0.9);
  EXPECT_DOUBLE_EQ(start(on, 1.2), 2.7);
  // Where t has passed the first of them and G is below Gc again, it is the next.
  EXPECT_DOUBLE_EQ(start(on, 0.81, 1.5, 1.5), 2.31);
  // Where G is above, t would have to fall, on the way that the row before was on.
  EXPECT_DOUBLE_EQ(start(on, 0.81, 1.2, 1.2), 0.9);
  EXPECT_DOUBLE_EQ(start(on, 0.81, 0.5, 1.2), 0.9);
  EXPECT_DOUBLE_EQ(start(on, 0.81, 2.5, 2.5), 2.31);
  EXPECT_DOUBLE_EQ(start(on, 0.81, 1.6, 2.5), 2.31);
}

TEST(DeadLoad, WhoseFrontsAreWithinATieAreAllFound) {
  const auto of = [](double at_1) { return rates({{0, 0, at_1}}); };
  const Pieces on = [&](double t, int way) {
    const double end = t < 1.001 ? 1.001 : t < 1.02 ? 1.02 : never;
    return Piece{way > 0 ? end : 0, {of(1), of(0.99), of(0.5), {}}};
  };
  const Driven found = drive(on, {{1, 1, 1, 1}, 0, 0}, {1, 1, 1, 0});
  EXPECT_DOUBLE_EQ(found.starts[0], 1);
  EXPECT_DOUBLE_EQ(found.starts[1], std::sqrt(1 / 0.99));
  EXPECT_EQ(found.starts[2], never);
  EXPECT_EQ(found.starts[3], never);
  EXPECT_TRUE(std::isnan(found.held[3]));
}

/// Under this dead load alone the front runs at t = 0 until G is below Gc.
TEST(DeadLoad, GrowsAFrontAlone) {
  Track track{"path", {0, 1, 2, 3}, {1, 1, 1, 1}, false, -1};
  Evolution evolution({track}, {}, 0);
  std::vector<Row> rows;
  while (!evolution.over()) {
    const double a = static_cast<double>(evolution.state().at[0]);
    const Pieces on = pieces({}, {{{1.5 - 0.4 * a, 0, 1}}});
    Measured measured{{0}, {}, 0, 0};
    measured.driven = drive(on, evolution.sought(), {1});
    rows.push_back(*evolution.take(measured));
  }
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_THAT(std::vector({rows[0].load, rows[1].load}), ::testing::Each(0));
  EXPECT_NEAR(rows[2].load, std::sqrt(0.3), 1e-15);
  EXPECT_NEAR(rows[3].load, std::sqrt(0.7), 1e-15);
  EXPECT_FALSE(rows[0].stable || rows[1].stable);
  EXPECT_TRUE(rows[2].stable && rows[3].stable);
  const std::vector<Jump> jump = jumps(rows, {});
  ASSERT_EQ(jump.size(), 1U);
  EXPECT_EQ(jump[0].from, 0U);
  EXPECT_EQ(jump[0].to, 2U);
  // G - Gc is 0.5, 0.1, -0.3 there.
  EXPECT_NEAR(jump[0].not_dissipated, 0.3 + 0.1 * 0.1 / 0.4 / 2, 1e-15);
}

struct Loads {
  std::string dead, live;
  std::string together(double t) const {
    return "(" + dead + ") + " + std::to_string(t) + "*(" + live + ")";
  }
};

std::string some_load(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> one(-size, size), place(-0.4, 0.6);
  return "y > 0 ? " + std::to_string(one(random) / 4) + " : x < " + std::to_string(place(random)) +
         " ? " + std::to_string(one(random)) + " : " + std::to_string(one(random));
}

struct Beside {
  std::shared_ptr<const operators::MeshOperator> op;

  operators::PreparedLoad load(const std::string& force) const {
    const fem::Load one = load_of("0", force);
    const fem::Load* const loads[] = {&one};
    return std::get<operators::PreparedLoad>(op->prepare(loads).front());
  }
  operators::Growth growth(const Loads& loads) const {
    return {op, load(loads.live), Bonded::paths(), {}, load(loads.dead)};
  }
  /// G with both loads at once.
  double rate(const Loads& loads, double t, const State& state) const {
    operators::Growth growth(op, load(loads.together(t)), Bonded::paths());
    return *growth.measure(state).release[0];
  }
};

/// Every load that is found is one at which G is Gc, and on the way to it none is missed.
TEST(DeadLoad, OnAMembraneHasTheNextLoadAtWhichGIsGc) {
  const Beside beside{prepared(square(Bonded::opened, Bonded::n), load_of("0")).op};
  std::mt19937 random(5);
  int found = 0, alone = 0, none = 0, falls = 0, back = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Loads loads{some_load(random, 12), some_load(random, 15)};
    const State state{{static_cast<std::size_t>(trial % 4) * 3}, {Fate::grows}};
    operators::Growth growth = beside.growth(loads);
    constexpr double Gc = 0.4, far = 4;
    const double highest = trial % 3 * 0.75;
    const Measured measured = growth.measure(state, Sought{{Gc}, highest, highest});
    ASSERT_TRUE(measured.driven);
    const double t = measured.driven->starts[0], at_0 = beside.rate(loads, 0, state),
                 held = beside.rate(loads, highest, state);
    EXPECT_NEAR(measured.driven->alone[0], at_0, 1e-6 * (at_0 + Gc));
    EXPECT_NEAR(measured.driven->held[0], held, 1e-6 * (held + Gc));
    const bool runs = held >= Gc;  // t would have to fall
    const double to = std::min(t, far);
    if (t > 0 && t < never) {
      const double step = runs ? -1e-5 : 1e-5;
      EXPECT_LT(beside.rate(loads, t - step, state), Gc * (runs ? 1 + 1e-3 : 1)) << trial;
      EXPECT_GE(beside.rate(loads, t + step, state), Gc * (runs ? 0 : 1)) << trial;
      ++found;
    }
    alone += t == 0 ? 1 : 0;
    none += t == never ? 1 : 0;
    back += runs && t > 0 ? 1 : 0;
    double before = held;
    bool fell = false;
    constexpr int steps = 12;
    for (int k = 1; k < steps; ++k) {
      const double at = highest + (to - highest) * k / steps, G = beside.rate(loads, at, state);
      EXPECT_TRUE(runs ? G > Gc * (1 - 1e-4) : G < Gc * (1 + 1e-4))
          << trial << ": " << G << " at " << at << " of " << highest << " to " << t;
      fell = fell || (!runs && G < before - 1e-9);
      before = G;
    }
    falls += fell ? 1 : 0;
  }
  std::printf(
      "[ figures  ] %d loads found, %d of them below the highest, %d of the dead load alone, %d "
      "without; G falls on the way in %d\n",
      found, back, alone, none, falls);
  EXPECT_GT(found, 8);
  EXPECT_GT(back, 1);
  EXPECT_GT(alone, 2);
  EXPECT_GT(none, 2);
  EXPECT_GT(falls, 2);
}

std::vector<Row> grown(operators::Growth& growth, bool driven) {
  Evolution evolution(growth.tracks(), {}, 2.0 / Bonded::n);
  std::vector<Row> rows;
  while (!evolution.over()) {
    const Measured measured = driven ? growth.measure(evolution.state(), evolution.sought())
                                     : growth.measure(evolution.state());
    if (auto row = evolution.take(measured)) rows.push_back(std::move(*row));
  }
  return rows;
}

TEST(DeadLoad, OfNothingIsHomogeneous) {
  const std::string live = "y > 0 ? 2 : x < -0.25 ? 14 : -10";
  const Beside beside{prepared(square(Bonded::opened, Bonded::n), load_of("0")).op};
  operators::Growth alone(beside.op, beside.load(live), Bonded::paths());
  operators::Growth driven = beside.growth({"0", live});
  const std::vector<Row> expected = grown(alone, false), rows = grown(driven, true);
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_NEAR(rows[k].load, expected[k].load, 1e-12 * expected[k].load);
    EXPECT_NEAR(rows[k].energy, expected[k].energy, 1e-11 * std::abs(expected[k].energy));
    EXPECT_NEAR(rows[k].displacement[0], expected[k].displacement[0],
                1e-11 * std::abs(expected[k].displacement[0]));
    EXPECT_EQ(rows[k].stable, expected[k].stable);
    EXPECT_EQ(rows[k].alone[0], 0);
    EXPECT_NEAR(rows[k].contact_length, expected[k].contact_length, 1e-9);
  }
  const std::vector<Jump> jump = jumps(rows, {}), expected_jump = jumps(expected, {});
  ASSERT_EQ(jump.size(), expected_jump.size());
  for (std::size_t k = 0; k < jump.size(); ++k) {
    EXPECT_EQ(jump[k].to, expected_jump[k].to);
    EXPECT_NEAR(jump[k].not_dissipated, expected_jump[k].not_dissipated,
                1e-9 * expected_jump[k].not_dissipated);
  }
}

/// A dead load that is a part of the live one: t is less by that part, whatever contact does.
TEST(DeadLoad, ThatIsAPartOfTheLiveOneTakesItOff) {
  const std::string live = "y > 0 ? 2 : x < -0.25 ? 14 : -10";
  const Beside beside{prepared(square(Bonded::opened, Bonded::n), load_of("0")).op};
  operators::Growth alone(beside.op, beside.load(live), Bonded::paths());
  operators::Growth driven = beside.growth({"0.25*(" + live + ")", live});
  const std::vector<Row> expected = grown(alone, false), rows = grown(driven, true);
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t k = 0; k < rows.size(); ++k)
    EXPECT_NEAR(rows[k].load, std::max(expected[k].load - 0.25, 0.0), 1e-9) << k;
}

TEST(DeadLoad, ScalesWithAllLoadsAndGc) {
  const Beside beside{prepared(square(Bonded::opened, Bonded::n), load_of("0")).op};
  const std::string dead = "y > 0 ? 1 : x < 0.1 ? -6 : 3",
                    live = "y > 0 ? 2 : x < -0.25 ? 14 : -10";
  const auto starts = [&](const Loads& loads, double Gc) {
    operators::Growth growth = beside.growth(loads);
    return growth.measure({{0}, {Fate::grows}}, Sought{{Gc}, 0, 0}).driven->starts[0];
  };
  const double t = starts({dead, live}, 3);
  ASSERT_TRUE(t > 0 && std::isfinite(t));
  EXPECT_NEAR(starts({"4*(" + dead + ")", "4*(" + live + ")"}, 16 * 3), t, 1e-10 * t);
  EXPECT_NEAR(starts({dead, "1e6*(" + live + ")"}, 3), 1e-6 * t, 1e-12 * t);
  EXPECT_NEAR(starts({dead, "1e-6*(" + live + ")"}, 3), 1e6 * t, t);
}

}  // namespace
}  // namespace anticrack::growth
