// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a plan makes of sides, holes and the names of both.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/plans.hpp"
#include "mesh/refusals.hpp"

namespace anticrack {
namespace {

using mesh::Geometry;
using mesh::HoleSpec;
using mesh::LineSpec;
using mesh::Plan;
using mesh::Point;
using mesh::Role;
using mesh::Shape;
using mesh::SideSpec;
using testing::areas;
using testing::expect_consistent;
using testing::Fault;
using ::testing::HasSubstr;
using testing::length_of;
using testing::plan_of;
using testing::polyline;
using testing::square;

constexpr double pi = std::numbers::pi;

HoleSpec window(const char* name, const Point& middle, double radius) {
  return {name, {Shape::circle, {middle}, radius}};
}

HoleSpec cut_out(const char* name, std::vector<Point> corners) {
  return {name, {Shape::polyline, std::move(corners)}};
}

/// A stadium: straight below and above, half circles left and right.
Geometry stadium(bool clockwise) {
  Geometry geometry;
  geometry.sides = {{"bottom", {Shape::polyline, {{-1, -1}, {0, -1}, {1, -1}}}},
                    {"right", {Shape::arc, {{1, -1}, {2, 0}, {1, 1}}}},
                    {"", {Shape::segment, {{0, 1}}, 180, 2}},
                    {"left", {Shape::spline, {{-1, 1}, {-1.5, 0.5}, {-1.5, -0.5}, {-1, -1}}}}};
  if (!clockwise) return geometry;
  std::ranges::reverse(geometry.sides);
  for (SideSpec& side : geometry.sides) {
    std::ranges::reverse(side.line.points);
    if (side.line.shape == Shape::segment) side.line.angle = 0;
  }
  return geometry;
}

TEST(Sides, CloseRoundTheMembraneEitherWay) {
  for (const bool clockwise : {false, true}) {
    Geometry geometry = stadium(clockwise);
    const Plan whole = plan_of(geometry, 0.05);
    double area = 0;
    for (const auto& [name, own] : areas(whole)) area += own;
    expect_consistent(whole, area);
    EXPECT_GT(area, 4 + pi / 2 * 0.99 + 0.5);
    geometry.neumann_sides = {"right"};
    EXPECT_NEAR(length_of(plan_of(geometry, 0.05), Role::neumann), pi, 0.005);
    geometry.neumann_sides = {clockwise ? "side-2" : "side-3", "bottom"};
    EXPECT_NEAR(length_of(plan_of(geometry), Role::neumann), 4, 1e-12);
    // a pair of points, counterclockwise over several sides
    geometry.neumann_sides = {};
    geometry.neumann = {{{0.5, -1}, {-0.5, 1}}};
    EXPECT_NEAR(length_of(plan_of(geometry, 0.05), Role::neumann), 0.5 + pi + 1.5, 0.005);
    geometry.neumann = {{{-0.5, 1}, {0.5, -1}}};
    EXPECT_GT(length_of(plan_of(geometry, 0.05), Role::neumann), 0.5 + 1.5 + 2);
  }
}

TEST(Sides, InterfacesEndOnThem) {
  Geometry geometry = stadium(false);
  geometry.interfaces = {polyline("across", {{0, -1}, {std::sqrt(0.5) + 1, std::sqrt(0.5)}})};
  const Plan plan = plan_of(geometry, 0.05);
  EXPECT_EQ(areas(plan).size(), 2U);
  ASSERT_EQ(plan.warnings.size(), 1U) << "no end was moved";
  EXPECT_TRUE(plan.warnings[0].starts_with("curves are replaced by chords: ")) << plan.warnings[0];
}

// chords leave as much of the circle's area out as they take from beyond it
TEST(Holes, CirclesHaveAsManyChordsAsTheAngleAsks) {
  Geometry geometry = square();
  geometry.holes = {window("small", {0.5, 0.5}, 0.25), window("large", {-0.5, -0.5}, 0.3)};
  for (const double angle : {0.0, 10.0, 2.5, 40.0}) {
    const mesh::MeshOptions options{.size = 1, .chord_angle = angle};
    const Plan plan = mesh::plan(geometry, options, testing::enough);
    const double n = 360 / (angle == 0 ? 5 : angle == 40 ? 30 : angle);
    const double circles = pi * (0.25 * 0.25 + 0.3 * 0.3);
    const double inscribed = n * std::sin(2 * pi / n) / 2 * (0.25 * 0.25 + 0.3 * 0.3);
    EXPECT_NEAR(areas(plan).begin()->second, 4 - circles, 0.1 * (circles - inscribed)) << angle;
    ASSERT_EQ(plan.warnings.size(), angle == 0 ? 1U : 0U);
    if (angle > 0) continue;
    // two thirds of 0.3 (1 - cos 2.5 degrees) = 0.000286, a little more as ends of spans stay
    EXPECT_NE(
        plan.warnings[0].find(R"(hole "large", the coarsest of 2 curves, by 72, up to 0.0002 off)"),
        std::string::npos)
        << plan.warnings[0];
  }
}

TEST(Holes, AreOutside) {
  Geometry geometry = square();
  geometry.holes = {window("window", {0.5, 0.5}, 0.25),
                    cut_out("", {{-0.5, -0.5}, {-0.25, -0.5}, {-0.25, -0.25}}),
                    cut_out("turned", {{-0.5, 0.5}, {-0.5, 0.75}, {-0.25, 0.5}})};
  for (const bool graded : {false, true}) {
    const Plan plan = graded ? mesh::plan(geometry, {}, testing::enough) : plan_of(geometry, 0.05);
    double area = 0;
    for (const auto& [name, own] : areas(plan)) area += own;
    expect_consistent(plan, area);
    EXPECT_NEAR(area, 4 - pi / 16 - 2 * 0.03125, 2e-3);
    ASSERT_EQ(plan.faces.size(), 1U);
    EXPECT_EQ(plan.faces[0].holes.size(), 3U);
  }
  geometry.neumann_sides = {"hole-2", "side-4"};
  EXPECT_NEAR(length_of(plan_of(geometry), Role::neumann), 2.5 + std::hypot(0.25, 0.25), 1e-12);
}

TEST(Holes, InterfacesAndCracksEndOnThem) {
  Geometry geometry = square();
  geometry.holes = {window("window", {0, 0}, 0.25)};
  geometry.interfaces = {polyline("west", {{-1, 0}, {-0.25, 0}}),
                         polyline("east", {{0.2500001, 0}, {1, 0}})};
  Plan plan = plan_of(geometry, 0.1);
  EXPECT_EQ(areas(plan).size(), 2U);
  EXPECT_EQ(plan.faces.size(), 2U);
  EXPECT_EQ(plan.warnings.size(), 2U) << "an end moved, and chords";
  expect_consistent(plan, areas(plan).at("omega1") + areas(plan).at("omega2"));
  geometry.interfaces.pop_back();
  geometry.cracks = {{"slit", {{-0.5, 0}, {-0.25, 0}}}};
  for (const bool held : {true, false}) {
    if (!held) geometry.neumann_sides = {"window"};
    plan = plan_of(geometry, 0.1);
    EXPECT_EQ(plan.faces.size(), 1U);
    EXPECT_FALSE(plan.faces[0].embedded.empty());
  }
}

TEST(Holes, RegionsLieBesideThem) {
  Geometry geometry = square();
  geometry.holes = {window("window", {0, 0}, 0.25)};
  geometry.regions = {{"ring", {}, 2, mesh::OutlineSpec{Shape::circle, {{0, 0}}, 0.5}}};
  EXPECT_NEAR(areas(plan_of(geometry, 0.02)).at("ring"), pi / 4 - pi / 16, 1e-3);
  geometry.regions = {{"nothing", {0.1, 0}, 1}};
  EXPECT_TRUE(testing::throws([&] { plan_of(geometry); }, errors::Reason::geometry_invalid,
                              "regions[0].at"));
}

void sides(Geometry& g, std::vector<SideSpec> given) {
  g.boundary.clear();
  g.sides = std::move(given);
}

const LineSpec lower{Shape::polyline, {{-1, 0}, {-1, -1}, {1, -1}, {1, 0}}};

const Fault boundary_faults[] = {
    {"Clockwise",
     [](Geometry& g) {
       g.neumann = {{{-1, -1}, {-1, 1}}};
     },
     "neumann[0]",
     {"walked counterclockwise, is all of the boundary but the straight side", "\"side-4\"",
      "[(-1, 1), (-1, -1)]"}},
    {"UnknownSide",
     [](Geometry& g) {
       g.holes = {window("window", {0, 0.5}, 0.2)};
       g.neumann_sides = {"side-1", "left"};
     },
     "neumann_sides[1]",
     {"\"left\"", "there are side-1, side-2, side-3, side-4, window"}},
    {"SideTwice",
     [](Geometry& g) {
       g.neumann_sides = {"side-1", "side-1"};
     },
     "neumann_sides[1]",
     {"overlap"}},
    {"SideAndPart",
     [](Geometry& g) {
       g.neumann = {{{0, -1}, {0.5, -1}}};
       g.neumann_sides = {"side-1"};
     },
     "neumann[0]",
     {"overlap"}},
    {"HoleTwice",
     [](Geometry& g) {
       g.holes = {window("window", {0, 0.5}, 0.2)};
       g.neumann_sides = {"window", "window"};
     },
     "neumann_sides[1]",
     {"again"}},
    {"HoleOutside",
     [](Geometry& g) {
       g.holes = {window("a", {3, 0}, 0.2)};
     },
     "holes[0].outline.circle",
     {"outside the boundary"}},
    {"HoleAround",
     [](Geometry& g) {
       g.holes = {cut_out("a", {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}})};
     },
     "holes[0].outline.polygon",
     {"outside the boundary"}},
    {"HoleTouches",
     [](Geometry& g) {
       g.holes = {cut_out("a", {{1, 0.5}, {0.5, 0.75}, {0.5, 0.25}})};
     },
     "holes[0].outline.polygon",
     {"boundary touch or cross", "touches neither"}},
    {"HolesTouch",
     [](Geometry& g) {
       g.holes = {window("a", {0, 0.5}, 0.2), window("b", {0.4, 0.5}, 0.2)};
     },
     "holes[1].outline.circle",
     {"touch or cross"}},
    {"HoleInHole",
     [](Geometry& g) {
       g.holes = {window("a", {0, 0.5}, 0.4), window("b", {0, 0.5}, 0.2)};
     },
     "holes[1].outline.circle",
     {R"(lies in hole "a")"}},
    {"HoleOnTheInterface",
     [](Geometry& g) {
       g.holes = {window("a", {0.75, 0}, 0.1)};
     },
     "interfaces[0].polyline",
     {"leaves the membrane", R"(of hole "a")"}},
    {"InterfaceInAHole",
     [](Geometry& g) {
       g.holes = {window("a", {0, 0.5}, 0.3)};
       testing::add(g, "lost", {{0, 0.4}, {0, 0.6}});
     },
     "interfaces[1].polyline",
     {R"(lies in hole "a")"}},
    {"HoleOfTwoPoints",
     [](Geometry& g) {
       g.holes = {cut_out("a", {{0, 0.5}, {0.5, 0.5}})};
     },
     "holes[0].outline.polygon",
     {"2 vertices"}},
    {"NamesASideLikeAPartThatIsNotThere",
     [](Geometry& g) { g.neumann_sides = {"inclusions[99].line"}; },
     "neumann_sides[0]",
     {"inclusions[99].line"}},
    {"NamesTwice",
     [](Geometry& g) {
       g.holes = {window("side-1", {0, 0.5}, 0.2)};
     },
     "holes[0].name",
     {"already the name of"}},
    {"Gap",
     [](Geometry& g) {
       sides(g, {{"a", lower}, {"b", {Shape::arc, {{1, 0.25}, {0, 1}, {-1, 0}}}}});
     },
     "sides[1].line.arc",
     {"begins at (1, 0.25)", "ends at (1, 0), 0.25 away"}},
    {"GapAtTheEnd",
     [](Geometry& g) {
       sides(g, {{"a", lower}, {"b", {Shape::arc, {{1, 0}, {0, 1}, {-1, 0.5}}}}});
     },
     "sides[0].line.polyline",
     {"begins at (-1, 0)", "ends at (-1, 0.5), 0.5 away"}},
    {"OneSide",
     [](Geometry& g) {
       sides(g, {{"a", lower}});
     },
     "sides",
     {"one side"}},
    {"SidesAndBoundary",
     [](Geometry& g) {
       g.sides = {{"a", lower}};
     },
     "sides",
     {"both"}},
    {"SidesCross",
     [](Geometry& g) {
       sides(g, {{"a", lower}, {"b", {Shape::polyline, {{1, 0}, {0, -4}, {-1, 0}}}}});
     },
     "sides[0].line.polyline",
     {"touch or cross"}},
    {"SidesEncloseNothing",
     [](Geometry& g) {
       sides(g, {{"a", lower}, {"b", {Shape::polyline, {{1, 0}, {0, -2}, {-1, 0}}}}});
     },
     "sides",
     {"no area"}},
    {"SideNotFinite",
     [](Geometry& g) {
       sides(g, {{"a", lower}, {"b", {Shape::polyline, {{1, 0}, {testing::infinite, 1}}}}});
     },
     "sides[1].line.polyline.points[1]",
     {"finite"}},
};

class BoundaryFaults : public ::testing::TestWithParam<Fault> {};
TEST_P(BoundaryFaults, AreRefusedWithTheirField) { testing::expect_refused(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Each, BoundaryFaults, ::testing::ValuesIn(boundary_faults),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace anticrack
