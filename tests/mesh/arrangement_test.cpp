// SPDX-License-Identifier: GPL-3.0-or-later
//
// Plans of more than one line: junctions, slits, rings, curves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "mesh/plans.hpp"
#include "support/errors.hpp"

namespace anticrack {
namespace {

using mesh::Geometry;
using mesh::Kind;
using mesh::Plan;
using mesh::Point;
using mesh::Role;
using mesh::Shape;
using testing::areas;
using testing::chain_names;
using testing::count;
using testing::enough;
using testing::expect_consistent;
using testing::length;
using testing::length_of;
using testing::plan_of;
using testing::point;
using testing::polyline;
using testing::square;

TEST(Arrangement, NoInterfaceIsOneSubdomain) {
  const Plan plan = plan_of(square());
  expect_consistent(plan, 4);
  EXPECT_EQ(plan.faces.size(), 1U);
  EXPECT_EQ(plan.faces[0].name, "omega1");
}

TEST(Arrangement, CrossingInterfacesMakeFourSubdomains) {
  Geometry geometry = square();
  geometry.interfaces = {polyline("a", {{-1, 0}, {1, 0.125}}), polyline("b", {{0.25, -1}, {0, 1}})};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  EXPECT_EQ(plan.faces.size(), 4U);
  EXPECT_EQ(chain_names(plan), (std::vector<std::string>{"a", "b"}));
  // y = (x + 1)/16 and x = (1 - y)/8 meet in one point of the plan
  const double y = (9.0 / 8) / 16 / (1 + 1.0 / 128);
  int there = 0;
  for (const Point& p : plan.points) {
    there += std::hypot(p[0] - (1 - y) / 8, p[1] - y) < 1e-12 ? 1 : 0;
  }
  EXPECT_EQ(there, 1);
}

TEST(Arrangement, ThreeLinesThroughOnePointHaveItOnce) {
  Geometry geometry = square();
  geometry.interfaces = {polyline("a", {{-1, -0.3}, {1, 0.3}}),
                         polyline("b", {{-0.7, 1}, {0.7, -1}}),
                         polyline("c", {{-1, 0.9}, {1, -0.9}})};
  const Plan plan = plan_of(geometry, 0.05);
  expect_consistent(plan, 4);
  EXPECT_EQ(plan.faces.size(), 6U);
  EXPECT_EQ(plan.points.size(), 4U + 6U + 1U);
}

TEST(Arrangement, AnInterfaceMayEndOnAnother) {
  Geometry geometry = square();
  geometry.interfaces = {polyline("a", {{-1, -0.3}, {1, 0.3}}),
                         polyline("b", {{0.2, 0.06}, {0, 1}})};
  for (const bool other_way : {false, true}) {
    if (other_way) std::reverse(geometry.interfaces.begin(), geometry.interfaces.end());
    const Plan plan = plan_of(geometry);
    expect_consistent(plan, 4);
    EXPECT_EQ(plan.faces.size(), 3U);
    EXPECT_EQ(plan.interfaces.size(), 2U);
  }
}

TEST(Arrangement, ASlitKeepsWhatItCarries) {
  Geometry geometry = square();
  geometry.interfaces = {polyline("slit", {{-0.75, 0}, {0.75, 0}})};
  geometry.inclusions = {{"a", {{-0.5, 0}, {-0.25, 0}}, {{{-0.5, 0}, {-0.25, 0}}}}};
  geometry.cracks = {{"c", {{0.25, 0}, {0.5, 0}}}};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  ASSERT_EQ(plan.faces.size(), 1U);
  EXPECT_EQ(plan.faces[0].embedded.size(), 2U);
  EXPECT_EQ(chain_names(plan), (std::vector<std::string>{"slit", "slit-2"}));
  EXPECT_EQ(count(plan, Kind::glue), 0);
  EXPECT_EQ(count(plan, Kind::delaminated), 1);
  EXPECT_EQ(count(plan, Kind::crack), 1);
}

TEST(Arrangement, AChainThatFallsApartTakesNoNameOfAnother) {
  Geometry geometry = square();
  geometry.interfaces = {polyline("s", {{-0.75, 0}, {0.75, 0}}),
                         polyline("s-2", {{-1, 0.5}, {1, 0.5}})};
  geometry.cracks = {{"a", {{-0.5, 0}, {-0.25, 0}}}, {"b", {{0.25, 0}, {0.5, 0}}}};
  EXPECT_EQ(chain_names(plan_of(geometry)), (std::vector<std::string>{"s", "s-3", "s-2"}));
}

TEST(Arrangement, ARingHasTwoSubdomains) {
  Geometry geometry = square();
  geometry.interfaces = {
      polyline("ring", {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}, true)};
  geometry.regions = {{"core", {0, 0}, 2.5}};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  ASSERT_EQ(plan.faces.size(), 2U);
  EXPECT_EQ(plan.faces[0].holes.size(), 1U);
  EXPECT_EQ(plan.faces[0].name, "omega1");  // the minus side, outside
  EXPECT_EQ(plan.faces[1].name, "core");
  EXPECT_EQ(plan.faces[1].tension, 2.5);
  EXPECT_DOUBLE_EQ(areas(plan).at("core"), 1);
  const auto& chain = plan.interfaces.at(0).curves;
  EXPECT_EQ(testing::curve(plan, chain.back()).b, testing::curve(plan, chain.front()).a);
}

TEST(Arrangement, APartOfAClosedInterfaceRunsInItsOrder) {
  Geometry geometry = square();
  geometry.interfaces = {
      polyline("ring", {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}, true)};
  // over the joint at (-0.5, -0.5)
  geometry.cracks = {{"c", {{-0.5, 0.25}, {0.25, -0.5}}}};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  double cracked = 0;
  for (const auto& c : plan.curves) cracked += c.kind == Kind::crack ? length(plan, c) : 0;
  EXPECT_DOUBLE_EQ(cracked, 1.5);
}

TEST(Arrangement, ACrackOnAClosedFreeStandingLineOfItsOwnIsASlit) {
  // a ring in a ring, and a slit in the inner one: holes and embedded curves at every level
  Geometry geometry = square();
  geometry.interfaces = {
      polyline("outer", {{-0.75, -0.75}, {0.75, -0.75}, {0.75, 0.75}, {-0.75, 0.75}}, true),
      polyline("inner", {{-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}, {-0.5, -0.5}}, true),
      polyline("slit", {{-0.25, 0}, {0.25, 0}})};
  geometry.cracks = {{"c", {{-0.25, 0}, {0.25, 0}}}};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  ASSERT_EQ(plan.faces.size(), 3U);
  std::multiset<std::size_t> holes;
  for (const auto& face : plan.faces) holes.insert(face.holes.size());
  EXPECT_EQ(holes, (std::multiset<std::size_t>{0, 1, 1}));
  for (const auto& face : plan.faces) {
    if (face.holes.empty()) {
      EXPECT_EQ(face.embedded.size(), 1U);
    }
  }
}

TEST(Arrangement, LinesThatHangTogetherAtOnePointBoundSimpleLoops) {
  // a loop that leaves an interface and comes back to the same point
  Geometry geometry = square();
  geometry.interfaces = {polyline("a", {{-1, 0}, {0, 0}, {1, 0}}),
                         polyline("b", {{0, 0}, {0.5, 0.5}, {-0.5, 0.5}}, true)};
  const Plan plan = plan_of(geometry);
  expect_consistent(plan, 4);
  EXPECT_EQ(plan.faces.size(), 3U);
}

TEST(Arrangement, ArcsAreCutIntoChordsOfEqualArea) {
  Geometry geometry = square();
  geometry.interfaces = {{"arc", Shape::arc, {{-1, 0}, {0, 0.5}, {1, 0}}}};
  // the circle through these: centre (0, -0.75), radius 1.25
  const auto on_arc = [](double angle) {
    return Point{1.25 * std::sin(angle), 1.25 * std::cos(angle) - 0.75};
  };
  const Point from = on_arc(-0.4);
  const Point to = on_arc(0.3);
  geometry.inclusions = {{"a", {from, to}, {{on_arc(0.1), to}}}};
  for (const double size : {0.05, 2.0}) {
    const Plan plan = plan_of(geometry, size);
    expect_consistent(plan, 4);
    ASSERT_EQ(plan.faces.size(), 2U);
    double before = 0, longest = 0;
    bool first = true;
    bool tip = false;
    for (const int i : plan.interfaces.at(0).curves)
      longest = std::max(longest, length(plan, testing::curve(plan, i)));
    for (const int i : plan.interfaces.at(0).curves) {
      const auto& c = testing::curve(plan, i);
      const Point& a = point(plan, c.a);
      const Point& b = point(plan, c.b);
      // beyond the arc by twice the third of its height over a chord, the end of the last but one
      const double height = longest * longest / (8 * 1.25);
      if (c.chord == 0) {
        EXPECT_GE(std::hypot(b[0], b[1] + 0.75), 1.25 - 1e-12);
      }
      EXPECT_LE(std::hypot(b[0], b[1] + 0.75), 1.25 + 1.5 * height);
      EXPECT_EQ(c.intervals, 1);
      EXPECT_LE(length(plan, c), size * (1 + 1e-3));
      const double heading = std::atan2(b[1] - a[1], b[0] - a[0]);
      if (!first) {
        EXPECT_LE(std::abs(heading - before), 10.5 * std::numbers::pi / 180);
      }
      before = heading;
      first = false;
      tip = tip || a == from;
      const double middle = std::atan2((a[0] + b[0]) / 2, (a[1] + b[1]) / 2 + 0.75);
      const Kind expected = middle < -0.4 || middle > 0.3 ? Kind::glue
                            : middle < 0.1                ? Kind::inclusion
                                                          : Kind::delaminated;
      EXPECT_EQ(c.kind, expected) << middle;
    }
    EXPECT_TRUE(tip);
  }
}

/// 18 chords of five degrees on each half of an arc, and about 13 more towards its tip, where they
/// grow by a fifth of their distance from it.
TEST(Arrangement, ChordsBecomeShorterTowardsTips) {
  Geometry geometry = square();
  mesh::CrackSpec crack{"c", {}};
  crack.line = mesh::LineSpec{Shape::arc, {{-0.5, 0}, {0, 0.5}, {0.5, 0}}};
  geometry.cracks = {crack};
  const Plan plan = plan_of(geometry, 1);
  std::vector<double> turns;
  for (const mesh::PlannedCurve& curve : plan.curves)
    if (curve.bend >= 0) turns.push_back(90. / 5 * std::abs(curve.to - curve.from));
  EXPECT_NEAR(static_cast<double>(turns.size()), 2 * (18 + 12.7), 2);
  double from_tip = 0;
  for (std::size_t k = 0; 2 * k < turns.size(); ++k) {
    EXPECT_NEAR(turns[k], turns[turns.size() - 1 - k], 1e-3) << "symmetric";
    EXPECT_LE(turns[k], std::min(1.001, 1.15 * (0.03 + 0.2 * from_tip))) << k;
    EXPECT_GE(turns[k], std::min(0.93, 0.95 * (0.03 + 0.2 * from_tip))) << k;
    from_tip += turns[k];
  }
  EXPECT_NEAR(from_tip, 18, 1e-9);
}

TEST(Arrangement, SplinesPassTheirPointsAndMayBeClosed) {
  Geometry geometry = square();
  const std::vector<Point> points = {{0.5, 0}, {0, 0.5}, {-0.5, 0}, {0, -0.5}};
  geometry.interfaces = {{"s", Shape::spline, points, true}};
  const Plan plan = plan_of(geometry, 0.05);
  expect_consistent(plan, 4);
  ASSERT_EQ(plan.faces.size(), 2U);
  for (const Point& p : points) {
    EXPECT_EQ(std::count(plan.points.begin(), plan.points.end(), p), 1);
  }
  // between the square and the circle
  EXPECT_GT(areas(plan).at("omega2"), 0.5);
  EXPECT_LT(areas(plan).at("omega2"), 0.25 * std::numbers::pi);
}

TEST(Arrangement, CurvesCrossCurves) {
  Geometry geometry = square();
  geometry.interfaces = {{"arc", Shape::arc, {{-1, 0}, {0, 0.5}, {1, 0}}},
                         {"spline", Shape::spline, {{-0.5, -1}, {0.25, 0.25}, {0.5, 1}}, false},
                         polyline("line", {{-1, -0.5}, {1, 0.75}})};
  for (const double size : {0.02, 0.3}) {
    const Plan plan = plan_of(geometry, size);
    expect_consistent(plan, 4);
    EXPECT_EQ(plan.faces.size(), 7U);
    EXPECT_EQ(plan.interfaces.size(), 3U);
  }
}

TEST(Arrangement, AnInterfaceMayEndOnACurve) {
  Geometry geometry = square();
  geometry.interfaces = {
      {"arc", Shape::arc, {{-1, 0}, {0, 0.5}, {1, 0}}},
      polyline("b", {{1.25 * std::sin(0.2), 1.25 * std::cos(0.2) - 0.75}, {0.5, 1}})};
  const Plan plan = plan_of(geometry, 0.1);
  expect_consistent(plan, 4);
  EXPECT_EQ(plan.faces.size(), 3U);
}

Geometry varied() {
  Geometry geometry = square();
  geometry.interfaces = {
      polyline("a", {{-1, 0.125}, {0.25, 0}, {1, -0.25}}),
      {"b", Shape::arc, {{-0.25, 1}, {0.375, 0.25}, {0, -1}}},
      {"c", Shape::spline, {{-0.75, -0.75}, {-0.5, -0.25}, {-0.25, -0.75}}, true}};
  geometry.cracks = {{"k", {{-1, 0.125}, {0.25, 0}}}};
  geometry.neumann = {{{-1, 0.5}, {-1, -0.5}}};
  return geometry;
}

TEST(Arrangement, AMirroredGeometryGivesTheMirroredPlan) {
  const Plan plan = plan_of(varied(), 0.1);
  expect_consistent(plan, 4);
  Geometry other = varied();
  const auto flip = [](Point& p) { p[0] = -p[0]; };
  for (Point& p : other.boundary) flip(p);
  for (auto& line : other.interfaces) {
    for (Point& p : line.points) flip(p);
  }
  for (auto& c : other.cracks) {
    flip(c.part.from);
    flip(c.part.to);
  }
  for (auto& part : other.neumann) {
    flip(part.from);
    flip(part.to);
    std::swap(part.from, part.to);
  }
  const Plan mirrored = plan_of(other, 0.1);
  expect_consistent(mirrored, 4);
  ASSERT_EQ(mirrored.points.size(), plan.points.size());
  ASSERT_EQ(mirrored.curves.size(), plan.curves.size());
  ASSERT_EQ(mirrored.faces.size(), plan.faces.size());
  for (const Point& p : plan.points) {
    EXPECT_TRUE(std::any_of(mirrored.points.begin(), mirrored.points.end(), [&](const Point& q) {
      return std::hypot(p[0] + q[0], p[1] - q[1]) < 1e-12;
    }));
  }
  for (const Role role : {Role::interface, Role::neumann, Role::dirichlet}) {
    EXPECT_NEAR(length_of(mirrored, role), length_of(plan, role), 1e-12);
  }
}

TEST(Arrangement, SameInputSamePlan) {
  const Plan a = plan_of(varied(), 0.1);
  const Plan b = plan_of(varied(), 0.1);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.curves.size(), b.curves.size());
}

/// No curve's edges are much longer than those beside it.
void expect_gradual(const Plan& plan) {
  std::vector<std::pair<double, double>> edges(plan.points.size(), {1e300, 0});
  for (const auto& c : plan.curves) {
    const double edge = length(plan, c) / c.intervals;
    for (const int end : {c.a, c.b}) {
      auto& [least, most] = edges.at(static_cast<std::size_t>(end));
      least = std::min(least, edge);
      most = std::max(most, edge);
    }
  }
  for (const auto& [least, most] : edges) {
    if (most > 0) {
      EXPECT_LE(most, 2.5 * least);
    }
  }
}

TEST(Arrangement, InclusionsAHairApartHaveShortEdgesBetween) {
  for (const double gap : {1e-2, 1e-6}) {
    Geometry geometry = testing::paper_geometry();
    const mesh::Part left{{-0.5, 0}, {0, 0}};
    const mesh::Part right{{gap, 0}, {0.5, 0}};
    geometry.inclusions = {{"a", left, {left}}, {"b", right, {right}}};
    const Plan plan = mesh::plan(geometry, {}, enough);
    expect_consistent(plan, 4);
    expect_gradual(plan);
    EXPECT_LT(plan.curves.size(), 400U);
  }
}

TEST(Arrangement, AShortInclusionIsOneSegment) {
  Geometry geometry = testing::paper_geometry();
  const mesh::Part part{{0, 0}, {1e-4, 0}};
  geometry.inclusions = {{"a", part, {part}}};
  const Plan plan = mesh::plan(geometry, {}, enough);
  expect_consistent(plan, 4);
  expect_gradual(plan);
  EXPECT_EQ(count(plan, Kind::delaminated), 1);
}

TEST(Arrangement, LinesAHairApartHaveShortEdges) {
  Geometry geometry = square();
  geometry.interfaces = {polyline("a", {{-1, 0}, {1, 0}}), polyline("b", {{-1, 0.01}, {1, 0.02}})};
  const Plan plan = mesh::plan(geometry, {}, enough);
  expect_consistent(plan, 4);
  for (const auto& c : plan.curves) {
    if (c.role == Role::interface) {
      EXPECT_LE(length(plan, c) / c.intervals, 0.041);
    }
  }
  geometry.interfaces[1].points = {{-1, 1e-7}, {1, 2e-7}};
  EXPECT_TRUE(testing::throws([&] { mesh::plan(geometry, {}, enough); },
                              errors::Reason::limit_exceeded, "interfaces"));
}

}  // namespace
}  // namespace anticrack
