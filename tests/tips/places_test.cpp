// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where tips are, what they are, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/grid_mesh.hpp"
#include "tips/measured.hpp"

namespace anticrack::testing {
namespace {

using contact::TipAnswer;
using mesh::Kind;
using mesh::TipKind;

/// What all tips of a mesh are, under f = 1.
Measured pressed(const mesh::Mesh& mesh) {
  fem::Load load = with_boundary("0");
  load.force = 1.0;
  return measure(mesh, load);
}

mesh::Mesh grid(const std::vector<GridMesh::Point>& corners, std::vector<Kind> kinds,
                std::int32_t inclusion = -1) {
  GridMesh made(16, 16, {"all"}, [](int, int) { return 0; });
  if (inclusion >= 0) made.mesh.inclusions = {"fibre"};
  made.add(corners, kinds, inclusion);
  return made.mesh;
}

TEST(TipPlaces, OfALineOfAllKinds) {
  std::vector<Kind> kinds(4, Kind::delaminated);
  kinds.insert(kinds.end(), 4, Kind::inclusion);
  const Measured measured = pressed(fine(grid({{4, 8}, {12, 8}}, kinds, 0)));
  ASSERT_EQ(measured.answer.tips.size(), 3U);
  EXPECT_EQ(measured.tip(4, 8).kind, TipKind::delaminated_end);
  EXPECT_EQ(measured.tip(8, 8).kind, TipKind::front);
  EXPECT_EQ(measured.tip(12, 8).kind, TipKind::bonded_end);
  for (const TipAnswer& tip : measured.answer.tips) EXPECT_EQ(tip.reason, "");
}

TEST(TipPlaces, WhereACrackCrossesAnotherHaveAReason) {
  GridMesh made(16, 16, {"all"}, [](int, int) { return 0; });
  made.add({{4, 8}, {8, 8}}, std::vector<Kind>(4, Kind::crack));
  made.mesh.inclusions = {"fibre"};
  made.add({{8, 4}, {8, 12}}, std::vector<Kind>(8, Kind::inclusion), 0);
  const Measured measured = pressed(fine(made.mesh));
  const TipAnswer& tip = measured.tip(8, 8);
  EXPECT_EQ(tip.kind, TipKind::other);
  EXPECT_NE(tip.reason.find("meet"), std::string::npos);
  EXPECT_FALSE(tip.intensity || tip.exponent || tip.energy_release_rate);
  EXPECT_EQ(measured.tip(8, 12).kind, TipKind::bonded_end);
  EXPECT_EQ(measured.tip(8, 12).reason, "");
}

TEST(TipPlaces, OnTheBoundaryHaveAReason) {
  GridMesh made(8, 8, {"all"}, [](int, int) { return 0; });
  made.mesh.inclusions = {"fibre"};
  made.add({{0, 4}, {4, 4}, {4, 8}},
           {Kind::inclusion, Kind::inclusion, Kind::inclusion, Kind::inclusion, Kind::delaminated,
            Kind::delaminated, Kind::delaminated, Kind::delaminated},
           0);
  const Measured measured = pressed(made.mesh);
  const TipAnswer& front = measured.tip(4, 4);
  EXPECT_EQ(front.kind, TipKind::front);
  EXPECT_NE(front.reason.find("bends"), std::string::npos);
}

/// The ways of few triangles, and of a point force.
TEST(TipPlaces, WithoutRoomHaveAReason) {
  const Measured coarse = pressed(grid({{6, 8}, {8, 8}}, std::vector<Kind>(2, Kind::crack)));
  for (const TipAnswer& tip : coarse.answer.tips) {
    EXPECT_EQ(tip.kind, TipKind::crack_tip);
    EXPECT_NE(tip.reason.find("triangles"), std::string::npos) << tip.reason;
    EXPECT_FALSE(tip.intensity);
  }
  fem::Load load = with_boundary("0");
  load.point_forces = {{12.5, 8.5, 1}};
  const Measured measured =
      measure(fine(grid({{4, 8}, {12, 8}}, std::vector<Kind>(8, Kind::free))), load);
  EXPECT_NE(measured.tip(12, 8).reason.find("point force"), std::string::npos);
  EXPECT_EQ(measured.tip(4, 8).reason, "");
}

/// A short straight piece: the radius shrinks to it, and the number stays that of the tip. Both
/// tips of a crack that is bent once.
TEST(TipPlaces, OfABentCrackHaveTheRadiusOfTheirPiece) {
  const mesh::Mesh mesh = fine(grid({{5, 8}, {11, 8}, {11, 10}}, std::vector<Kind>(8, Kind::free)));
  fem::Load load = with_boundary("y");
  const Measured measured = measure(mesh, load);
  ASSERT_EQ(measured.answer.tips.size(), 2U);
  for (const TipAnswer& tip : measured.answer.tips) {
    EXPECT_EQ(tip.reason, "");
    EXPECT_GT(*tip.energy_release_rate, 0);
    std::printf("[ figures  ] bent crack at %g, %g: G %.6f, spread %.2f %%\n", tip.x, tip.y,
                *tip.energy_release_rate,
                100 * *tip.energy_release_rate_spread / *tip.energy_release_rate);
    EXPECT_LT(*tip.energy_release_rate_spread, 0.02 * *tip.energy_release_rate);
  }
}

}  // namespace
}  // namespace anticrack::testing
