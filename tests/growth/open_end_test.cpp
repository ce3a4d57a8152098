// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cracks that leave an open delaminated end, against the factor of the end without a crack.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "growth/crack_in_square.hpp"
#include "growth/on_line.hpp"
#include "mesh/refine.hpp"
#include "operators/grow.hpp"
#include "support/errors.hpp"
#include "tips/measured.hpp"

namespace anticrack::growth {
namespace {

using namespace anticrack::testing;

/// Delaminated for |x| < 1/2, then `beyond` up to 3/4 and glue, with the tensions of both sides.
mesh::Mesh square_with(Kind beyond, double below, double above) {
  mesh::Mesh mesh = cut_square([=](double x) {
    if (x > 0.5 && x < 0.75) return beyond;
    return std::abs(x) < 0.5 ? Kind::delaminated : Kind::glue;
  });
  mesh.tension = {below, above};
  return mesh::grade(mesh, {0.015, 0.5, 0}, 1'000'000);
}

/// The value at 0 of the parabola through three points.
double at_zero(const std::array<double, 3>& x, const std::array<double, 3>& y) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    double part = y[i];
    for (std::size_t k = 0; k < 3; ++k)
      if (k != i) part *= x[k] / (x[k] - x[i]);
    sum += part;
  }
  return sum;
}

/// G = g l^(2 a - 1) for small l, g the factor of the end as long as nothing leaves it. The next
/// term of u is r^(1 - a), so that the root of G l^(1 - 2 a) is a series in l^(1 - 2 a) at first;
/// with the tension of the other side, or the mean of both, g would be 40 % off or more.
TEST(CracksOutOfOpenEnds, StartUnderAnyLoadAsTheFactorOfTheEndSays) {
  const std::vector<Path> path = {on_line(1.5, 1.75, "1")};
  for (const auto& [below, above] : {std::pair{1.0, 1.0}, {1.0, 4.0}, {4.0, 1.0}}) {
    const fem::Load load = load_of("y");
    const contact::TipAnswer end = measure(square_with(Kind::glue, below, above), load).right();
    ASSERT_EQ(end.kind, mesh::TipKind::delaminated_end);
    ASSERT_GT(*end.intensity, 0.1);
    const OnMesh on = prepared(square_with(Kind::crack, below, above), load);
    operators::Growth growth(on.op, on.load, path);
    ASSERT_EQ(growth.fronts().fronts.size(), 1U);
    const Front& front = growth.fronts().fronts[0];
    const contact::TipAnswer before = growth.ends().front();
    EXPECT_EQ(before.reason, "");
    EXPECT_NEAR(*before.exponent, *end.exponent, 1e-14);
    EXPECT_NEAR(*before.release_factor, *end.release_factor, 0.01 * *end.release_factor);
    const double power = 1 - 2 * *end.exponent, start = front.track.position.front();
    std::array<double, 3> x{}, y{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double length = 2 * front.length * std::pow(3, static_cast<double>(i));
      const auto& all = front.track.position;
      const auto k = static_cast<std::size_t>(
          std::ranges::lower_bound(all, start + length - front.length) - all.begin());
      const double l = front.length + all[k] - start;
      x[i] = std::pow(l, power);
      y[i] = std::sqrt(*growth.measure({{k}, {Fate::grows}}).release[0] * x[i]);
    }
    const double found = std::pow(at_zero(x, y), 2);
    std::printf(
        "[ figures  ] T %g, %g: G l^(1 - 2 a) %.4f at l = %.2g, %.4f at 0, of the end %.4f\n",
        below, above, y[0] * y[0], front.length, found, *end.release_factor);
    EXPECT_NEAR(found, *end.release_factor, 0.1 * *end.release_factor);
  }
}

TEST(CracksOutOfOpenEnds, NeedTenEdgesOfTheirPath) {
  const mesh::Mesh mesh = cut_square([](double x) {
    return x > 0.5 && x < 0.75 ? Kind::crack : std::abs(x) < 0.5 ? Kind::delaminated : Kind::glue;
  });
  EXPECT_TRUE(throws([&] { find_fronts(mesh, std::vector{on_line(1.5, 1.75, "1")}); },
                     errors::Reason::invalid_argument, "paths[0]"));
}

}  // namespace
}  // namespace anticrack::growth
