// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/refusals.hpp"

namespace anticrack {
namespace {

using errors::Reason;
using mesh::Geometry;
using testing::crack;
using testing::Fault;
using testing::infinite;
using testing::nan_value;

class FaultyGeometry : public ::testing::TestWithParam<Fault> {};

TEST_P(FaultyGeometry, IsRefusedWithItsField) { testing::expect_refused(GetParam()); }

const Fault faults[] = {
    {"TwoVertices", [](Geometry& g) { g.boundary.resize(2); }, "boundary", {"2 vertices"}},
    {"NoVertices", [](Geometry& g) { g.boundary.clear(); }, "boundary", {"0 vertices"}},
    {"TooManyVertices",
     [](Geometry& g) { g.boundary.resize(20'001); },
     "boundary",
     {"20001 vertices", "20000"},
     Reason::limit_exceeded},
    {"BoundaryNan",
     [](Geometry& g) { g.boundary[3][1] = nan_value; },
     "boundary[3]",
     {"(-1, nan)"}},
    {"BoundaryMinute",
     [](Geometry& g) {
       for (auto& p : g.boundary) p = {1e-120 * p[0], 1e-120 * p[1]};
     },
     "boundary",
     {"across", "smaller unit"}},
    {"BoundaryHuge", [](Geometry& g) { g.boundary[2][0] = 1e300; }, "boundary[2]", {"1e+300"}},
    {"BoundaryRepeats",
     [](Geometry& g) {
       g.boundary.insert(g.boundary.begin() + 2, {1, -1});
     },
     "boundary[2]",
     {"repeats boundary[1]"}},
    {"BoundaryClosed",
     [](Geometry& g) {
       g.boundary.push_back({-1, -1});
     },
     "boundary[4]",
     {"repeats boundary[0]", "closes by itself"}},
    {"ZeroArea",
     [](Geometry& g) {
       g.boundary = {{0, 0}, {1, 1}, {3, 3}};
     },
     "boundary",
     {"no area", "straight line"}},
    {"Bowtie",
     [](Geometry& g) {
       g.boundary = {{-1, -1}, {1, 1}, {1, -1}, {-1, 1}};
     },
     "boundary",
     {"crosses", "from boundary[0] to boundary[1]", "from boundary[2] to boundary[3]"}},
    {"BoundaryTouchesItself",
     [](Geometry& g) {
       g.boundary = {{-1, -1}, {1, -1}, {1, 1}, {0, -1}, {-1, 1}};
     },
     "boundary",
     {"touches itself", "boundary[0] to boundary[1]"}},
    {"BoundarySpike",
     [](Geometry& g) {
       g.boundary = {{-1, -1}, {1, -1}, {1, 0.5}, {3, 0.5}, {2, 0.5}, {1, 1}, {-1, 1}};
     },
     "boundary",
     {"folds back", "boundary[2] to boundary[3]"}},
    {"BoundarySpikeAtTheStart",
     [](Geometry& g) {
       g.boundary = {{3, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
     },
     "boundary",
     {"folds back", "boundary[4] to boundary[0]"}},
    {"FarFromTheOrigin",
     [](Geometry& g) {
       for (auto& p : g.boundary) p[0] += 1e9;
     },
     "boundary",
     {"from the origin"}},

    {"InterfaceOnePoint",
     [](Geometry& g) { g.interfaces[0].points.resize(1); },
     "interfaces[0].polyline",
     {"1 vertices"}},
    {"InterfaceTooLong",
     [](Geometry& g) { g.interfaces[0].points.resize(20'001); },
     "interfaces",
     {"20001"},
     Reason::limit_exceeded},
    {"InterfaceInfinite",
     [](Geometry& g) { g.interfaces[0].points[1][0] = infinite; },
     "interfaces[0].polyline.points[1]",
     {"inf"}},
    {"InterfaceRepeats",
     [](Geometry& g) {
       g.interfaces[0].points = {{-1, 0}, {-1, 0}, {1, 0}};
     },
     "interfaces[0].polyline.points[1]",
     {R"(repeats interface "interface": points[0])"}},
    {"InterfaceEndsOutside",
     [](Geometry& g) {
       g.interfaces[0].points[1] = {1.5, 0};
     },
     "interfaces[0].polyline",
     {"leaves the membrane", "(1.5, 0)"}},
    {"InterfaceLeaves",
     [](Geometry& g) {
       g.interfaces[0].points = {{-1, 0}, {0, -2}, {1, 0}};
     },
     "interfaces[0].polyline",
     {"leaves the membrane", "(-1, 0) to (0, -2)"}},
    {"InterfaceOutside",
     [](Geometry& g) {
       g.interfaces[0].points = {{-1, 0}, {-2, 0}, {-2, 3}, {0, 3}, {0, 1}};
     },
     "interfaces[0].polyline",
     {"outside"}},
    {"InterfaceTouchesBetween",
     [](Geometry& g) {
       g.interfaces[0].points = {{-1, 0}, {0, 1}, {1, 0}};
     },
     "interfaces[0].polyline",
     {"touches its boundary", "(0, 1)"}},
    {"InterfaceTouchesCorner",
     [](Geometry& g) {
       g.boundary = {{-1, -1}, {1, -1}, {1, 1}, {0, 0}, {-1, 1}};
     },
     "interfaces[0].polyline",
     {"touches its boundary"}},
    {"InterfaceAlongTheBoundary",
     [](Geometry& g) {
       g.interfaces[0].points = {{-1, 1}, {1, 1}};
     },
     "interfaces[0].polyline",
     {"only its two ends"}},
    {"InterfacePartlyAlongTheBoundary",
     [](Geometry& g) {
       g.interfaces[0].points = {{-1, 0}, {-1, 0.5}, {1, 0}};
     },
     "interfaces[0].polyline",
     {"only its two ends"}},
    {"InterfaceWithinOneEdge",
     [](Geometry& g) {
       g.interfaces[0].points = {{-0.5, 1}, {0.5, 1}};
     },
     "interfaces[0].polyline",
     {"only its two ends"}},
    {"InterfaceCrossesItself",
     [](Geometry& g) {
       g.interfaces[0].points = {{-1, 0}, {0.5, 0}, {0, 0.5}, {0, -0.5}, {1, -0.5}};
     },
     "interfaces[0].polyline",
     {"crosses", R"(points[0] to interface "interface": points[1])",
      R"(points[2] to interface "interface": points[3])"}},
    {"InterfaceFoldsBack",
     [](Geometry& g) {
       g.interfaces[0].points = {{-1, 0}, {0.5, 0}, {0, 0}, {0, 1}};
     },
     "interfaces[0].polyline",
     {"folds back"}},
    {"InterfaceDoesNotCut",
     [](Geometry& g) {
       g.interfaces[0].points = {{-1, 0}, {0, 0}, {0, 0.5}, {-1, 0}};
     },
     "interfaces[0].polyline",
     {"starts and ends at the same point (-1, 0)"}},

    {"InclusionOff",
     [](Geometry& g) {
       g.inclusions[0].part.from = {-0.5, 0.25};
     },
     "inclusions[0].part.from",
     {"(-0.5, 0.25)", "0.25 off the interface"}},
    {"InclusionJustOff",
     [](Geometry& g) {
       g.inclusions[0].part.to = {0.5, 1e-5};
     },
     "inclusions[0].part.to",
     {"1e-05 off the interface", "nearest is (0.5, 0)"}},
    {"InclusionBeyond",
     [](Geometry& g) {
       g.inclusions[0].part.to = {1.5, 0};
     },
     "inclusions[0].part.to",
     {"0.5 off the interface"}},
    {"InclusionNan",
     [](Geometry& g) { g.inclusions[0].part.to[1] = nan_value; },
     "inclusions[0].part.to",
     {"nan"}},
    {"InclusionNanOnAnArc",
     [](Geometry& g) {
       g.interfaces[0].shape = mesh::Shape::arc;
       g.interfaces[0].points = {{-1, 0}, {0, 0.25}, {1, 0}};
       g.inclusions[0].part.from[0] = nan_value;
     },
     "inclusions[0].part.from",
     {"nan"}},
    {"InclusionWithoutLength",
     [](Geometry& g) {
       g.inclusions[0] = {"a", {{0.25, 0}, {0.25, 0}}, {}};
     },
     "inclusions[0].part",
     {"no length", "(0.25, 0)"}},
    {"CracksOverlap",
     [](Geometry& g) {
       g.cracks = {crack("a", 0.6, 0.8), crack("b", 0.9, 0.7)};
     },
     "cracks[1].part",
     {R"(crack "b" and crack "a" overlap)", "(0.7, 0)"}},
    {"CrackInsideInclusion",
     [](Geometry& g) { g.cracks = {crack("a", -0.1, 0.1)}; },
     "cracks[0].part",
     {R"(crack "a" and inclusion "inclusion" overlap)"}},
    {"SharedTip",
     [](Geometry& g) { g.cracks = {crack("a", 0.5, 0.7)}; },
     "cracks[0].part",
     {"share the tip (0.5, 0)", "leave a gap"}},
    {"DelaminatedOutside",
     [](Geometry& g) {
       g.inclusions[0].delaminated = {{{-0.5, 0}, {-0.4, 0}}, {{0, 0}, {0.6, 0}}};
     },
     "inclusions[0].delaminated_parts[1].to",
     {"(0.6, 0)", "outside its inclusion"}},
    {"DelaminatedOff",
     [](Geometry& g) {
       g.inclusions[0].delaminated = {{{-0.5, 0.5}, {0, 0}}};
     },
     "inclusions[0].delaminated_parts[0].from",
     {"0.5 off the interface"}},
    {"DelaminatedWithoutLength",
     [](Geometry& g) {
       g.inclusions[0].delaminated = {{{0, 0}, {0, 0}}};
     },
     "inclusions[0].delaminated_parts[0]",
     {"no length"}},
    {"DelaminatedOverlap",
     [](Geometry& g) {
       g.inclusions[0].delaminated = {{{0, 0}, {0.3, 0}}, {{-0.4, 0}, {0.1, 0}}};
     },
     "inclusions[0].delaminated_parts[0]",
     {"delaminated[1]", "overlap"}},
    {"DelaminatedTouch",
     [](Geometry& g) {
       g.inclusions[0].delaminated = {{{-0.4, 0}, {0, 0}}, {{0, 0}, {0.3, 0}}};
     },
     "inclusions[0].delaminated_parts[1]",
     {"touch at (0, 0)"}},

    {"NameEmpty",
     [](Geometry& g) { g.inclusions[0].name.clear(); },
     "inclusions[0].name",
     {"empty"}},
    {"NameWrong",
     [](Geometry& g) { g.inclusions[0].name = "1st"; },
     "inclusions[0].name",
     {"\"1st\"", "a letter"}},
    {"NameWithSlash",
     [](Geometry& g) { g.inclusions[0].name = "a/b"; },
     "inclusions[0].name",
     {"\"a/b\""}},
    {"NameWithLineBreak",
     [](Geometry& g) { g.inclusions[0].name = "a\nb"; },
     "inclusions[0].name",
     {"not printable"}},
    {"NameTooLong",
     [](Geometry& g) { g.inclusions[0].name = std::string(65, 'a'); },
     "inclusions[0].name",
     {"65 characters"}},
    {"NameTwice",
     [](Geometry& g) { g.cracks = {crack("inclusion", 0.6, 0.8)}; },
     "cracks[0].name",
     {"\"inclusion\" is already the name of inclusions[0]"}},
};

INSTANTIATE_TEST_SUITE_P(Each, FaultyGeometry, ::testing::ValuesIn(faults),
                         [](const auto& case_) { return case_.param.name; });

TEST(Geometry, PointsWithinTheToleranceAreOnTheInterface) {
  Geometry geometry = testing::paper_geometry();
  geometry.inclusions[0].part.to = {0.5, 1e-9};
  EXPECT_NO_THROW(mesh::plan(geometry, {}, 1'000'000));
}

TEST(Geometry, NamesMayHave64Characters) {
  Geometry geometry = testing::paper_geometry();
  geometry.inclusions[0].name = "z" + std::string(59, '9') + "_.-Z";
  EXPECT_NO_THROW(mesh::plan(geometry, {}, 1'000'000));
}

}  // namespace
}  // namespace anticrack
