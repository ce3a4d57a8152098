// SPDX-License-Identifier: GPL-3.0-or-later
//
// Numbers of tips against solutions in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "tips/measured.hpp"

namespace anticrack::testing {
namespace {

using contact::TipAnswer;
using mesh::Kind;
using mesh::TipKind;
using std::numbers::pi;

/// R = (z^2 - a^2)^(1/2); near the right tip (2a)^(1/2) r^(1/2) e^(i theta/2), and 2a = 1.
const Power root(0.5, 0.5);

void print(const char* name, const Measured& measured, double intensity, double g) {
  const TipAnswer& tip = measured.right();
  std::printf("[ figures  ] %s, %zu triangles: intensity %.6f (%.3f %%)", name,
              measured.op->mesh().triangle_count(), tip.intensity.value_or(NAN),
              100 * (tip.intensity.value_or(NAN) / intensity - 1));
  if (tip.energy_release_rate)
    std::printf(", G %.6f (%.3f %%, spread %.3f %%)", *tip.energy_release_rate,
                100 * (*tip.energy_release_rate / g - 1),
                100 * *tip.energy_release_rate_spread / g);
  std::printf("\n");
}

void expect_near(double value, double exact, double relative) {
  EXPECT_NEAR(value, exact, relative * std::abs(exact));
}

/// u = s Im R: K_III = T s (pi a)^(1/2), G = K_III^2/(2 T).
TEST(TipsOfCracks, HaveTheIntensityOfAPlane) {
  const double k = shear * std::sqrt(pi / 2), g = k * k / 2;
  for (const Kind kind : {Kind::crack, Kind::free}) {
    const Measured measured =
        measure(fine(cut_square(kind)), with_boundary(text_of(shear) + "*" + root.imaginary()));
    print("crack in a plane", measured, shear, g);
    ASSERT_EQ(measured.answer.tips.size(), 2U);
    for (const TipAnswer& tip : measured.answer.tips) {
      EXPECT_EQ(tip.kind, TipKind::crack_tip);
      EXPECT_EQ(tip.interface, "sigma");
      EXPECT_FALSE(tip.closed);
      EXPECT_EQ(tip.exponent, 0.5);
      EXPECT_EQ(tip.reason, "");
      expect_near(*tip.k_iii, k, 1e-3);
      expect_near(*tip.energy_release_rate, g, 1e-3);
      expect_near(*tip.intensity, shear, 1e-3);
      EXPECT_LT(*tip.energy_release_rate_spread, 2e-3 * g);
    }
  }
}

/// Pulled the other way a crack without contact has the opposite intensity, one with contact none:
/// t < 0 is another branch.
TEST(TipsOfCracks, PushedTogetherAreClosedOrNegative) {
  const fem::Load load = with_boundary(text_of(-shear) + "*" + root.imaginary());
  const Measured open = measure(fine(cut_square(Kind::free)), load);
  expect_near(*open.right().k_iii, -shear * std::sqrt(pi / 2), 1e-3);
  expect_near(*open.left().intensity, -shear, 1e-3);
  const Measured closed = measure(fine(cut_square(Kind::crack)), load);
  for (const TipAnswer& tip : closed.answer.tips) {
    EXPECT_TRUE(tip.closed);
    EXPECT_EQ(tip.intensity, 0);
    EXPECT_EQ(tip.k_iii, 0);
    EXPECT_EQ(tip.energy_release_rate, 0);
    EXPECT_EQ(tip.reason, "");
  }
}

/// u = A - Re[e^(i pi/4) (z + a)^(3/4) (z - a)^(1/4)]: c = (2a)^(3/4) at the right tip. The left
/// one has r^(3/4) alone.
TEST(TipsOfDelaminatedEnds, HaveTheFactorOfTheExactSolution) {
  const Power power(0.75, 0.25);
  const Measured measured =
      measure(fine(cut_square(Kind::delaminated)), with_boundary("0.3 - " + power.turned(pi / 4)));
  print("delaminated end", measured, 1, 0);
  const TipAnswer& tip = measured.right();
  EXPECT_EQ(tip.kind, TipKind::delaminated_end);
  EXPECT_FALSE(tip.closed);
  EXPECT_NEAR(*tip.exponent, 0.25, 1e-15);
  expect_near(*tip.intensity, 1, 3e-3);
  EXPECT_FALSE(tip.energy_release_rate || tip.k_iii || tip.energy_release_rate_spread);
  EXPECT_LT(*measured.left().intensity, 3e-3);

  const Power image(0.75, 0.25, "(0-x)");  // left ends reflect
  const Measured mirrored =
      measure(fine(cut_square(Kind::delaminated)), with_boundary("0.3 - " + image.turned(pi / 4)));
  expect_near(*mirrored.left().intensity, 1, 3e-3);
  EXPECT_LT(*mirrored.right().intensity, 3e-3);
}

/// Bonded on both sides: u = B x + (s - B) Re R + k Re(z R) - g y, factors s - B + k a on the right
/// and -(s - B) + k a on the left. B = 0 unless it tilts.
TEST(TipsOfBondedEnds, HaveTheFactorOfTheExactSolution) {
  for (const double b : {0.0, -0.75}) {
    const double s = 0.5, k = 0.375, g = 0.625;
    const std::string text = text_of(b) + "*x + " + text_of(s - b) + "*" + root.real() + " + " +
                             text_of(k) + "*(x*" + root.real() + " - y*" + root.imaginary() +
                             ") - " + text_of(g) + "*y";
    fem::Load load = with_boundary(text);
    const double moment = pi / 4 * (b - s);
    mesh::Mesh mesh = fine(cut_square(Kind::inclusion));
    if (b != 0) {
      mesh = tilting(std::move(mesh));
      load.inclusion_moments = {{"stiffener", {moment, 0}}};
    }
    const Measured measured = measure(std::move(mesh), load);
    print(b == 0 ? "bonded end" : "bonded end that tilts", measured, s - b + k / 2, 0);
    expect_near(*measured.right().intensity, s - b + k / 2, 2e-3);
    expect_near(*measured.left().intensity, -(s - b) + k / 2, 2e-3);
    EXPECT_EQ(measured.right().kind, TipKind::bonded_end);
    EXPECT_FALSE(measured.right().energy_release_rate);
  }
}

/// The lower half of a crack in a plane on a rigid line y = 0 that tilts by B: G = pi T c^2/8.
struct Front {
  double b = 0;
  Measured measured;

