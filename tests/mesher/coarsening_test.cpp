// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/coarsening.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "support/paper_geometry.hpp"

namespace anticrack {
namespace {

constexpr std::size_t plenty = 100'000'000;

mesh::Plan plan_of(double size, const mesh::Geometry& geometry = testing::paper_geometry()) {
  return mesh::plan(geometry, {mesh::Preset::uniform, size}, plenty);
}

TEST(Coarsening, SmallMeshesAreMeshedAtOnce) {
  EXPECT_EQ(mesher::halvings(plan_of(0.05)), 0);
  EXPECT_EQ(mesher::halvings(plan_of(0.016)), 0);  // 36,000 triangles
}

TEST(Coarsening, LeavesTenToFortyThousandTrianglesToGmsh) {
  for (const double size : {0.015, 0.01, 0.005, 0.002, 0.001}) {
    const mesh::Plan plan = plan_of(size);
    const int halvings = mesher::halvings(plan);
    EXPECT_GT(halvings, 0) << size;
    const std::size_t coarse = plan.triangles >> (2 * halvings);
    EXPECT_GE(coarse, 10'000U) << size;
    EXPECT_LT(coarse, 40'000U) << size;
  }
}

TEST(Coarsening, NoCurveGetsFewerIntervals) {
  const mesh::Plan plan = plan_of(0.0037);
  const int halvings = mesher::halvings(plan);
  ASSERT_GT(halvings, 0);
  const mesh::Plan coarse = mesher::coarsened(plan, halvings);
  ASSERT_EQ(coarse.curves.size(), plan.curves.size());
  for (std::size_t i = 0; i < plan.curves.size(); ++i) {
    const int made = coarse.curves[i].intervals << halvings;
    EXPECT_GE(made, plan.curves[i].intervals);
    EXPECT_LT(made, plan.curves[i].intervals + (1 << halvings));
  }
}

/// Twenty lines a tenth of the size apart: halving would make their edges far too short.
TEST(Coarsening, ManyFineCurvesAreNotMadeFiner) {
  mesh::Geometry geometry = testing::paper_geometry();
  for (int i = 0; i < 20; ++i) {
    const double y = 0.5 + 0.001 * i;
    geometry.cracks.push_back({"c" + std::to_string(i),
                               {},
                               true,
                               mesh::LineSpec{mesh::Shape::polyline, {{-0.5, y}, {0.5, y}}}});
  }
  EXPECT_GT(mesher::halvings(plan_of(0.01)), 0);
  EXPECT_EQ(mesher::halvings(plan_of(0.01, geometry)), 0);
}

/// A square with a hole, whose chords become longer ones that lie on the circle, too.
TEST(Coarsening, ChordsOfABendAreJoined) {
  mesh::Geometry geometry = testing::paper_geometry();
  geometry.holes = {{"hole", {mesh::Shape::circle, {{0.3, 0.5}}, 0.25}}};
  const mesh::Plan plan = plan_of(0.005, geometry);
  const int halvings = mesher::halvings(plan);
  ASSERT_GE(halvings, 2);
  const mesh::Plan coarse = mesher::coarsened(plan, halvings);
  const auto on_bends = [](const mesh::Plan& of) {
    return std::ranges::count_if(of.curves, [](const auto& curve) { return curve.bend >= 0; });
  };
  EXPECT_GE(on_bends(coarse) << halvings, on_bends(plan));
  EXPECT_LT(on_bends(coarse) << halvings, 1.1 * static_cast<double>(on_bends(plan)));
  for (const mesh::PlannedCurve& curve : coarse.curves) {
    if (curve.bend < 0) continue;
    for (const int end : {curve.a, curve.b}) {
      const auto [x, y] = coarse.points[at(end)];
      EXPECT_NEAR(std::hypot(x - 0.3, y - 0.5), 0.25, 1e-15);
    }
    EXPECT_EQ(coarse.bends[at(curve.bend)].at(curve.from), coarse.points[at(curve.a)]);
    EXPECT_EQ(coarse.bends[at(curve.bend)].at(curve.to), coarse.points[at(curve.b)]);
  }
}

/// A circle of 72 chords, each far shorter than the edges, keeps them: eight times as many would be
/// most of the mesh.
TEST(Coarsening, ChordsOfASmallCircleStay) {
  mesh::Geometry geometry = testing::paper_geometry();
  geometry.holes = {{"hole", {mesh::Shape::circle, {{0.3, 0.5}}, 0.01}}};
  const mesh::Plan plan = plan_of(0.005, geometry);
  const int halvings = mesher::halvings(plan);
  const mesh::Plan coarse = mesher::coarsened(plan, halvings);
  const auto on_bends = [](const mesh::Plan& of) {
    return std::ranges::count_if(of.curves, [](const auto& curve) { return curve.bend >= 0; });
  };
  EXPECT_EQ(on_bends(coarse), on_bends(plan));
}

}  // namespace
}  // namespace anticrack
