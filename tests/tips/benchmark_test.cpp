// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tips on arcs, which are refused, and closed forms of strips, of a free edge and of a line that is
// debonded in part; what is infinite there ends far away.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>

#include "accuracy/base_meshes.hpp"
#include "tips/measured.hpp"

namespace anticrack::testing {
namespace {

using contact::TipAnswer;
using mesh::Kind;
using std::numbers::pi;

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

/// |x - middle| < width, |y| < height, with free sides x = left and x = right where asked for.
mesh::Geometry rectangle(double left, double right, double height, bool free_left,
                         bool free_right) {
  mesh::Geometry geometry;
  geometry.boundary = {{left, -height}, {right, -height}, {right, height}, {left, height}};
  if (free_right) geometry.neumann.push_back({{right, -height}, {right, height}});
  if (free_left) geometry.neumann.push_back({{left, height}, {left, -height}});
  return geometry;
}

mesh::LineSpec line(double from, double to) {
  mesh::LineSpec line;
  line.points = {{from, 0}, {to, 0}};
  return line;
}

Measured measure_in(const mesh::Geometry& geometry, double size, const std::string& boundary) {
  mesh::MeshOptions options;
  options.size = size;
  return measure(accuracy::generated(geometry, options), with_boundary(boundary));
}

Measured crack_in(mesh::Geometry geometry, double from, double to, double size,
                  const std::string& boundary) {
  geometry.cracks = {{"crack", {}, true, line(from, to)}};
  return measure_in(geometry, size, boundary);
}

void expect_k(const char* of, const TipAnswer& tip, double k) {
  std::printf("[ figures  ] %s: K_III %.3f %%, G %.3f %%\n", of, 100 * (*tip.k_iii / k - 1),
              100 * (*tip.energy_release_rate / (k * k / 2) - 1));
  EXPECT_NEAR(*tip.k_iii, k, 1e-3 * k);
  EXPECT_NEAR(*tip.energy_release_rate, k * k / 2, 2e-3 * k * k / 2);
}

/// Of period W = 2 between planes of symmetry, which are free edges, under the flux 1 far away.
TEST(TipsOfCracks, InARow) {
  for (const double a : {0.5, 0.75}) {
    constexpr double height = 4;
    const double opening = -2 / pi * std::log(std::cos(pi * a / 2));
    const Measured measured = crack_in(rectangle(-1, 1, height, true, true), -a, a, 0.1,
                                       text_of((height + opening) / height) + "*y");
    for (const double x : {-a, a})
      expect_k("row", measured.tip(x), std::sqrt(2 * std::tan(pi * a / 2)));
  }
}

TEST(TipsOfCracks, BetweenHeldEdges) {
  for (const double a : {0.5, 1.0}) {
    const Measured measured = crack_in(rectangle(-5, 5, 1, true, true), -a, a, 0.2, "y");
    for (const double x : {-a, a})
      expect_k("strip", measured.tip(x), std::sqrt(2 * std::tanh(pi * a / 2)));
  }
}

/// Normal to x = 0, half of two cracks in a plane.
TEST(TipsOfCracks, BesideAFreeEdge) {
  for (const auto& [inner, outer] : {std::pair(0.1, 1.1), std::pair(1.0, 3.0)}) {
    const double far = 8 * outer, k = std::sqrt(1 - inner * inner / (outer * outer)),
                 e = outer * outer * std::comp_ellint_2(k) / std::comp_ellint_1(k),
                 q = std::sqrt(outer * outer - inner * inner);
    const double dipole = (inner * inner + outer * outer) / 2 - e;  // (r^-3 follows)
    const Measured measured = crack_in(rectangle(0, far, far, true, false), inner, outer,
                                       0.4 * outer, "y + " + text_of(dipole) + "*y/(x^2 + y^2)");
    expect_k("inner tip", measured.tip(inner), std::sqrt(pi / inner) * (e - inner * inner) / q);
    expect_k("outer tip", measured.tip(outer), std::sqrt(pi / outer) * (outer * outer - e) / q);
  }
}

/// A rigid line |x| < a, its minus face open for b_1 < x < b_2, u = s_x x + s_y y far away.
TEST(TipsOfFronts, OfALineThatIsDebondedInPart) {
  using std::complex;
  struct Debonded {
    double b1, b2, sx, sy;
  };
  constexpr double a = 0.5, far = 20;
  for (const auto& [b1, b2, sx, sy] :
       {Debonded{-0.25, 0.25, 0, 1}, Debonded{-0.4, 0.4, 0, 1}, Debonded{-0.3, 0.2, 0.25, 1}}) {
    const double psi1 = -std::acos(b1 / a), psi2 = -std::acos(b2 / a), mu = (psi1 + psi2) / 2,
                 delta = std::abs(psi2 - psi1) / 2;
    const complex<double> x2 = a * complex(sx, -sy) / 2.0,
                          x1 = -x2 * std::polar(1.0, mu) * std::cos(delta);
    const auto y = [&](double psi) {
      return 2 * std::imag(x2 * std::polar(1.0, (3 * psi - mu) / 2) +
                           x1 * std::polar(1.0, (psi - mu) / 2));
    };
    ASSERT_GT(y(psi1), 0);
    ASSERT_LT(y(psi2), 0);
    mesh::Geometry geometry = rectangle(-far, far, far, false, false);
    mesh::InclusionSpec body;
    body.name = "line";
    body.line = line(-a, a);
    body.stretches = {{(b1 + a) / (2 * a), (b2 + a) / (2 * a)}};
    geometry.inclusions = {body};
    const Measured measured = measure_in(geometry, 1, text_of(sx) + "*x + " + text_of(sy) + "*y");
    for (const auto& [b, psi] : {std::pair(b1, psi1), std::pair(b2, psi2)}) {
      const TipAnswer& tip = measured.tip(b);
      const double c = 2 * std::abs(y(psi)) / std::sqrt(2 * a * std::sin(delta) * -std::sin(psi)),
                   g = pi * c * c / 8;
      std::printf("[ figures  ] front at %g: c %.3f %%, G %.3f %%\n", b,
                  100 * (*tip.intensity / c - 1), 100 * (*tip.energy_release_rate / g - 1));
      EXPECT_EQ(tip.kind, mesh::TipKind::front);
      EXPECT_NEAR(*tip.intensity, c, 3e-3 * c);
      EXPECT_NEAR(*tip.energy_release_rate, g, 6e-3 * g);
    }
  }
}

}  // namespace
}  // namespace anticrack::testing