  explicit Front(double slope) : b(slope) {
    mesh::Mesh mesh = fine(cut_square(Kind::delaminated, Kind::inclusion));
    if (b != 0) mesh = tilting(std::move(mesh));
    measured = measure(std::move(mesh),
                       with_boundary(text_of(b) + "*x + (y < 0 ? " + text_of(shear) + "*" +
                                     root.imaginary() + " : 0)"),
                       true);
  }
};

TEST(TipsOfFronts, HaveTheRateOfHalfACrack) {
  const double g = pi * shear * shear / 8;
  for (const double b : {0.0, 0.7}) {
    const Front front(b);
    print(b == 0 ? "front" : "front that tilts", front.measured, shear, g);
    for (const TipAnswer* tip : {&front.measured.right(), &front.measured.left()}) {
      EXPECT_EQ(tip->kind, TipKind::front);
      EXPECT_FALSE(tip->closed);
      EXPECT_FALSE(tip->k_iii);
      expect_near(*tip->energy_release_rate, g, 1e-3);
      expect_near(*tip->intensity, shear, 1e-3);
    }
  }
}

/// Without the slope of the inclusion the rate, and the value it gives the faces, are wrong.
TEST(TipsOfFronts, ThatTiltNeedTheSlope) {
  const double g = pi * shear * shear / 8;
  Front front(0.7);
  const Prepared prepared(front.measured.op->mesh());
  for (std::size_t i = 0; i < 2; ++i) {
    const tips::Integrals whole = prepared.integrals(i, front.measured.answer, 0.0);
    for (const double rate : whole.rates) expect_near(rate, g, 2e-3);
    expect_near(whole.intensity, shear, 3e-3);
  }
  for (contact::InclusionAnswer& body : front.measured.answer.inclusions) body.slope_x_mesh = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const tips::Integrals mutant = prepared.integrals(i, front.measured.answer, 0.0);
    std::printf("[ figures  ] without the slope: G %.1f %%, %.1f %%, %.1f %%, intensity %.1f %%\n",
                100 * (mutant.rates[0] / g - 1), 100 * (mutant.rates[1] / g - 1),
                100 * (mutant.rates[2] / g - 1), 100 * (mutant.intensity / shear - 1));
    for (const double rate : mutant.rates) EXPECT_GT(std::abs(rate - g), 0.02 * g);
    EXPECT_GT(std::abs(mutant.intensity - shear), 0.02 * shear);
  }
}

}  // namespace
}  // namespace anticrack::testing
