// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tips where the tension differs between the sides, between directions, or varies.
#include <gtest/gtest.h>

#include <fmt/core.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "fem/load_parts.hpp"
#include "tips/measured.hpp"
#include "tips/tips.hpp"

namespace anticrack::testing {
namespace {

using contact::TipAnswer;
using mesh::Kind;
using std::numbers::pi;

/// A law along and across `angle`, with what it makes of X = x - slant y, Y = stretch y.
struct Sheet {
  double along = 1, across = 1, angle = 0;

  double root() const { return std::sqrt(along * across); }
  std::array<double, 3> matrix() const {
    const double c = std::cos(angle * pi / 180), s = std::sin(angle * pi / 180);
    return {along * c * c + across * s * s, (along - across) * c * s,
            along * s * s + across * c * c};
  }
  std::string x() const { return "(x - " + text_of(matrix()[1] / matrix()[2]) + "*y)"; }
  std::string y() const { return "(" + text_of(root() / matrix()[2]) + "*y)"; }
  mesh::TensionLaw law() const {
    return {fmt::format("{}", along), fmt::format("{}", across), angle};
  }
};

mesh::Mesh with_laws(mesh::Mesh mesh, const mesh::TensionLaw& below,
                     const mesh::TensionLaw& above) {
  mesh.tension_laws = {below, above};
  return mesh;
}

struct Pair {
  const char* name;
  Sheet below, above;
};
const std::vector<Pair> pairs{{"T+ = 4 T-", {1, 1, 0}, {4, 4, 0}},
                              {"T+ = T-/4", {1, 1, 0}, {0.25, 0.25, 0}},
                              {"4:1 along", {4, 1, 0}, {4, 1, 0}},
                              {"4:1 turned", {4, 1, 30}, {4, 1, 30}},
                              {"two turned", {3, 1, 30}, {1, 2, -50}}};

/// u+- = s (Th/D+-) Im R(X, Y): K_III = s Th (pi a)^(1/2), G = K_III^2/(2 Th).
TEST(TipsOfCracks, BetweenTwoTensions) {
  for (const auto& [name, below, above] : pairs) {
    const double mean = 2 * below.root() * above.root() / (below.root() + above.root()),
                 k = shear * mean * std::sqrt(pi / 2), g = k * k / (2 * mean);
    const auto half = [&](const Sheet& sheet) {
      return text_of(shear * mean / sheet.root()) + "*" +
             Power(0.5, 0.5, sheet.x(), sheet.y()).imaginary();
    };
    const Measured measured =
        measure(with_laws(fine(cut_square(Kind::crack)), below.law(), above.law()),
                with_boundary("y > 0 ? " + half(above) + " : " + half(below)));
    for (const TipAnswer& tip : measured.answer.tips) {
      ASSERT_EQ(tip.reason, "");
      std::printf("[ figures  ] crack, %s: K_III %.3f %%, G %.3f %%\n", name,
                  100 * (*tip.k_iii / k - 1), 100 * (*tip.energy_release_rate / g - 1));
      EXPECT_NEAR(*tip.k_iii, k, 1.5e-3 * k);
      EXPECT_NEAR(*tip.energy_release_rate, g, 3e-3 * g);
    }
  }
}

/// F = (z + a)^(1 - alpha) (z - a)^alpha, u = A + {Im e^(-i alpha pi) F; -beta Re e^(i alpha pi) F}
/// of (X, Y): c = 1 at the right tip.
struct OpenEnd {
  double alpha, beta;
  std::string boundary;

  OpenEnd(const Sheet& below, const Sheet& above) {
    beta = std::sqrt(above.root() / below.root());
    alpha = std::atan(beta) / pi;
    boundary = "0.3 + (y > 0 ? " +
               Power(1 - alpha, alpha, above.x(), above.y()).turned(-alpha * pi - pi / 2) + " : " +
               text_of(-beta) + "*" +
               Power(1 - alpha, alpha, below.x(), below.y()).turned(alpha * pi) + ")";
  }
};

/// The exponent by which [u] falls towards the right tip.
double measured_exponent(const Measured& measured) {
  const contact::Trace& trace = measured.answer.traces[0];
  const contact::TraceGeometry& line = measured.op->trace_geometry()[0];
  double sums[5] = {};
  for (std::size_t i = 0; i < trace.jump.size(); ++i) {
    const double r = 0.5 - line.x[i];
    if (r < 1e-5 || r > 1e-2 || trace.jump[i] <= 0) continue;
    const double x = std::log(r), y = std::log(trace.jump[i]);
    const double terms[5] = {1, x, y, x * x, x * y};
    for (std::size_t k = 0; k < 5; ++k) sums[k] += terms[k];
  }
  return (sums[0] * sums[4] - sums[1] * sums[2]) / (sums[0] * sums[3] - sums[1] * sums[1]);
}

TEST(TipsOfDelaminatedEnds, BetweenTwoTensions) {
  for (const auto& [name, below, above] : pairs) {
    const OpenEnd end(below, above);
    const Measured measured =
        measure(with_laws(fine(cut_square(Kind::delaminated), std::min(0.2, 0.8 * end.alpha)),
                          below.law(), above.law()),
                with_boundary(end.boundary));
    const TipAnswer& tip = measured.right();
    ASSERT_EQ(tip.reason, "");
    std::printf("[ figures  ] delaminated end, %s: exponent %.5f, of u %.5f, factor %.3f %%\n",
                name, *tip.exponent, measured_exponent(measured), 100 * (*tip.intensity - 1));
    EXPECT_NEAR(*tip.exponent, end.alpha, 1e-14);
    EXPECT_NEAR(measured_exponent(measured), end.alpha, 0.01);
    EXPECT_NEAR(*tip.intensity, 1, 3e-3);
  }
}

/// T = (1 + x/2 + 3 y/10) and the field of a crack in a plane, with f = -grad T.grad u.
struct Varying {
  static constexpr const char* law = "1 + 0.5*x + 0.3*y";
  static constexpr double at_right = 1.25;
  mesh::Mesh mesh = with_laws(fine(cut_square(Kind::free)), {law, "", 0}, {law, "", 0});
  fem::Load load = with_boundary(text_of(shear) + "*" + Power(0.5, 0.5).imaginary());

