// SPDX-License-Identifier: GPL-3.0-or-later
//
// Contact near tips, and how their numbers follow the load.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "accuracy/base_meshes.hpp"
#include "tips/measured.hpp"

namespace anticrack::testing {
namespace {

using contact::TipAnswer;
using mesh::Kind;

/// Pushes the faces together over the middle, apart elsewhere.
fem::Load partly_closing() {
  fem::Load load = with_boundary("0");
  load.force = fem::Expression{"y > 0 ? 2 : (x < 0.15 && x > -0.2 ? 25 : -10)"};
  return load;
}

/// All kinds of tips.
std::vector<mesh::Mesh> meshes() {
  return {fine(cut_square(Kind::crack)), fine(cut_square(Kind::delaminated)),
          fine(cut_square(Kind::delaminated, Kind::inclusion)), fine(cut_square(Kind::inclusion))};
}

TEST(Tips, OfTwiceTheLoadHaveTwiceTheIntensity) {
  for (const mesh::Mesh& mesh : meshes()) {
    fem::Load load = partly_closing();
    const Measured once = measure(mesh, load);
    std::get<fem::Expression>(load.force).text =
        "2*(" + std::get<fem::Expression>(load.force).text + ")";
    const Measured twice = measure(once.op, load);
    ASSERT_FALSE(once.answer.tips.empty());
    for (std::size_t i = 0; i < once.answer.tips.size(); ++i) {
      const TipAnswer &a = once.answer.tips[i], &b = twice.answer.tips[i];
      EXPECT_EQ(a.closed, b.closed);
      EXPECT_NEAR(*b.intensity, 2 * *a.intensity, 1e-10 * std::abs(*b.intensity));
      EXPECT_NEAR(b.energy_release_rate.value_or(0), 4 * a.energy_release_rate.value_or(0), 1e-10);
    }
  }
}

/// Contact within the cut-off, off the tip: both ways to the intensity of a crack agree, and the
/// one by the dual function needs the forces of the contact.
TEST(Tips, OfPartlyClosedCracksAgreeBetweenTheIntegrals) {
  const fem::Load load = partly_closing();
  for (const Kind outside : {Kind::glue, Kind::inclusion}) {
    const Kind inside = outside == Kind::glue ? Kind::crack : Kind::delaminated;
    mesh::Mesh mesh = fine(cut_square(inside, outside));
    const Prepared prepared(mesh);
    const Measured measured = measure(mesh, load, true);
    EXPECT_GT(measured.answer.contact_length, 0.1);
    for (std::size_t i = 0; i < measured.answer.tips.size(); ++i) {
      const TipAnswer& tip = measured.answer.tips[i];
      const tips::Integrals found = prepared.integrals(i, measured.answer, load.force);
      std::printf(
          "[ figures  ] partly closed: contact %.3f, rates %.5f %.5f %.5f, intensity %.5f by "
          "G, %.5f by the dual function, %s\n",
          measured.answer.contact_length, found.rates[0], found.rates[1], found.rates[2],
          *tip.intensity, found.intensity, tip.closed ? "closed" : "open");
      EXPECT_FALSE(tip.closed);
      EXPECT_NEAR(found.intensity, *tip.intensity, 5e-3 * *tip.intensity);
      EXPECT_LT(*tip.energy_release_rate_spread, 4e-2 * *tip.energy_release_rate);
    }
  }
}

/// Nodes on a slanted line are off it by rounding, which is much beside the edges at a tip.
TEST(Tips, OfTurnedMeshesAreTheSame) {
  const accuracy::Placement turn(0.6, 1);
  for (const mesh::Mesh& mesh : meshes()) {
    fem::Load load = with_boundary("0");
    load.force = fem::PerRegion{{{"lower", -5}, {"upper", 2}}};
    const Measured one = measure(mesh, load), other = measure(turn(mesh), load);
    ASSERT_EQ(one.answer.tips.size(), other.answer.tips.size());
    for (std::size_t i = 0; i < one.answer.tips.size(); ++i) {
      const TipAnswer &a = one.answer.tips[i], &b = other.answer.tips[i];
      EXPECT_EQ(b.reason, "");
      EXPECT_EQ(a.kind, b.kind);
      EXPECT_NEAR(*a.intensity, *b.intensity, 1e-5);
      EXPECT_NEAR(a.energy_release_rate.value_or(0), b.energy_release_rate.value_or(0), 1e-5);
    }
  }
}

TEST(Tips, OfMirroredMeshesAreMirrored) {
  for (const mesh::Mesh& mesh : meshes()) {
    fem::Load load = with_boundary("0");
    load.force = fem::Expression{"y > 0 ? 2 + x : -5 + 3*x + y"};
    const Measured one = measure(mesh, load);
    load.force = fem::Expression{"y > 0 ? 2 - x : -5 - 3*x + y"};
    const Measured other = measure(accuracy::mirrored(mesh, accuracy::Mirror::x), load);
    for (const TipAnswer& tip : one.answer.tips) {
      const TipAnswer& image = other.tip(-tip.x);
      EXPECT_EQ(tip.kind, image.kind);
      EXPECT_NEAR(*tip.intensity, *image.intensity, 1e-9);
    }
  }
}

}  // namespace
}  // namespace anticrack::testing
