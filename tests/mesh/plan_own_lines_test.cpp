// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a plan makes of inclusions, cracks and regions given by themselves, and of the side that
// comes off.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "mesh/plans.hpp"
#include "mesh/refusals.hpp"

namespace anticrack {
namespace {

using mesh::Geometry;
using mesh::InclusionSpec;
using mesh::Kind;
using mesh::LineSide;
using mesh::LineSpec;
using mesh::OutlineSpec;
using mesh::Plan;
using mesh::Point;
using mesh::Shape;
using testing::areas;
using testing::chain_names;
using ::testing::ElementsAre;
using testing::expect_consistent;
using testing::plan_of;
using testing::polyline;
using testing::square;

LineSpec segment(const Point& middle, double angle, double length) {
  return {Shape::segment, {middle}, angle, length};
}

OutlineSpec circle(const Point& middle, double radius) { return {Shape::circle, {middle}, radius}; }

InclusionSpec alone(const char* name, const LineSpec& line) {
  InclusionSpec spec{name, {}, {}};
  spec.line = line;
  spec.stretches = {{0, 1}};
  return spec;
}

double length_of(const Plan& plan, Kind kind) {
  double sum = 0;
  for (const auto& c : plan.curves)
    if (c.role == mesh::Role::interface && c.kind == kind) sum += testing::length(plan, c);
  return sum;
}

/// Where a chain begins and ends.
std::pair<Point, Point> ends_of(const Plan& plan, std::size_t chain) {
  const auto& curves = plan.interfaces.at(chain).curves;
  return {testing::point(plan, testing::curve(plan, curves.front()).a),
          testing::point(plan, testing::curve(plan, curves.back()).b)};
}

TEST(OwnLines, AreInterfacesWithTheNameOfTheirOwner) {
  Geometry geometry = square();
  geometry.interfaces = {polyline("middle", {{-1, 0.9}, {1, 0.9}})};
  geometry.inclusions = {alone("bar", segment({0.25, 0.5}, 90, 0.5)),
                         alone("bow", {Shape::arc, {{-0.5, 0}, {-0.3, 0.2}, {-0.1, 0}}}),
                         alone("wave", {Shape::spline, {{-0.5, -0.5}, {0, -0.4}, {0.5, -0.5}}})};
  geometry.cracks = {{"slit", {}, true, LineSpec{Shape::polyline, {{0.5, 0}, {0.75, 0.1}}}}};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  EXPECT_THAT(chain_names(plan), ElementsAre("middle", "bar", "bow", "wave", "slit"));
  EXPECT_EQ(ends_of(plan, 1), (std::pair<Point, Point>({0.25, 0.25}, {0.25, 0.75})));
  EXPECT_NEAR(length_of(plan, Kind::crack), std::hypot(0.25, 0.1), 1e-14);
  EXPECT_GT(length_of(plan, Kind::delaminated), 0.5 + 0.2 * std::numbers::pi * 0.99 + 1);
}

TEST(OwnLines, PointFromTheirStartToTheirEnd) {
  for (const double angle : {0.0, 20.0, 180.0, 270.0, -45.0, 765.0}) {
    Geometry geometry = square();
    geometry.inclusions = {alone("bar", segment({0.1, 0.2}, angle, 0.5))};
    const auto [from, to] = ends_of(plan_of(geometry), 0);
    const double turn = angle * std::numbers::pi / 180;
    EXPECT_NEAR(to[0] - from[0], 0.5 * std::cos(turn), 1e-14) << angle;
    EXPECT_NEAR(to[1] - from[1], 0.5 * std::sin(turn), 1e-14) << angle;
    EXPECT_NEAR(to[0] + from[0], 0.2, 1e-14) << angle;
  }
}

TEST(OwnLines, MayEndOnTheBoundaryAndOnOthers) {
  Geometry geometry = square();
  geometry.cracks = {{"edge", {}, true, segment({0.75, 0}, 0, 0.5000005)}};
  EXPECT_EQ(ends_of(plan_of(geometry), 0).second, (Point{1, 0}));  // where u is held
  geometry.neumann_sides = {"side-2"};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  EXPECT_EQ(ends_of(plan, 0).second, (Point{1, 0}));
  ASSERT_EQ(plan.warnings.size(), 1U);
  EXPECT_EQ(plan.warnings[0].find(R"(crack "edge", its last point)"), 0U);
  geometry.cracks.push_back({"branch", {}, true, segment({0.75, 0.1}, 90, 0.2)});
  expect_consistent(plan_of(geometry), 4);
}

TEST(OwnLines, ComeOffInStretchesOfTheirLength) {
  Geometry geometry = square();
  geometry.inclusions = {
      alone("bent", {Shape::polyline, {{-0.5, 0}, {0, 0}, {0, 0.5}, {0.5, 0.5}}})};
  geometry.inclusions[0].stretches = {{0.5, 1}, {0, 0.25}};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  EXPECT_NEAR(length_of(plan, Kind::delaminated), 0.75 + 0.375, 1e-14);
  EXPECT_NEAR(length_of(plan, Kind::inclusion), 0.375, 1e-14);
  // of a part of an interface: walked from `from` to `to`, whichever way the interface runs
  geometry = testing::paper_geometry();
  geometry.inclusions[0].delaminated.clear();
  geometry.inclusions[0].stretches = {{0.75, 1}};
  for (const double sign : {1.0, -1.0}) {
    geometry.inclusions[0].part = {{-0.5 * sign, 0}, {0.5 * sign, 0}};
    const Plan paper = plan_of(geometry);
    double x = 0;
    for (const auto& c : paper.curves)
      if (c.kind == Kind::delaminated) x += testing::point(paper, c.a)[0];
    EXPECT_NEAR(x, sign > 0 ? 0.25 : -0.5, 1e-12);
  }
}

TEST(OwnLines, TheChainIsWalkedSoThatItsMinusSideComesOff) {
  Geometry geometry = testing::paper_geometry();
  const auto begin = [&](LineSide side, double sign) {
    geometry.inclusions[0].delaminated_side = side;
    geometry.inclusions[0].part = {{-0.5 * sign, 0}, {0.5 * sign, 0}};
    const Plan plan = plan_of(geometry);
    expect_consistent(plan, 4);
    EXPECT_EQ(areas(plan).size(), 2U);
    EXPECT_EQ(plan.faces[0].name, "omega1");  // in the user's direction
    EXPECT_LT(testing::point(plan, testing::curve(plan, std::abs(plan.faces[0].outer[0]) - 1).a)[1],
              0.5);
    return ends_of(plan, 0).first[0];
  };
  EXPECT_EQ(begin(LineSide::unspecified, 1), -1);
  EXPECT_EQ(begin(LineSide::unspecified, -1), -1);
  EXPECT_EQ(begin(LineSide::right, 1), -1);
  EXPECT_EQ(begin(LineSide::left, 1), 1);
  EXPECT_EQ(begin(LineSide::right, -1), 1);
  EXPECT_EQ(begin(LineSide::left, -1), -1);
}

TEST(OwnLines, AChainIsSplitWhereSidesDisagree) {
  Geometry geometry = testing::paper_geometry();
  geometry.inclusions = {{"a", {{-0.75, 0}, {-0.5, 0}}, {{{-0.75, 0}, {-0.5, 0}}}},
                         {"b", {{-0.25, 0}, {0.25, 0}}, {{{-0.25, 0}, {0.25, 0}}}}};
  geometry.inclusions[1].delaminated_side = LineSide::left;
  geometry.cracks = {testing::crack("c", 0.5, 0.75)};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  EXPECT_THAT(chain_names(plan), ElementsAre("interface", "interface-2", "interface-3"));
  EXPECT_EQ(ends_of(plan, 0), (std::pair<Point, Point>({-1, 0}, {-0.25, 0})));
  EXPECT_EQ(ends_of(plan, 1), (std::pair<Point, Point>({0.5, 0}, {-0.25, 0})));
  EXPECT_EQ(ends_of(plan, 2), (std::pair<Point, Point>({0.5, 0}, {1, 0})));
}

TEST(OwnLines, AnOutlineIsARegion) {
  for (const bool turned : {false, true}) {
    Geometry geometry = square();
    std::vector<Point> corners{{-0.5, -0.5}, {0, -0.5}, {0, 0}, {-0.5, 0}};
    if (turned) std::reverse(corners.begin(), corners.end());
    geometry.regions = {{"patch", {}, 3, OutlineSpec{Shape::polyline, corners}},
                        {"disc", {}, 1, circle({0.5, 0.5}, 0.25)}};
    const Plan plan = plan_of(geometry, 0.05);
    expect_consistent(plan, 4);
    EXPECT_DOUBLE_EQ(areas(plan).at("patch"), 0.25);
    EXPECT_NEAR(areas(plan).at("disc"), std::numbers::pi / 16, 2e-3);
    EXPECT_EQ(areas(plan).size(), 3U);
    EXPECT_THAT(chain_names(plan), ElementsAre("patch", "disc"));
    for (const auto& face : plan.faces) EXPECT_EQ(face.tension, face.name == "patch" ? 3 : 1);
  }
}

TEST(OwnLines, ARegionMayBeCrossedByWhatLiesInIt) {
  Geometry geometry = square();
  geometry.regions = {{"disc", {}, 1, circle({0, 0}, 0.5)}};
  geometry.inclusions = {alone("bar", segment({0, 0}, 30, 1.5))};
  geometry.cracks = {{"slit", {}, true, segment({0, -0.2}, 120, 0.1)}};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  EXPECT_NEAR(areas(plan).at("disc"), std::numbers::pi / 4, 1e-2);
  EXPECT_EQ(areas(plan).size(), 2U);
  // glue would have two subdomains beside it
  geometry.interfaces = {polyline("glue", {{-1, 0.1}, {1, 0.1}})};
  geometry.inclusions.clear();
  EXPECT_TRUE(testing::throws([&] { plan_of(geometry); }, errors::Reason::geometry_invalid,
                              "regions[0].outline"));
}

TEST(OwnLines, ARegionInsideAnotherOneIsCutOutOfIt) {
  Geometry geometry = square();
  geometry.regions = {{"disc", {}, 1, circle({0, 0}, 0.2)},
                      {"plate", {}, 1, circle({0, 0}, 0.8)},
                      {"core", {}, 1, circle({0, 0}, 0.1)},
                      {"apart", {}, 1, circle({0.85, 0.85}, 0.1)},
                      {"around", {-0.9, -0.9}, 1}};
  const auto notes = [](const Plan& plan) {
    std::vector<std::string> found;
    for (const std::string& warning : plan.warnings)
      if (warning.find("cut out") != std::string::npos) found.push_back(warning);
    return found;
  };
  EXPECT_THAT(
      notes(plan_of(geometry)),
      ElementsAre(R"(region "core" lies inside region "disc", cut out of it: the tension and the )"
                  R"(loads of region "disc" do not act there, so give each its own)",
                  ::testing::HasSubstr(R"(region "disc" lies inside region "plate")")));
  for (int i = 0; i < 4; ++i)
    geometry.regions.push_back(
        {"dot-" + std::to_string(i), {}, 1, circle({0.1 * i - 0.2, 0.5}, 0.02)});
  EXPECT_THAT(notes(plan_of(geometry)).back(),
              ::testing::HasSubstr(
                  R"(region "disc", region "dot-0", region "dot-1" and 2 more lie inside)"));
}

const testing::Fault own_line_faults[] = {
    {"OutlinesCross",
     [](Geometry& g) {
       g.regions = {{"r", {}, 1, circle({0, 0.5}, 0.2)}, {"s", {}, 1, circle({0.1, 0.5}, 0.2)}};
     },
     "regions[0].outline",
     {R"(region "r", at)",
      R"(is crossed by region "s"; draw them apart, or one inside the other)"}},
    {"OutlineCrossedByGlue",
     [](Geometry& g) {
       g.regions = {{"r", {}, 1, circle({-0.8, 0}, 0.1)}};
     },
     "regions[0].outline",
     {R"(is crossed by interface "interface", which divides it)"}},
    {"LengthZero",
     [](Geometry& g) {
       g.inclusions.push_back(alone("a", segment({0, 0.5}, 0, 0)));
     },
     "inclusions[1].line.segment.length",
     {"is 0; a length is a number above 0"}},
    {"AngleNotFinite",
     [](Geometry& g) {
       g.inclusions.push_back(alone("a", segment({0, 0.5}, testing::nan_value, 1)));
     },
     "inclusions[1].line.segment.angle",
     {"give it in degrees"}},
    {"RadiusNegative",
     [](Geometry& g) {
       g.regions = {{"r", {}, 1, circle({0, 0.5}, -1)}};
     },
     "regions[0].outline.circle.radius",
     {"is -1; a radius is a number above 0"}},
    {"RadiusTiny",
     [](Geometry& g) {
       g.regions = {{"r", {}, 1, circle({0, 0.5}, 1e-9)}};
     },
     "regions[0].outline.circle.radius",
     {"a circle in this membrane is"}},
    {"LineLeaves",
     [](Geometry& g) {
       g.inclusions.push_back(alone("a", segment({0.5, 0.5}, 0, 2)));
     },
     "inclusions[1].line.segment",
     {"leaves the membrane"}},
    {"OutlineLeaves",
     [](Geometry& g) {
       g.regions = {{"r", {}, 1, circle({1, 0}, 0.25)}};
     },
     "regions[0].outline.circle",
     {"leaves the membrane"}},
    {"NameOfAnInterface",
     [](Geometry& g) {
       g.inclusions.push_back(alone("interface", segment({0, 0.5}, 0, 0.5)));
     },
     "inclusions[1].name",
     {"already the name of interfaces[0]"}},
    {"StretchBackwards",
     [](Geometry& g) {
       g.inclusions[0].delaminated.clear();
       g.inclusions[0].stretches = {{0.5, 0.25}};
     },
     "inclusions[0].delaminated_parts.stretches[0]",
     {"runs from 0.5 to 0.25", "0 <= from < to <= 1"}},
    {"StretchNotANumber",
     [](Geometry& g) {
       g.inclusions[0].stretches = {{0, testing::nan_value}};
     },
     "inclusions[0].delaminated_parts.stretches[0]",
     {"nan"}},
    {"StretchesOverlap",
     [](Geometry& g) {
       g.inclusions[0].delaminated.clear();
       g.inclusions[0].stretches = {{0, 0.5}, {0.25, 1}};
     },
     "inclusions[0].delaminated_parts.stretches[1]",
     {"overlap"}},
    {"TwoOnOneLine",
     [](Geometry& g) {
       g.inclusions.push_back(alone("a", segment({0, 0.5}, 0, 1)));
       g.cracks = {{"c", {{0, 0.5}, {0.25, 0.5}}}};
     },
     "cracks[0].part",
     {"overlap"}},
    {"NoInterface",
     [](Geometry& g) { g.interfaces.clear(); },
     "inclusions[0].part.from",
     {"there is none", "a line of its own", "center, angle and length"}},
};

class OwnLineFaults : public ::testing::TestWithParam<testing::Fault> {};
TEST_P(OwnLineFaults, AreRefusedWithTheirField) { testing::expect_refused(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Each, OwnLineFaults, ::testing::ValuesIn(own_line_faults),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace anticrack
