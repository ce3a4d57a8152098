// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tips on arcs, and a crack between free edges.
#include <gtest/gtest.h>

#include <fmt/core.h>

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
using Complex = std::complex<double>;

/// The arc of half-angle `half` of the circle |z| = 1, its top at i, in the field sx x + sy y of an
/// infinite sheet: u = Re F, F = h + X q with h = (t z +- conj(t)/z)/2, t = sx - i sy,
/// X = ((z - p)(z - p'))^(1/2), ends p and p', q = t/2 -+ conj(t)/(2 X(0) z), regular at 0. Above:
/// Im F = 0 on the arc, a crack; below: Re F = 0, a rigid arc. Near an end u - u(p) has the factor
/// |p - p'|^(1/2) |q(p)|.
struct Arc {
  double half, sx, sy;
  bool rigid;
  Complex right = std::polar(1.0, pi / 2 - half), left = std::polar(1.0, pi / 2 + half);
  double turn = std::arg((Complex(0, 1) - right) / (Complex(0, 1) - left));

  Complex root(Complex z) const {
    const Complex v = -(z - right) / (z - left) * std::polar(1.0, -turn);
    return (z - left) * std::sqrt(v) * std::polar(1.0, (turn - pi) / 2);
  }
  Complex pull() const { return {sx, -sy}; }
  Complex residue() const {
    return (rigid ? 1.0 : -1.0) * std::conj(pull()) / (2.0 * root(0));
  }
  double factor(Complex end) const {
    return std::sqrt(2 * std::sin(half)) * std::abs(pull() / 2.0 + residue() / end);
  }
  std::string boundary() const {
    const auto n = [](double value) { return text_of(value); };
    const std::string from_right_x = "(x - " + n(right.real()) + ")",
                      from_left_x = "(x - " + n(left.real()) + ")",
                      from_y = "(y - " + n(right.imag()) + ")", square = "(x^2 + y^2)",
                      mr = "(" + from_right_x + "*" + from_left_x + " + " + from_y + "^2)",
                      mi = "(" + from_y + "*(" + from_left_x + " - " + from_right_x + "))",
                      c = n(std::cos(turn)), s = n(std::sin(turn));
    const std::string angle =
        "(atan2(" + from_y + ", " + from_left_x + ") + 0.5*atan2(" + s + "*" + mr + " - " + c +
        "*" + mi + ", 0 - " + c + "*" + mr + " - " + s + "*" + mi + ") + " + n((turn - pi) / 2) +
        ")";
    const std::string size = "(((" + from_right_x + "^2 + " + from_y + "^2)*(" + from_left_x +
                             "^2 + " + from_y + "^2))^0.25)";
    const Complex t = pull(), r = residue();
    const std::string qr = "(" + n(t.real() / 2) + " + (" + n(r.real()) + "*x + " + n(r.imag()) +
                           "*y)/" + square + ")",
                      qi = "(" + n(t.imag() / 2) + " + (" + n(r.imag()) + "*x - " + n(r.real()) +
                           "*y)/" + square + ")";
    return "0.5*(" + n(t.real()) + "*x - " + n(t.imag()) + "*y)*(1 " + (rigid ? "-" : "+") +
           " 1/" + square + ") + " + size + "*(cos(" + angle + ")*" + qr + " - sin(" + angle +
           ")*" + qi + ")";
  }
  Measured measured() const {
    mesh::Geometry geometry;
    geometry.boundary = {{-2, -1.5}, {2, -1.5}, {2, 2.5}, {-2, 2.5}};
    const auto at = [](Complex z) { return mesh::Point{z.real(), z.imag()}; };
    mesh::LineSpec line;
    line.shape = mesh::Shape::arc;
    line.points = {at(right), {0, 1}, at(left)};
    if (rigid) {
      geometry.inclusions = {{"arc", {}, {}}};
      geometry.inclusions[0].line = line;
    } else {
      geometry.cracks = {{"arc", {}, false}};
      geometry.cracks[0].line = line;
    }
    return measure(accuracy::generated(geometry, {}), with_boundary(boundary()), true);
  }
};

TEST(TipsOnArcs, HaveTheFactorsOfAnInfiniteSheet) {
  for (const double degrees : {30.0, 60.0}) {
    for (const bool rigid : {false, true}) {
      const Arc arc{degrees * pi / 180, 0.4, 1, rigid};
      const Measured measured = arc.measured();
      const Prepared prepared(measured.op->mesh());
      ASSERT_EQ(measured.answer.tips.size(), 2U);
      for (std::size_t i = 0; i < 2; ++i) {
        const TipAnswer& tip = measured.answer.tips[i];
        ASSERT_EQ(tip.reason, "");
        const double exact = arc.factor({tip.x, tip.y}),
                     sum = arc.sy * std::cos(arc.half / 2),
                     difference = (tip.x > 0 ? 1 : -1) * arc.sx * std::sin(arc.half / 2),
                     k = std::sqrt(pi * std::sin(arc.half)) * std::abs(sum - difference),
                     other = std::sqrt(pi * std::sin(arc.half)) * std::abs(sum + difference);
        const tips::Integrals found = prepared.integrals(i, measured.answer, 0.0);
        std::printf("[ figures  ] %s of %g degrees, %zu triangles: factor %.3f %%, by the dual "
                    "function %.3f %%\n",
                    rigid ? "rigid arc" : "arc", degrees, measured.op->mesh().triangle_count(),
                    100 * (std::abs(*tip.intensity) / exact - 1),
                    100 * (std::abs(found.intensity) / exact - 1));
        EXPECT_NEAR(std::abs(*tip.intensity), exact, 2e-3 * exact);
        EXPECT_NEAR(std::abs(found.intensity), exact, 5e-3 * exact);
        if (rigid) continue;
        const double of_exact = exact * std::sqrt(pi / 2);
        EXPECT_LT(std::min(std::abs(of_exact - k), std::abs(of_exact - other)), 1e-12);
        EXPECT_NEAR(std::abs(*tip.k_iii), of_exact, 2e-3 * of_exact);
      }
    }
  }
}

/// sn(u | m) by descending Landen transformations.
double sn(double u, double m) {
  if (m < 1e-30) return std::sin(u);
  const double low = (1 - std::sqrt(1 - m)) / (1 + std::sqrt(1 - m)),
               v = u / (1 + low);
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
    mesh::Mesh base = cut_square([a](double x) {
      return std::abs(x) < a ? Kind::crack : Kind::glue;
    });
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
