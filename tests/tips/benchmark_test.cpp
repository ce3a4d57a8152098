// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tips on arcs, which are refused, and a crack between free edges.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "accuracy/base_meshes.hpp"
#include "tips/measured.hpp"

namespace anticrack::testing {
namespace {

using contact::TipAnswer;
using mesh::Kind;

/// A mesh has chords of a curve, and the last one, which is short, is no straight piece of it.
TEST(TipsOnArcs, AreRefused) {
  mesh::Geometry geometry;
  geometry.boundary = {{-2, -1.5}, {2, -1.5}, {2, 2.5}, {-2, 2.5}};
  mesh::LineSpec line;
  line.shape = mesh::Shape::arc;
  line.points = {{1, 0}, {0, 1}, {-1, 0}};
  geometry.cracks = {{"arc", {}, false}};
  geometry.cracks[0].line = line;
  const Measured measured = measure(accuracy::generated(geometry, {}), with_boundary("y"));
  ASSERT_EQ(measured.answer.tips.size(), 2U);
  for (const TipAnswer& tip : measured.answer.tips) {
    EXPECT_EQ(tip.kind, mesh::TipKind::crack_tip);
    EXPECT_THAT(tip.reason, ::testing::StartsWith("it lies on a curve"));
    EXPECT_FALSE(tip.intensity || tip.k_iii || tip.energy_release_rate);
  }
}

/// sn(u | m) by descending Landen transformations.
double sn(double u, double m) {
  if (m < 1e-30) return std::sin(u);
  const double low = (1 - std::sqrt(1 - m)) / (1 + std::sqrt(1 - m)), v = u / (1 + low);
  const double below = sn(v, low * low);
  return (1 + low) * below / (1 + low * below * below);
}

double elliptic(double m) { return std::comp_ellint_1(std::sqrt(m)); }

/// The energy |u|^2/2 of the square |x|, |y| < 1 with u = +-1 on y = +-1, free sides and a crack of
/// half-length a in the middle, by conformal maps of a quarter.
double energy(double a) {
  const double m = 0.5, p = std::pow(sn(elliptic(m) * a, m), 2), l = (1 - p) / (1 / m - p);
  return 2 * elliptic(l) / elliptic(1 - l);
}

TEST(TipsOfCracks, BetweenFreeEdges) {
  for (const double a : {0.25, 0.5, 0.75}) {
    mesh::Mesh base =
        cut_square([a](double x) { return std::abs(x) < a ? Kind::crack : Kind::glue; });
    std::erase_if(base.dirichlet, [&](const auto& edge) {
      return std::abs(mesh::position(base, edge[0])[0]) == 1 &&
             std::abs(mesh::position(base, edge[1])[0]) == 1;
    });
    const Measured measured = measure(fine(base), with_boundary("y"));
    constexpr double step = 1e-4;
    const double g = -(energy(a + step) - energy(a - step)) / (2 * step) / 2;
    for (const TipAnswer& tip : measured.answer.tips) {
      std::printf("[ figures  ] crack of half-length %g between free edges: G %.3f %%\n", a,
                  100 * (*tip.energy_release_rate / g - 1));
      EXPECT_NEAR(*tip.energy_release_rate, g, 2e-3 * g);
      EXPECT_NEAR(*tip.k_iii, std::sqrt(2 * g), 1e-3 * std::sqrt(2 * g));
    }
  }
}

}  // namespace
}  // namespace anticrack::testing
