// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/geometry.hpp"
#include "mesh/geometry_intervals.hpp"
#include "support/errors.hpp"
#include "support/paper_geometry.hpp"

namespace anticrack {
namespace {

using mesh::Geometry;
using mesh::Kind;
using mesh::Plan;
using mesh::Point;
using testing::paper_geometry;

constexpr std::size_t enough = 4'000'000;

template <class Curves>
int intervals(const Curves& curves) {
  return std::accumulate(curves.begin(), curves.end(), 0,
                         [](int sum, const auto& curve) { return sum + curve.intervals; });
}

double area(const Plan& plan, const std::vector<mesh::PlannedCurve>& loop) {
  double twice = 0;
  for (const auto& curve : loop) {
    const Point& a = plan.points.at(static_cast<std::size_t>(curve.a));
    const Point& b = plan.points.at(static_cast<std::size_t>(curve.b));
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return twice / 2;
}

/// The closed loop around a subdomain, counterclockwise if the plan keeps its word.
std::vector<mesh::PlannedCurve> loop(const Plan& plan, std::size_t side) {
  std::vector<mesh::PlannedCurve> curves;
  for (const auto& curve : plan.interface) {
    curves.push_back(side == 1 ? mesh::PlannedCurve{curve.a, curve.b, curve.intervals}
                               : mesh::PlannedCurve{curve.b, curve.a, curve.intervals});
  }
  if (side == 0) std::reverse(curves.begin(), curves.end());
  curves.insert(curves.end(), plan.outer[side].begin(), plan.outer[side].end());
  return curves;
}

void expect_closed(const Plan& plan) {
  for (std::size_t side = 0; side < 2; ++side) {
    const auto curves = loop(plan, side);
    for (std::size_t i = 0; i < curves.size(); ++i) {
      EXPECT_EQ(curves[i].b, curves[(i + 1) % curves.size()].a);
    }
  }
}

TEST(Plan, PaperPresetHas80IntervalsOnEachPart) {
  const Plan plan = mesh::plan(paper_geometry(), {}, enough);
  ASSERT_EQ(plan.interface.size(), 3U);
  EXPECT_EQ(plan.interface[0].intervals, 40);
  EXPECT_EQ(plan.interface[1].intervals, 80);
  EXPECT_EQ(plan.interface[2].intervals, 40);
  EXPECT_EQ(plan.interface[0].kind, Kind::glue);
  EXPECT_EQ(plan.interface[1].kind, Kind::delaminated);
  EXPECT_EQ(plan.interface[1].inclusion, 0);
  EXPECT_EQ(plan.inclusions, std::vector<std::string>{"inclusion"});
  for (const auto& outer : plan.outer) {
    ASSERT_EQ(outer.size(), 3U);
    EXPECT_EQ(outer[0].intervals, 20);
    EXPECT_EQ(outer[1].intervals, 40);
    EXPECT_EQ(outer[2].intervals, 20);
  }
}

TEST(Plan, PlusLiesLeftOfTheInterface) {
  Geometry geometry = paper_geometry();
  geometry.boundary = {{-1, -1}, {1, -1}, {1, 2}, {-1, 2}};
  for (const bool clockwise : {false, true}) {
    if (clockwise) std::reverse(geometry.boundary.begin(), geometry.boundary.end());
    const Plan plan = mesh::plan(geometry, {}, enough);
    expect_closed(plan);
    EXPECT_DOUBLE_EQ(area(plan, loop(plan, 0)), 2);
    EXPECT_DOUBLE_EQ(area(plan, loop(plan, 1)), 4);
  }
  std::reverse(geometry.interface.begin(), geometry.interface.end());
  const Plan plan = mesh::plan(geometry, {}, enough);
  expect_closed(plan);
  EXPECT_DOUBLE_EQ(area(plan, loop(plan, 0)), 4);
  EXPECT_DOUBLE_EQ(area(plan, loop(plan, 1)), 2);
}

TEST(Plan, InterfaceMayEndAtCornersOrOnOneEdge) {
  Geometry corners = paper_geometry();
  corners.interface = {{-1, -1}, {1, 1}};
  corners.inclusions.clear();
  const Plan diagonal = mesh::plan(corners, {}, enough);
  expect_closed(diagonal);
  EXPECT_DOUBLE_EQ(area(diagonal, loop(diagonal, 0)), 2);
  EXPECT_EQ(diagonal.outer[0].size(), 2U);
  EXPECT_EQ(diagonal.points.size(), 4U);

  Geometry pocket = corners;
  pocket.interface = {{-0.5, -1}, {-0.5, 0}, {0.5, 0}, {0.5, -1}};
  for (const double plus : {3.0, 1.0}) {
    const Plan plan = mesh::plan(pocket, {}, enough);
    expect_closed(plan);
    EXPECT_DOUBLE_EQ(area(plan, loop(plan, 1)), plus);
    EXPECT_DOUBLE_EQ(area(plan, loop(plan, 0)), 4 - plus);
    std::reverse(pocket.interface.begin(), pocket.interface.end());
  }
}

TEST(Plan, PartlyBondedInclusionBecomesSeveralCurves) {
  Geometry geometry = paper_geometry();
  geometry.interface = {{-1, 0}, {0, 0}, {1, 0}};
  geometry.inclusions = {
      {"a", {{0.5, 0}, {-0.5, 0}}, {{{-0.5, 0}, {-0.25, 0}}, {{0.25, 0}, {0.125, 0}}}},
      {"b", {{0.75, 0}, {0.875, 0}}, {}}};
  geometry.cracks = {{"c", {{-0.75, 0}, {-0.625, 0}}}};
  const Plan plan = mesh::plan(geometry, {}, enough);
  std::vector<std::pair<Kind, int>> kinds;
  for (const auto& curve : plan.interface) kinds.emplace_back(curve.kind, curve.inclusion);
  const std::vector<std::pair<Kind, int>> expected = {
      {Kind::glue, -1},     {Kind::crack, -1},    {Kind::glue, -1},       {Kind::delaminated, 0},
      {Kind::inclusion, 0}, {Kind::inclusion, 0}, {Kind::delaminated, 0}, {Kind::inclusion, 0},
      {Kind::glue, -1},     {Kind::inclusion, 1}, {Kind::glue, -1}};
  EXPECT_EQ(kinds, expected);
  int glue = 0;
  int rest = 0;
  for (const auto& curve : plan.interface)
    (curve.kind == Kind::glue ? glue : rest) += curve.intervals;
  EXPECT_EQ(glue, 80);
  EXPECT_EQ(rest, 80);
}

TEST(Plan, UniformPresetCutsBySize) {
  const Plan plan = mesh::plan(paper_geometry(), {mesh::Preset::uniform, 0.1}, enough);
  EXPECT_EQ(intervals(plan.interface), 20);
  EXPECT_EQ(intervals(plan.outer[0]), 40);
  const Plan standard = mesh::plan(paper_geometry(), {mesh::Preset::uniform, 0}, enough);
  const double size = std::sqrt(8.0) / 50;
  EXPECT_EQ(standard.interface[1].intervals, static_cast<int>(std::ceil(1 / size)));
}

TEST(Plan, TooManyTrianglesAreRefusedBeforeTheyAreMade) {
  for (const double size : {1e-3, 1e-12, 1e-300}) {
    EXPECT_TRUE(testing::throws(
        [&] {
          mesh::plan(paper_geometry(), {mesh::Preset::uniform, size}, 100'000);
        },
        errors::Reason::limit_exceeded, "options.size"));
  }
  EXPECT_TRUE(testing::throws([] { mesh::plan(paper_geometry(), {}, 300); },
                              errors::Reason::limit_exceeded, "options.preset"));
  EXPECT_NO_THROW(mesh::plan(paper_geometry(), {mesh::Preset::uniform, 0.02}, 100'000));
}

TEST(Plan, TipsKeepTheCoordinatesTheyWereGiven) {
  Geometry geometry = paper_geometry();
  geometry.interface = {{-1, -1.0 / 3}, {1, 1.0 / 3}};
  const Point from{-0.3, -0.1};
  const Point to{0.3, 0.1 + 1e-12};
  geometry.inclusions = {{"a", {from, to}, {}}};
  const Plan plan = mesh::plan(geometry, {}, enough);
  EXPECT_EQ(plan.points.at(static_cast<std::size_t>(plan.interface[1].a)), from);
  EXPECT_EQ(plan.points.at(static_cast<std::size_t>(plan.interface[1].b)), to);
}

TEST(Apportion, SharesByLargestRemainder) {
  using Shares = std::vector<int>;
  EXPECT_EQ(mesh::apportion(std::vector<double>{1, 2, 1}, 80), (Shares{20, 40, 20}));
  EXPECT_EQ(mesh::apportion(std::vector<double>{1, 1, 1}, 80), (Shares{27, 27, 26}));
  EXPECT_EQ(mesh::apportion(std::vector<double>{0.1, 0.2, 0.3}, 6), (Shares{1, 2, 3}));
  // 10, 69.3, 0.7 of 80: one comes from where most is left over
  EXPECT_EQ(mesh::apportion(std::vector<double>{10, 69.3, 0.7}, 80), (Shares{10, 69, 1}));
  EXPECT_EQ(mesh::apportion(std::vector<double>{100, 1e-9, 1e-9}, 80), (Shares{78, 1, 1}));
  EXPECT_EQ(mesh::apportion(std::vector<double>(100, 1.0), 80), Shares(100, 1));
}

}  // namespace
}  // namespace anticrack
