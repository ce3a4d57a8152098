// SPDX-License-Identifier: GPL-3.0-or-later
//
// Faults of several lines, of what lies on them, of Neumann parts and regions.
#include "mesh/refusals.hpp"

namespace anticrack {
namespace {

using errors::Reason;
using mesh::Geometry;
using mesh::Shape;
using testing::add;
using testing::crack;
using testing::curve;
using testing::Fault;
using testing::nan_value;

class FaultyLines : public ::testing::TestWithParam<Fault> {};

TEST_P(FaultyLines, IsRefusedWithItsField) { testing::expect_refused(GetParam()); }

const Fault line_faults[] = {
    {"DelaminatedNan",
     [](Geometry& g) { g.inclusions[0].delaminated[0].to[0] = nan_value; },
     "inclusions[0].delaminated_parts[0].to",
     {"nan"}},
    {"TooManyInterfaces",
     [](Geometry& g) { g.interfaces.resize(1'001); },
     "interfaces",
     {"1001", "1000"},
     Reason::limit_exceeded},
    {"InterfaceNamesTwice",
     [](Geometry& g) {
       add(g, "interface", {{-1, 0.5}, {1, 0.5}});
     },
     "interfaces[1].name",
     {"already the name of interfaces[0]"}},
    {"InterfaceNameWrong",
     [](Geometry& g) { g.interfaces[0].name = "a b"; },
     "interfaces[0].name",
     {"\"a b\""}},
    {"ClosedOfTwoPoints",
     [](Geometry& g) { g.interfaces[0].closed = true; },
     "interfaces[0].polyline",
     {"2 vertices", "at least 3"}},
    {"ClosedRepeatsItsFirst",
     [](Geometry& g) {
       add(g, "b", {{0, 0.25}, {0.5, 0.25}, {0, 0.5}, {0, 0.25}}, true);
     },
     "interfaces[1].polyline",
     {"same point (0, 0.25)", "leave the last point out"}},
    {"ClosedTouchesTheBoundary",
     [](Geometry& g) {
       add(g, "b", {{-0.5, 0.5}, {0.5, 0.5}, {0, 1}}, true);
     },
     "interfaces[1].polyline",
     {"touches its boundary"}},
    {"InterfaceTwice",
     [](Geometry& g) {
       add(g, "b", {{1, 0}, {-1, 0}});
     },
     "interfaces[1].polyline",
     {R"(interface "b" and interface "interface" run along each other)"}},
    {"InterfacesPartlyAlongEachOther",
     [](Geometry& g) {
       add(g, "b", {{0, 1}, {0, 0}, {0.5, 0}, {1, -1}});
     },
     "interfaces[1].polyline",
     {"run along each other"}},
    {"InterfacesNearlyAlongEachOther",
     [](Geometry& g) {
       add(g, "b", {{-1, -0.005}, {1, 0.005}});
     },
     "interfaces[1].polyline",
     {"degrees", "nearly along each other"}},
    {"ArcTangentToAnInterface",
     [](Geometry& g) {
       curve(g, Shape::arc, {{-1, 0.5}, {0, 0}, {1, 0.5}});
     },
     "interfaces[1].arc",
     {"nearly along each other"}},
    {"ArcOfTwoPoints",
     [](Geometry& g) {
       curve(g, Shape::arc, {{-1, 0.5}, {1, 0.5}});
     },
     "interfaces[1].arc",
     {"2 points"}},
    {"ArcThatIsStraight",
     [](Geometry& g) {
       curve(g, Shape::arc, {{-1, 0.5}, {0, 0.5}, {1, 0.5}});
     },
     "interfaces[1].arc.through",
     {"straight line"}},
    {"ArcThatGoesStraightBack",
     [](Geometry& g) {
       curve(g, Shape::arc, {{0, 0.25}, {0, 0.75}, {1e-308, 0.125}});
     },
     "interfaces[1].arc.through",
     {"straight line"}},
    {"ArcOfARadiusFarBeyond",
     [](Geometry& g) {
       curve(g, Shape::arc, {{0, 0.25}, {0, 0.75}, {1e-9, 0.125}});
     },
     "interfaces[1].arc.through",
     {"straight line"}},
    {"ArcWithoutEnd",
     [](Geometry& g) {
       curve(g, Shape::arc, {{-1, 0.5}, {0, 0.5}, {-1, 0.5}});
     },
     "interfaces[1].arc.to",
     {"same point"}},
    {"ArcNan",
     [](Geometry& g) {
       curve(g, Shape::arc, {{-1, 0.5}, {nan_value, 0.5}, {1, 0.5}});
     },
     "interfaces[1].arc.through",
     {"nan"}},
    {"ArcClosed",
     [](Geometry& g) {
       curve(g, Shape::arc, {{-0.5, 0.5}, {0, 0.75}, {0.5, 0.5}});
       g.interfaces[1].closed = true;
     },
     "interfaces[1].arc",
     {"closed"}},
    {"ArcOutside",
     [](Geometry& g) {
       curve(g, Shape::arc, {{-0.5, 1}, {0, 1.5}, {0.5, 1}});
     },
     "interfaces[1].arc",
     {"outside the boundary"}},
    {"ArcFarOutside",
     [](Geometry& g) {
       curve(g, Shape::arc, {{-0.5, 1}, {1e99, 1e99}, {0.5, 1}});
     },
     "interfaces[1].arc.through",
     {"1e+99", "outside the boundary"}},
    {"SplineFarOutside",
     [](Geometry& g) {
       curve(g, Shape::spline, {{-0.5, 1}, {0, 0.5}, {-1e80, 1}});
     },
     "interfaces[1].spline.points[2]",
     {"-1e+80", "outside the boundary"}},
    {"PolylineFarOutside",
     [](Geometry& g) {
       add(g, "b", {{0, -1}, {1e60, 1}});
     },
     "interfaces[1].polyline.points[1]",
     {"1e+60", "outside the boundary"}},
    {"SplineOfTwoPoints",
     [](Geometry& g) {
       curve(g, Shape::spline, {{-1, 0.5}, {1, 0.5}});
     },
     "interfaces[1].spline",
     {"2 points", "at least 3"}},
    {"SplineRepeats",
     [](Geometry& g) {
       curve(g, Shape::spline, {{-1, 0.5}, {0, 0.5}, {0, 0.5}, {1, 0.5}});
     },
     "interfaces[1].spline.points[2]",
     {"repeats"}},
    {"SplineCrossesItself",
     [](Geometry& g) {
       curve(g, Shape::spline, {{-1, 0.5}, {0.5, 0.25}, {0.5, 0.75}, {-0.5, 0.25}, {0, 1}});
     },
     "interfaces[1].spline",
     {"crosses or touches itself"}},
    {"GlueThatSeparatesNothing",
     [](Geometry& g) {
       add(g, "b", {{-0.5, 0.5}, {0.5, 0.5}});
     },
     "interfaces[1].polyline",
     {"separates nothing", "crack", "options.align"}},
    {"GlueThatHangs",
     [](Geometry& g) {
       add(g, "b", {{0, 1}, {0, 0.5}});
     },
     "interfaces[1].polyline",
     {"separates nothing"}},

    {"PartOnTwoInterfaces",
     [](Geometry& g) {
       add(g, "b", {{0, -1}, {0, 1}});
       g.cracks = {{"c", {{0.75, 0}, {0, 0.5}}}};
     },
     "cracks[0].part",
     {R"(crack "c" starts on interface "interface" and ends on interface "b")"}},
    {"PartThatMayLieOnTwo",
     [](Geometry& g) {
       curve(g, Shape::arc, {{-0.25, 0}, {0, 0.25}, {0.25, 0}});
       g.inclusions.clear();
       g.cracks = {crack("c", -0.25, 0.25)};
     },
     "cracks[0].part",
     {R"(interface "interface" or on interface "curve")", "told apart"}},
    {"PartWithoutInterface",
     [](Geometry& g) { g.interfaces.clear(); },
     "inclusions[0].part.from",
     {"there is none"}},
    {"PartOffACurve",
     [](Geometry& g) {
       curve(g, Shape::arc, {{-1, 0}, {0, 0.5}, {1, 0}});
       g.cracks = {{"c", {{0, 0.5}, {0.25, 0.4748}}}};
     },
     "cracks[0].part.to",
     {"off the interface"}},
    {"InclusionsShareATip",
     [](Geometry& g) {
       g.inclusions.push_back({"b", {{0.5, 0}, {0.75, 0}}, {}});
     },
     "inclusions[1].part",
     {"share the tip (0.5, 0)", "make them one"}},
    {"RingAllCracked",
     [](Geometry& g) {
       add(g, "b", {{0, 0.25}, {0.5, 0.25}, {0, 0.5}}, true);
       g.cracks = {{"c", {{0, 0.25}, {0.5, 0.25}}}, {"d", {{0.5, 0.25}, {0, 0.25}}}};
     },
     "cracks[1].part",
     {"share the tip (0.5, 0.25)"}},
    {"PartsOverlapOverTheJointOfARing",
     [](Geometry& g) {
       add(g, "b", {{0, 0.25}, {0.5, 0.25}, {0, 0.5}}, true);
       g.cracks = {{"c", {{0, 0.375}, {0.25, 0.25}}}, {"d", {{0.125, 0.25}, {0.375, 0.25}}}};
     },
     "cracks[1].part",
     {"overlap"}},

    {"NeumannOff",
     [](Geometry& g) {
       g.neumann = {{{1, -1}, {0.5, 0.5}}};
     },
     "neumann[0].to",
     {"0.5 off the boundary"}},
    {"NeumannNan",
     [](Geometry& g) {
       g.neumann = {{{1, nan_value}, {1, 1}}};
     },
     "neumann[0].from",
     {"nan"}},
    {"NeumannOverlap",
     [](Geometry& g) {
       g.neumann = {{{1, -1}, {1, 1}}, {{1, 0.5}, {0, 1}}};
     },
     "neumann[1]",
     {"neumann[0]", "overlap"}},
    {"NeumannOverlapRoundTheStart",
     [](Geometry& g) {
       g.neumann = {{{-1, 0}, {0, -1}}, {{-0.5, -1}, {0.5, -1}}};
     },
     "neumann[1]",
     {"neumann[0]", "overlap"}},
    {"NeumannAllAndMore",
     [](Geometry& g) {
       g.neumann = {{{1, 0}, {1, 0}}, {{0, 1}, {-1, 1}}};
     },
     "neumann[1]",
     {"overlap"}},
    {"RegionOutside",
     [](Geometry& g) {
       g.regions = {{"r", {2, 0.5}, 1}};
     },
     "regions[0].at",
     {"outside the membrane"}},
    {"RegionOnAnInterface",
     [](Geometry& g) {
       g.regions = {{"r", {0.25, 0}, 1}};
     },
     "regions[0].at",
     {R"(lies on interface "interface")"}},
    {"RegionOnTheBoundary",
     [](Geometry& g) {
       g.regions = {{"r", {1, 0.5}, 1}};
     },
     "regions[0].at",
     {"lies on boundary"}},
    {"RegionsInOneSubdomain",
     [](Geometry& g) {
       g.regions = {{"r", {0, 0.5}, 1}, {"s", {0.5, 0.5}, 1}};
     },
     "regions[1].at",
     {R"(region "s": at (0.5, 0.5))", R"(region "r" names already)"}},
    {"RegionNamesTwice",
     [](Geometry& g) {
       g.regions = {{"r", {0, 0.5}, 1}, {"r", {0, -0.5}, 1}};
     },
     "regions[1].name",
     {"already the name of regions[0]"}},
    {"RegionNan",
     [](Geometry& g) {
       g.regions = {{"r", {nan_value, 0.5}, 1}};
     },
     "regions[0].at",
     {"nan"}},
    {"TensionNegative",
     [](Geometry& g) {
       g.regions = {{"r", {0, 0.5}, -2}};
     },
     "regions[0].tension",
     {"-2", "above 0"}},
    {"FixedNan",
     [](Geometry& g) { g.inclusions[0].motion.fixed = nan_value; },
     "inclusions[0].fixed",
     {"fixed at nan", "finite"}},
    {"FixedAndTilting",
     [](Geometry& g) {
       g.inclusions[0].motion = {true, 0.5};
     },
     "inclusions[0].fixed",
     {"fixed at 0.5 and tilts", "leave one of the two out"}},
    {"TensionNan",
     [](Geometry& g) {
       g.regions = {{"r", {0, 0.5}, nan_value}};
     },
     "regions[0].tension",
     {"nan"}},
};

INSTANTIATE_TEST_SUITE_P(Each, FaultyLines, ::testing::ValuesIn(line_faults),
                         [](const auto& case_) { return case_.param.name; });

}  // namespace
}  // namespace anticrack
