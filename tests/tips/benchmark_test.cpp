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
  double chord_angle;  ///< degrees
  Complex right = std::polar(1.0, pi / 2 - half), left = std::polar(1.0, pi / 2 + half);
  double turn = std::arg((Complex(0, 1) - right) / (Complex(0, 1) - left));

  Complex root(Complex z) const {
    const Complex v = -(z - right) / (z - left) * std::polar(1.0, -turn);
    return (z - left) * std::sqrt(v) * std::polar(1.0, (turn - pi) / 2);
  }
  Complex pull() const { return {sx, -sy}; }
  Complex residue() const { return (rigid ? 1.0 : -1.0) * std::conj(pull()) / (2.0 * root(0)); }
  double factor(Complex end) const {
    return std::sqrt(2 * std::sin(half)) * std::abs(pull() / 2.0 + residue() / end);
  }
  /// Of the crack, as handbooks have it.
  double stress_intensity(bool at_right) const {
    return std::sqrt(pi * std::sin(half)) *
           std::abs(sy * std::cos(half / 2) + (at_right ? 1 : -1) * sx * std::sin(half / 2));
  }
  std::string boundary() const {
    const auto n = [](double value) { return text_of(value); };
    const std::string from_right_x = "(x - " + n(right.real()) + ")",
                      from_left_x = "(x - " + n(left.real()) + ")",
                      from_y = "(y - " + n(right.imag()) + ")", square = "(x^2 + y^2)",
                      mr = "(" + from_right_x + "*" + from_left_x + " + " + from_y + "^2)",
                      mi = "(" + from_y + "*(" + from_left_x + " - " + from_right_x + "))",
                      c = n(std::cos(turn)), s = n(std::sin(turn));
    const std::string angle = "(atan2(" + from_y + ", " + from_left_x + ") + 0.5*atan2(" + s + "*" +
                              mr + " - " + c + "*" + mi + ", 0 - " + c + "*" + mr + " - " + s +
                              "*" + mi + ") + " + n((turn - pi) / 2) + ")";
    const std::string size = "(((" + from_right_x + "^2 + " + from_y + "^2)*(" + from_left_x +
                             "^2 + " + from_y + "^2))^0.25)";
    const Complex t = pull(), r = residue();
    const std::string qr = "(" + n(t.real() / 2) + " + (" + n(r.real()) + "*x + " + n(r.imag()) +
                           "*y)/" + square + ")",
                      qi = "(" + n(t.imag() / 2) + " + (" + n(r.imag()) + "*x - " + n(r.real()) +
                           "*y)/" + square + ")";
    return "0.5*(" + n(t.real()) + "*x - " + n(t.imag()) + "*y)*(1 " + (rigid ? "-" : "+") + " 1/" +
           square + ") + " + size + "*(cos(" + angle + ")*" + qr + " - sin(" + angle + ")*" + qi +
           ")";
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
    mesh::MeshOptions options;
    options.chord_angle = chord_angle;
    return measure(accuracy::generated(geometry, options), with_boundary(boundary()), true);
  }
};

/// A mesh has chords, whose tips come near those of the arc with the square of the angle. The
/// factor at one end of a rigid arc is small beside that of the other, which measures the error.
TEST(TipsOnArcs, ComeNearTheFactorsOfAnInfiniteSheet) {
  for (const bool rigid : {false, true}) {
    double coarse = 0;
    for (const double chord_angle : {10.0, 2.5}) {
      const Arc arc{pi / 3, 0.4, 1, rigid, chord_angle};
      const double size = std::max(arc.factor(arc.right), arc.factor(arc.left));
      const Measured measured = arc.measured();
      const Prepared prepared(measured.op->mesh());
      ASSERT_EQ(measured.answer.tips.size(), 2U);
      double error = 0;
      for (std::size_t i = 0; i < 2; ++i) {
        const TipAnswer& tip = measured.answer.tips[i];
        ASSERT_EQ(tip.reason, "");
        const double exact = arc.factor({tip.x, tip.y});
        const double dual = std::abs(prepared.integrals(i, measured.answer, 0.0).intensity);
        EXPECT_NEAR(dual, std::abs(*tip.intensity), 1e-2 * size);
        error = std::max(error, std::abs(std::abs(*tip.intensity) - exact));
        if (!rigid) {
          EXPECT_NEAR(arc.stress_intensity(tip.x > 0), exact * std::sqrt(pi / 2), 1e-12);
        }
      }
      std::printf("[ figures  ] %s, chords of %g degrees, %zu triangles: factors within %.3f %%\n",
                  rigid ? "rigid arc" : "arc", chord_angle, measured.op->mesh().triangle_count(),
                  100 * error / size);
      if (coarse > 0) {
        EXPECT_LT(error, coarse);
        EXPECT_LT(error, 4e-3 * size);
      }
      coarse = error;
    }
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