  Varying() {
    // u' = -i s z/R: z/R = z (z + a)^(-1/2) (z - a)^(-1/2)
    const Power inverse(-0.5, -0.5);
    const std::string re = "(x*" + inverse.real() + " - y*" + inverse.imaginary() + ")",
                      im = "(x*" + inverse.imaginary() + " + y*" + inverse.real() + ")";
    load.force = fem::Expression{text_of(-shear) + "*(0.5*" + im + " + 0.3*" + re + ")"};
  }
};

TEST(TipsOfCracks, WhereTheTensionVaries) {
  const Varying varying;
  const Measured measured = measure(varying.mesh, varying.load);
  for (const double at : {0.5, -0.5}) {
    const TipAnswer& tip = measured.tip(at);
    ASSERT_EQ(tip.reason, "");
    const double g = pi * (1 + 0.5 * at) * shear * shear / 4;
    std::printf("[ figures  ] varying tension, tip at %g: G %.3f %%, spread %.3f %%\n", at,
                100 * (*tip.energy_release_rate / g - 1),
                100 * *tip.energy_release_rate_spread / g);
    EXPECT_NEAR(*tip.energy_release_rate, g, 3e-3 * g);
    EXPECT_LT(*tip.energy_release_rate_spread, 3e-3 * g);
  }
}

/// Without the change of T along the crack the rate is wrong, more so on larger discs; without T -
/// T0 the factor is.
TEST(TipsOfCracks, WhereTheTensionVariesNeedItsChange) {
  const Varying varying;
  const Measured measured = measure(varying.mesh, varying.load, true);
  const double at = 1 + 0.5 * 0.5, g = pi * at * shear * shear / 4;
  const std::string number = text_of(at);
  mesh::Mesh flat = varying.mesh;
  flat.tension_laws = {{number, "", 0}, {number, "", 0}};
  const std::size_t right = measured.answer.tips[0].x > 0 ? 0 : 1;
  const tips::Integrals whole =
      Prepared(varying.mesh).integrals(right, measured.answer, varying.load.force);
  EXPECT_NEAR(whole.intensity, shear, 3e-3 * shear);
  const tips::Integrals without_change =
      Prepared(varying.mesh, flat).integrals(right, measured.answer, varying.load.force);
  const tips::Integrals without_law =
      Prepared(flat).integrals(right, measured.answer, varying.load.force);
  std::printf(
      "[ figures  ] varying tension: intensity %.3f %%; without its change G %.2f %%, %.2f %%, "
      "%.2f %%; without T - T0 intensity %.2f %%\n",
      100 * (whole.intensity / shear - 1), 100 * (without_change.rates[0] / g - 1),
      100 * (without_change.rates[1] / g - 1), 100 * (without_change.rates[2] / g - 1),
      100 * (without_law.intensity / shear - 1));
  EXPECT_GT(std::abs(without_change.rates[0] - g), 0.02 * g);
  EXPECT_GT(std::abs(without_law.intensity - shear), 0.01 * shear);
}

TEST(TipsOfCracks, WhereTheTensionMayJumpAreRefused) {
  Varying varying;
  varying.mesh.tension_laws = {{"x > 0.6 ? 2 : 1", "", 0}, {"x > 0.6 ? 2 : 1", "", 0}};
  const Measured measured = measure(varying.mesh, with_boundary("y"));
  EXPECT_NE(measured.right().reason.find("may jump"), std::string::npos);
  EXPECT_FALSE(measured.right().energy_release_rate);
}

}  // namespace
}  // namespace anticrack::testing
