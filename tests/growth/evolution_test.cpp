// SPDX-License-Identifier: GPL-3.0-or-later
//
// The policy of growth on rates in closed form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "errors/errors.hpp"
#include "growth/evolution.hpp"

namespace anticrack::growth {
namespace {

using Rates = std::function<Measured(const std::vector<double>& a)>;

Track even(double from, double to, std::size_t edges, double Gc = 1) {
  Track track{"path", {}, {}, false, -1};
  for (std::size_t i = 0; i <= edges; ++i) {
    track.position.push_back(from +
                             (to - from) * static_cast<double>(i) / static_cast<double>(edges));
    track.toughness.push_back(Gc);
  }
  return track;
}

std::vector<double> positions(const Evolution& evolution) {
  std::vector<double> a;
  for (std::size_t i = 0; i < evolution.tracks().size(); ++i)
    a.push_back(evolution.tracks()[i].position[evolution.state().at[i]]);
  return a;
}

std::vector<Row> grown(Evolution& evolution, const Rates& rates) {
  std::vector<Row> rows;
  for (int turns = 0; !evolution.over() && turns < 100'000; ++turns)
    if (auto row = evolution.take(rates(positions(evolution)))) rows.push_back(std::move(*row));
  EXPECT_TRUE(evolution.over());
  return rows;
}

Measured one(double G1, double A = 1) { return {{G1}, {A}, 0, -G1}; }

/// A double cantilever beam: A = a^3 under the force 1, so G1 = 3 a^2 / 2 by Irwin.
Measured beam(const std::vector<double>& a) { return one(1.5 * a[0] * a[0], a[0] * a[0] * a[0]); }

TEST(OneFront, OfABeamRunsUnderLoadAndCreepsUnderDisplacement) {
  constexpr double from = 1, to = 2, Gc = 0.3;
  Evolution loaded({even(from, to, 200, Gc)}, {}, 0), driven({even(from, to, 200, Gc)}, {0}, 0);
  const std::vector<Row> by_load = grown(loaded, beam), by_displacement = grown(driven, beam);
  ASSERT_EQ(by_load.size(), 201U);
  for (std::size_t k = 0; k < by_load.size(); ++k) {
    const double a = by_load[k].position[0], t = std::sqrt(Gc / (1.5 * a * a));
    EXPECT_NEAR(by_load[k].load, t, 1e-14 * t);
    EXPECT_NEAR(by_load[k].displacement[0], t * a * a * a, 1e-14 * a * a);
    EXPECT_EQ(by_load[k].stable, k == 0);
    EXPECT_TRUE(by_displacement[k].stable) << k;
    EXPECT_EQ(by_displacement[k].load, by_load[k].load);
  }
  EXPECT_TRUE(jumps(by_displacement, {0}).empty());
  const std::vector<Jump> jump = jumps(by_load, {});
  ASSERT_EQ(jump.size(), 1U);
  EXPECT_EQ(jump[0].from, 0U);
  EXPECT_FALSE(jump[0].to);
  // int Gc ((a/from)^2 - 1) da
  const double left =
      Gc * ((std::pow(to, 3) - std::pow(from, 3)) / (3 * from * from) - (to - from));
  EXPECT_NEAR(jump[0].not_dissipated, left, 1e-4 * left);
  EXPECT_EQ(loaded.events().back().fate, Fate::end_of_path);
}

/// Where Gc is larger from `stripe` on, the front stops unless the load of the start is enough
/// there.
TEST(OneFront, StopsAtAStripeThatIsTough) {
  constexpr double from = 1, stripe = 1.5, weak = 1;
  for (const double tough : {2.0, 2.5}) {
    Track track = even(from, 2, 400);
    for (std::size_t i = 0; i < track.position.size(); ++i)
      track.toughness[i] = track.position[i] < stripe ? weak : tough;
    Evolution evolution({track}, {}, 0);
    const std::vector<Row> rows = grown(evolution, beam);
    const std::vector<Jump> jump = jumps(rows, {});
    ASSERT_FALSE(jump.empty());
    const double needed = std::pow(stripe / from, 2);  // Gc that holds the load of the start there
    if (tough < needed) {
      EXPECT_FALSE(jump[0].to);
      continue;
    }
    ASSERT_EQ(jump.size(), 2U);
    ASSERT_TRUE(jump[0].to);
    EXPECT_DOUBLE_EQ(rows[*jump[0].to].position[0], stripe);
    EXPECT_EQ(jump[1].from, *jump[0].to);
    const double left = weak * ((std::pow(stripe, 3) - 1) / 3 - (stripe - 1));
    EXPECT_NEAR(jump[0].not_dissipated, left, 1e-2 * left);
    EXPECT_EQ(std::ranges::count_if(rows, &Row::stable), 2);
  }
}

TEST(OneFront, ThatIsClosedHasNoLoad) {
  Evolution evolution({even(0, 1, 10)}, {}, 0);
  const std::vector<Row> rows = grown(evolution, [](const auto&) { return one(0); });
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_TRUE(std::isinf(rows[0].load));
  EXPECT_EQ(rows[0].leader, -1);
  EXPECT_FALSE(rows[0].stable);
  EXPECT_THAT(evolution.ending(), ::testing::HasSubstr("closed"));
  EXPECT_TRUE(jumps(rows, {}).empty());
}

TEST(OneFront, SnapsBeforeAnEndAndStopsWhereItCannotBeFollowed) {
  for (const bool through : {true, false}) {
    Track track = even(0, 1, 10);
    track.breaks_through = through;
    Evolution evolution({track}, {}, 0);
    const std::vector<Row> rows = grown(evolution, [](const std::vector<double>& a) {
      Measured measured = one(1);
      if (a[0] > 0.75) measured.release[0] = {};
      return measured;
    });
    EXPECT_NEAR(rows.back().position[0], 0.7, 1e-12);
    ASSERT_EQ(evolution.events().size(), 1U);
    EXPECT_EQ(evolution.events()[0].fate, through ? Fate::snapped : Fate::not_followed);
    EXPECT_EQ(evolution.events()[0].row, rows.size());
  }
}

/// With G = C / (1 + a), which falls, two fronts keep C1 / (1 + a1) = C2 / (1 + a2) to a step.
TEST(TwoFronts, KeepTheirRatesEqual) {
  constexpr double C[] = {1, 1.7};
  Evolution evolution({even(0, 3, 300), even(0, 3, 300)}, {}, 0);
  const std::vector<Row> rows = grown(evolution, [&](const std::vector<double>& a) {
    return Measured{{C[0] / (1 + a[0]), C[1] / (1 + a[1])}, {}, 0, 0};
  });
  std::size_t ties = 0;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const Row &row = rows[k], &next = rows[k + 1];
    const auto leader = static_cast<std::size_t>(row.leader);
    EXPECT_LE(row.starts[leader], row.starts[1 - leader]);
    EXPECT_EQ(next.position[1 - leader], row.position[1 - leader]);
    ties += row.ties.size();
    if (row.position[0] == 0 || std::isnan(row.G1[0] + row.G1[1])) continue;
    EXPECT_NEAR(row.G1[0], row.G1[1], 0.01 * C[1]);
    EXPECT_NEAR(row.load, std::sqrt(std::max((1 + row.position[0]) / C[0], 0.0)), 0.02);
  }
  EXPECT_GT(ties, 100U);
  // The second leads alone until the rates are equal, at 1 + a2 = C2.
  const auto other = std::ranges::find(rows, 0, &Row::leader);
  ASSERT_NE(other, rows.end());
  EXPECT_NEAR(1 + other->position[1], C[1] / C[0], 0.011);
}

TEST(TwoFronts, ThatMeetSnapTogetherAndDoNotPassEachOther) {
  Track left = even(0, 1, 100), right = even(1, 0, 100);
  left.breaks_through = right.breaks_through = true;
  left.facing = 1;
  right.facing = 0;
  for (const double near : {0.0, 0.1}) {
    Evolution evolution({left, right}, {}, 0.03);
    const std::vector<Row> rows = grown(evolution, [&](const std::vector<double>& a) {
      Measured measured{{1 + a[0], 1 + 0.5 * (1 - a[1])}, {}, 0, 0};
      if (a[1] - a[0] < near) measured.release = {{}, {}};
      return measured;
    });
    for (const Row& row : rows) EXPECT_GT(row.position[1], row.position[0] + near - 1e-12);
    ASSERT_EQ(evolution.events().size(), 2U);
    for (const Event& event : evolution.events()) EXPECT_EQ(event.fate, Fate::snapped);
    EXPECT_THAT(evolution.ending(), ::testing::HasSubstr("every front"));
  }
}

TEST(TwoFronts, GoOnWhenTheOtherHasEnded) {
  Track short_path = even(0, 0.1, 5), long_path = even(0, 1, 20);
  Evolution evolution({short_path, long_path}, {}, 0);
  const std::vector<Row> rows = grown(evolution, [&](const std::vector<double>& a) {
    return Measured{
        {evolution.state().fate[0] == Fate::grows ? std::optional(5.0) : std::nullopt, 1 + a[1]},
        {},
        0,
        0};
  });
  EXPECT_EQ(rows.size(), 6U + 21U);
  EXPECT_EQ(rows[5].leader, 0);
  EXPECT_EQ(rows[6].leader, 1);
  EXPECT_TRUE(std::isnan(rows[6].G1[0]));
  EXPECT_TRUE(std::isinf(rows[6].starts[0]));
}

TEST(Tracks, NeedAToughnessAboveZero) {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    Track track = even(0, 1, 4);
    track.toughness[2] = bad;
    EXPECT_THROW(Evolution({track}, {}, 0), errors::Error) << bad;
  }
  EXPECT_THROW(Evolution({Track{"short", {0}, {1}, false, -1}}, {}, 0), errors::Error);
}

}  // namespace
}  // namespace anticrack::growth
