// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a plan says of the parts of a membrane: align lines, regions, the boundary under traction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "mesh/plans.hpp"
#include "support/errors.hpp"

namespace anticrack {
namespace {

using mesh::Geometry;
using mesh::Kind;
using mesh::MeshOptions;
using mesh::Plan;
using mesh::Role;
using testing::areas;
using testing::count;
using testing::enough;
using testing::expect_consistent;
using testing::length_of;
using testing::plan_of;
using testing::polyline;
using testing::square;
using testing::uniform;

TEST(PlanParts, AlignLinesPartNoSubdomains) {
  Geometry geometry = square();
  geometry.interfaces = {polyline("a", {{-1, 0}, {1, 0}})};
  MeshOptions options = uniform(0.25);
  options.align = {{{-0.5, -1}, {-0.5, 1}}, {{0.25, 0.25}, {0.5, 0.5}}, {{0.5, -0.5}, {0.5, 0}}};
  const Plan plan = mesh::plan(geometry, options, enough);
  expect_consistent(plan, 4);
  EXPECT_EQ(plan.faces.size(), 4U);
  EXPECT_DOUBLE_EQ(areas(plan).at("omega1"), 2);
  EXPECT_DOUBLE_EQ(areas(plan).at("omega2"), 2);
  EXPECT_EQ(areas(plan).size(), 2U);
  EXPECT_EQ(plan.interfaces.size(), 1U);
  EXPECT_DOUBLE_EQ(length_of(plan, Role::align), 2 + std::hypot(0.25, 0.25) + 0.5);
}

TEST(PlanParts, GlueBetweenFacesOfOneSubdomainIsNoInterface) {
  // the interface's free end and the align line cut a corner off, but both are omega1
  Geometry geometry = square();
  geometry.interfaces = {polyline("a", {{-1, 0}, {0.5, 0}})};
  geometry.cracks = {{"c", {{-0.5, 0}, {0, 0}}}};
  MeshOptions options = uniform(0.25);
  options.align = {{{0.5, 0}, {0.5, 1}}};
  const Plan plan = mesh::plan(geometry, options, enough);
  expect_consistent(plan, 4);
  EXPECT_EQ(areas(plan).size(), 1U);
  EXPECT_EQ(count(plan, Kind::glue), 0);
  EXPECT_EQ(count(plan, Kind::crack), 1);
}

TEST(PlanParts, InclusionsMayMeet) {
  for (const double end : {-0.5, 0.0}) {  // they cross, or one ends on the other
    Geometry geometry = square();
    geometry.interfaces = {polyline("a", {{-1, 0}, {1, 0}}), polyline("b", {{0, -1}, {0, 1}})};
    geometry.inclusions = {{"a", {{-0.5, 0}, {0.5, 0}}, {}}, {"b", {{0, end}, {0, 0.5}}, {}}};
    const Plan plan = mesh::plan(geometry, uniform(0.25), enough);
    expect_consistent(plan, 4);
    std::map<int, std::vector<int>> curves_at;  // of a point, their inclusions
    for (const auto& curve : plan.curves)
      if (curve.inclusion >= 0)
        for (const int point : {curve.a, curve.b}) curves_at[point].push_back(curve.inclusion);
    EXPECT_EQ(std::ranges::count_if(curves_at,
                                    [](const auto& at) {
                                      return std::ranges::count(at.second, 0) == 2 &&
                                             std::ranges::count(at.second, 1) > 0;
                                    }),
              1);
  }
}

TEST(PlanParts, NeumannPartsOfTheBoundary) {
  for (const bool clockwise : {false, true}) {
    Geometry geometry = square();
    if (clockwise) std::reverse(geometry.boundary.begin(), geometry.boundary.end());
    geometry.neumann = {{{1, -0.5}, {0.5, 1}}, {{-0.25, -1}, {0.25, -1}}};
    const Plan plan = plan_of(geometry);
    expect_consistent(plan, 4);
    EXPECT_DOUBLE_EQ(length_of(plan, Role::neumann), 1.5 + 0.5 + 0.5);
    // round the corner where the polygon begins
    geometry.neumann = {{{-1, 0}, {0, -1}}};
    EXPECT_DOUBLE_EQ(length_of(plan_of(geometry), Role::neumann), 2);
    geometry.neumann = {{{0.25, -1}, {0.25, -1}}};
    EXPECT_TRUE(testing::throws([&] { plan_of(geometry); }, errors::Reason::geometry_invalid,
                                "neumann"));  // nothing holds it, but for an inclusion
    geometry.inclusions = {
        {"bar", {}, {}, {.fixed = 0.1}, mesh::LineSpec{mesh::Shape::segment, {{0, 0}}, 0, 0.5}}};
    EXPECT_DOUBLE_EQ(length_of(plan_of(geometry), Role::neumann), 8);
    EXPECT_EQ(length_of(plan_of(geometry), Role::dirichlet), 0);
  }
}

TEST(PlanParts, ACrackMayLeaveThroughTheBoundary) {
  Geometry geometry = square();
  geometry.interfaces = {polyline("a", {{-1, 0}, {1, 0}})};
  geometry.cracks = {{"c", {{0, 0}, {1, 0}}}};
  geometry.neumann = {{{1, -1}, {1, 1}}};
  expect_consistent(plan_of(geometry), 4);
  // two parts that meet there
  geometry.neumann = {{{1, 0}, {1, 1}}, {{1, -1}, {1, 0}}};
  expect_consistent(plan_of(geometry), 4);
  // and where u is held
  geometry.neumann = {{{-1, 1}, {-1, -1}}};
  expect_consistent(plan_of(geometry), 4);
  // on one side alone one of its faces would be held in a point
  for (const mesh::Part& part : {mesh::Part{{1, -1}, {1, 0}}, mesh::Part{{1, 0}, {1, 1}}}) {
    geometry.neumann = {part};
    EXPECT_TRUE(testing::throws([&] { plan_of(geometry); }, errors::Reason::geometry_invalid,
                                "cracks[0].part.to"));
  }
}

TEST(PlanParts, TwoCracksMayNotEndInOnePointThatIsHeld) {
  Geometry geometry = square();
  const auto from_corner = [](double x) {
    return mesh::CrackSpec{"c" + std::to_string(x > 0),
                           {},
                           true,
                           mesh::LineSpec{mesh::Shape::polyline, {{0, -1}, {x, 0}}}};
  };
  geometry.cracks = {from_corner(-0.5), from_corner(0.5)};
  EXPECT_TRUE(testing::throws([&] { plan_of(geometry); }, errors::Reason::geometry_invalid,
                              "cracks[0].line"));
  geometry.cracks.pop_back();
  expect_consistent(plan_of(geometry), 4);
}

TEST(PlanParts, AnInclusionMayLeaveThroughTheBoundary) {
  Geometry geometry = square();
  geometry.interfaces = {polyline("a", {{-1, 0}, {1, 0}})};
  geometry.inclusions = {{"bar", {{0, 0}, {1, 0}}, {{{0, 0}, {0.5, 0}}}}};
  geometry.neumann = {{{1, -1}, {1, 1}}};
  expect_consistent(plan_of(geometry), 4);
  geometry.neumann = {{{1, -1}, {1, 0}}};
  EXPECT_TRUE(testing::throws([&] { plan_of(geometry); }, errors::Reason::geometry_invalid,
                              "inclusions[0].part.to"));
}

/// Coordinates with six decimals on an oblique line: moved onto it, and told.
TEST(PlanParts, EndsALittleOffTheirLineAreMovedOntoIt) {
  Geometry geometry = square();
  geometry.interfaces = {polyline("a", {{-1, -0.1}, {1, 0.2}}),
                         polyline("b", {{0.333333, 0.1}, {0.333333, 0.9999995}})};
  geometry.inclusions = {
      {"bar", {{-0.7, -0.055}, {-0.333333, 0}}, {{{-0.7, -0.055}, {-0.5, -0.025}}}}};
  geometry.cracks = {{"c", {{0.123456, 0.068518}, {0.2, 0.08}}}};
  geometry.neumann = {{{1.0000005, -1}, {1, 0}}};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  ASSERT_EQ(plan.warnings.size(), 5U);
  EXPECT_EQ(plan.warnings[0].find(R"(interface "b", its first point (0.333333, 0.1) lies )"), 0U)
      << plan.warnings[0];
  for (std::size_t i = 1; i < 5; ++i) {
    const char* const fields[] = {"", R"(interface "b")", R"(inclusion "bar": to )",
                                  R"(crack "c": from )", "neumann[0].from"};
    EXPECT_EQ(plan.warnings[i].find(fields[i]), 0U) << plan.warnings[i];
  }
  EXPECT_TRUE(plan_of(square()).warnings.empty());

  geometry.cracks[0].part.from[1] = 0.069;  // three decimals: too far, but the cure is told
  const auto error = testing::error_of([&] { plan_of(geometry); });
  ASSERT_TRUE(error);
  EXPECT_NE(std::string(error->what()).find("nearest is (0.12352"), std::string::npos)
      << error->what();
}

TEST(PlanParts, AnInterfaceMayHaveTwentyThousandPoints) {
  constexpr int count = 19'900;
  std::vector<mesh::Point> points;
  for (int i = 0; i <= count; ++i) {
    const double x = -1 + 2.0 * i / count;
    points.push_back({x, 0.1 * std::sin(3 * x)});
  }
  for (const bool upright : {false, true}) {
    Geometry geometry = square();
    geometry.interfaces = {polyline("a", points)};
    if (upright) {
      for (mesh::Point& p : geometry.interfaces[0].points) std::swap(p[0], p[1]);
    }
    const Plan plan = plan_of(geometry);
    EXPECT_GE(plan.curves.size(), std::size_t{count});
    EXPECT_EQ(plan.faces.size(), 2U);
  }
}

TEST(PlanParts, CracksMayBeFreeAndInclusionsMove) {
  Geometry geometry = testing::paper_geometry();
  geometry.cracks = {{"touching", {{-0.9, 0}, {-0.6, 0}}}, {"free", {{0.6, 0}, {0.9, 0}}, false}};
  geometry.inclusions.push_back({"second", {{0.25, 0}, {0.5, 0}}, {}, {true, {}}});
  geometry.inclusions[0].part.to = {0, 0};
  geometry.inclusions[0].delaminated = {geometry.inclusions[0].part};
  const Plan plan = plan_of(geometry);
  EXPECT_EQ(plan.motions, (std::vector<mesh::Motion>{{}, {true, {}}}));
  std::map<mesh::Kind, double> lengths;
  for (const auto& curve : plan.curves)
    if (curve.role == mesh::Role::interface) lengths[curve.kind] += testing::length(plan, curve);
  EXPECT_NEAR(lengths.at(mesh::Kind::crack), 0.3, 1e-12);
  EXPECT_NEAR(lengths.at(mesh::Kind::free), 0.3, 1e-12);
}

TEST(PlanParts, RegionsNameWhatHoldsThem) {
  Geometry geometry = square();
  geometry.interfaces = {polyline("a", {{-1, 0}, {1, 0}}), polyline("b", {{0, 0}, {0, 1}})};
  geometry.regions = {{"right", {0.5, 0.5}, 3}, {"omega1", {-0.5, 0.5}, 2}};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  const auto sums = areas(plan);
  EXPECT_DOUBLE_EQ(sums.at("right"), 1);
  EXPECT_DOUBLE_EQ(sums.at("omega1"), 1);
  EXPECT_EQ(sums.size(), 3U);
  for (const auto& face : plan.faces) {
    EXPECT_EQ(face.tension, face.name == "right" ? 3 : face.name == "omega1" ? 2 : 1);
  }
}

}  // namespace
}  // namespace anticrack
