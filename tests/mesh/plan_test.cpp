// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/geometry.hpp"
#include "mesh/geometry_steps.hpp"
#include "mesh/plan_checks.hpp"
#include "mesh/plans.hpp"
#include "support/errors.hpp"
#include "support/paper_geometry.hpp"

namespace anticrack {
namespace {

using mesh::Geometry;
using mesh::Kind;
using mesh::MeshOptions;
using mesh::Plan;
using mesh::PlannedCurve;
using mesh::Point;
using mesh::Role;
using testing::curve;
using testing::enough;
using testing::expect_consistent;
using testing::face_area;
using testing::length;
using testing::paper_geometry;
using testing::paper_options;
using testing::point;
using testing::uniform;

/// Intervals of the curves of a role, on the boundary of a face where one is named.
int intervals(const Plan& plan, Role role, int face = -1) {
  int sum = 0;
  for (const auto& c : plan.curves) {
    if (c.role == role && (face < 0 || c.left == face)) sum += c.intervals;
  }
  return sum;
}

std::vector<PlannedCurve> chain(const Plan& plan, std::size_t i = 0) {
  std::vector<PlannedCurve> curves;
  for (const int c : plan.interfaces.at(i).curves) curves.push_back(curve(plan, c));
  return curves;
}

TEST(Plan, PaperPresetHas80IntervalsOnEachPart) {
  const Plan plan = mesh::plan(paper_geometry(), paper_options(), enough);
  expect_consistent(plan, 4);
  ASSERT_EQ(plan.interfaces.size(), 1U);
  EXPECT_EQ(plan.interfaces[0].name, "interface");
  const auto curves = chain(plan);
  ASSERT_EQ(curves.size(), 3U);
  EXPECT_EQ(curves[0].intervals, 40);
  EXPECT_EQ(curves[1].intervals, 80);
  EXPECT_EQ(curves[2].intervals, 40);
  EXPECT_EQ(curves[0].kind, Kind::glue);
  EXPECT_EQ(curves[1].kind, Kind::delaminated);
  EXPECT_EQ(curves[1].inclusion, 0);
  EXPECT_EQ(plan.inclusions, std::vector<std::string>{"inclusion"});
  ASSERT_EQ(plan.faces.size(), 2U);
  for (const int face : {0, 1}) {
    EXPECT_EQ(intervals(plan, Role::dirichlet, face), 80);
    EXPECT_EQ(plan.faces[static_cast<std::size_t>(face)].name, "omega" + std::to_string(face + 1));
  }
  for (const auto& c : plan.curves) {
    if (c.role != Role::dirichlet) continue;
    EXPECT_EQ(c.intervals, length(plan, c) > 1.5 ? 40 : 20);
  }
  EXPECT_EQ(plan.grading.h0, 0);
}

TEST(Plan, PlusLiesLeftOfTheInterface) {
  Geometry geometry = paper_geometry();
  geometry.boundary = {{-1, -1}, {1, -1}, {1, 2}, {-1, 2}};
  for (const bool clockwise : {false, true}) {
    if (clockwise) std::reverse(geometry.boundary.begin(), geometry.boundary.end());
    const Plan plan = mesh::plan(geometry, paper_options(), enough);
    expect_consistent(plan, 6);
    EXPECT_DOUBLE_EQ(face_area(plan, plan.faces.at(0)), 2);
    EXPECT_DOUBLE_EQ(face_area(plan, plan.faces.at(1)), 4);
    for (const auto& c : chain(plan)) {
      EXPECT_EQ(c.left, 1);
      EXPECT_EQ(c.right, 0);
    }
  }
  std::reverse(geometry.interfaces[0].points.begin(), geometry.interfaces[0].points.end());
  const Plan plan = mesh::plan(geometry, paper_options(), enough);
  expect_consistent(plan, 6);
  EXPECT_DOUBLE_EQ(face_area(plan, plan.faces.at(0)), 4);
  EXPECT_DOUBLE_EQ(face_area(plan, plan.faces.at(1)), 2);
}

TEST(Plan, InterfaceMayEndAtCornersOrOnOneEdge) {
  Geometry corners = paper_geometry();
  corners.interfaces[0].points = {{-1, -1}, {1, 1}};
  corners.inclusions.clear();
  const Plan diagonal = mesh::plan(corners, paper_options(), enough);
  expect_consistent(diagonal, 4);
  EXPECT_DOUBLE_EQ(face_area(diagonal, diagonal.faces.at(0)), 2);
  EXPECT_EQ(diagonal.points.size(), 4U);

  Geometry pocket = corners;
  pocket.interfaces[0].points = {{-0.5, -1}, {-0.5, 0}, {0.5, 0}, {0.5, -1}};
  for (const double plus : {3.0, 1.0}) {
    const Plan plan = mesh::plan(pocket, paper_options(), enough);
    expect_consistent(plan, 4);
    EXPECT_DOUBLE_EQ(face_area(plan, plan.faces.at(1)), plus);
    EXPECT_DOUBLE_EQ(face_area(plan, plan.faces.at(0)), 4 - plus);
    std::reverse(pocket.interfaces[0].points.begin(), pocket.interfaces[0].points.end());
  }
}

TEST(Plan, PartlyBondedInclusionBecomesSeveralCurves) {
  Geometry geometry = paper_geometry();
  geometry.interfaces[0].points = {{-1, 0}, {0, 0}, {1, 0}};
  geometry.inclusions = {
      {"a", {{0.5, 0}, {-0.5, 0}}, {{{-0.5, 0}, {-0.25, 0}}, {{0.25, 0}, {0.125, 0}}}},
      {"b", {{0.75, 0}, {0.875, 0}}, {}}};
  geometry.cracks = {{"c", {{-0.75, 0}, {-0.625, 0}}}};
  const Plan plan = mesh::plan(geometry, paper_options(), enough);
  expect_consistent(plan, 4);
  std::vector<std::pair<Kind, int>> kinds;
  int glue = 0;
  int rest = 0;
  for (const auto& c : chain(plan)) {
    kinds.emplace_back(c.kind, c.inclusion);
    (c.kind == Kind::glue ? glue : rest) += c.intervals;
  }
  const std::vector<std::pair<Kind, int>> expected = {
      {Kind::glue, -1},     {Kind::crack, -1},    {Kind::glue, -1},       {Kind::delaminated, 0},
      {Kind::inclusion, 0}, {Kind::inclusion, 0}, {Kind::delaminated, 0}, {Kind::inclusion, 0},
      {Kind::glue, -1},     {Kind::inclusion, 1}, {Kind::glue, -1}};
  EXPECT_EQ(kinds, expected);
  EXPECT_EQ(glue, 80);
  EXPECT_EQ(rest, 80);
}

TEST(Plan, UniformPresetCutsBySize) {
  const Plan plan = mesh::plan(paper_geometry(), uniform(0.1), enough);
  expect_consistent(plan, 4);
  EXPECT_EQ(intervals(plan, Role::interface), 20);
  EXPECT_EQ(intervals(plan, Role::dirichlet, 0), 40);
  EXPECT_EQ(plan.curves.size(), 9U);
  const Plan standard = mesh::plan(paper_geometry(), uniform(0), enough);
  const double size = std::sqrt(8.0) / 50;
  EXPECT_EQ(chain(standard).at(1).intervals, static_cast<int>(std::ceil(1 / size)));
}

TEST(Plan, GradedIsTheDefault) {
  MeshOptions options;
  const Plan standard = mesh::plan(paper_geometry(), options, enough);
  expect_consistent(standard, 4);
  EXPECT_DOUBLE_EQ(standard.grading.h0, std::sqrt(8.0) / 20.3);
  EXPECT_EQ(standard.grading.m, 0.2);
  EXPECT_EQ(standard.grading.tip_size, 0);
  options.size = 0.25;
  options.tip_size = 1e-6;
  options.grading = 0.125;
  const Plan plan = mesh::plan(paper_geometry(), options, enough);
  EXPECT_EQ(plan.grading.h0, 0.25);
  EXPECT_EQ(plan.grading.m, 0.125);
  EXPECT_EQ(plan.grading.tip_size, 1e-6);
  EXPECT_EQ(intervals(plan, Role::interface), 8);
}

TEST(Plan, GradedIsFinerWhereTipsAreMany) {
  const auto size = [](int rows) {
    Geometry geometry = testing::square();
    for (int k = 0; k < rows * rows; ++k) {
      const double x = -1 + 2 * (k % rows + 0.25) / rows;
      const double y = -1 + 2 * (k / rows + 0.5) / rows;
      const mesh::Part part{{x, y}, {x + 1.0 / rows, y}};
      const std::string name = "fibre" + std::to_string(k);
      geometry.interfaces.push_back(testing::polyline(name.c_str(), {part.from, part.to}));
      geometry.inclusions.push_back({name, part, {part}});
    }
    return mesh::plan(geometry, {}, enough).grading.h0;
  };
  EXPECT_DOUBLE_EQ(size(7), std::sqrt(8.0) / 20.3);
  // 128, 200 and 512 tips, each of which has R sqrt(16/tips) for itself
  for (const int rows : {8, 10, 16})
    EXPECT_NEAR(size(rows), 4 / std::sqrt(2.0) / rows / 2.75, 1e-12);
}

TEST(Plan, TooManyTrianglesAreRefusedBeforeTheyAreMade) {
  for (const double size : {1e-3, 1e-12, 1e-300}) {
    EXPECT_TRUE(testing::throws([&] { mesh::plan(paper_geometry(), uniform(size), 100'000); },
                                errors::Reason::limit_exceeded, "options.size"));
  }
  EXPECT_TRUE(testing::throws([] { mesh::plan(paper_geometry(), paper_options(), 300); },
                              errors::Reason::limit_exceeded, "options.preset"));
  EXPECT_NO_THROW(mesh::plan(paper_geometry(), uniform(0.02), 100'000));
}

TEST(Plan, TipsKeepTheCoordinatesTheyWereGiven) {
  Geometry geometry = paper_geometry();
  geometry.interfaces[0].points = {{-1, -1.0 / 3}, {1, 1.0 / 3}};
  const Point from{-0.3, -0.1};
  const Point to{0.3, 0.1 + 1e-12};
  geometry.inclusions = {{"a", {from, to}, {}}};
  const Plan plan = mesh::plan(geometry, paper_options(), enough);
  EXPECT_EQ(point(plan, chain(plan).at(1).a), from);
  EXPECT_EQ(point(plan, chain(plan).at(1).b), to);
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
