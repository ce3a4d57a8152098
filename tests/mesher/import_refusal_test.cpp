// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "mesher/import.hpp"
#include "mesher/msh_writer.hpp"
#include "support/errors.hpp"

namespace anticrack {
namespace {

using ::testing::HasSubstr;
using testing::MshSample;

struct Fault {
  const char* name;
  std::function<void(MshSample&)> make;
  std::string message;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class RefusedImport : public ::testing::TestWithParam<Fault> {};

TEST_P(RefusedImport, SaysWhy) {
  MshSample sample = testing::square_sample();
  GetParam().make(sample);
  for (const auto format : {testing::MshFormat::ascii22, testing::MshFormat::binary41}) {
    const auto error = testing::error_of(
        [&] { mesher::to_mesh(mesher::read_msh(testing::write_msh(sample, format), 1000), {}); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->reason(), errors::Reason::mesh_invalid);
    EXPECT_THAT(error->what(), HasSubstr(GetParam().message));
  }
}

void name_middle(MshSample& sample, const std::string& name) { sample.names.back().name = name; }

void add_curve(MshSample& sample, int from, int to, const std::string& name) {
  sample.lines.push_back({{from, to}, 5, 13});
  sample.names.push_back({1, 5, name});
}

const Fault faults[] = {
    {"NoTriangles", [](MshSample& s) { s.triangles.clear(); }, "the mesh has no triangle"},
    {"SurfaceWithoutGroup",
     [](MshSample& s) {
       for (auto& t : s.triangles) t.group = t.group == 1 ? 0 : 2;
     },
     "of surface 21 is in no physical surface"},
    {"NameEqualsANumber",
     [](MshSample& s) {
       s.names[0].name = "2";
       s.names.erase(s.names.begin() + 1);
     },
     "the same name"},
    {"TooFarAway",
     [](MshSample& s) {
       for (auto& p : s.points) p[0] += 1e9;
     },
     "2 across, but lies 1e+09 from the origin"},
    {"OutOfPlane", [](MshSample& s) { s.points[12][2] = 0.25; },
     "node 10 lies at z = 0, node 130 at z = 0.25"},
    {"NodeTwice", [](MshSample& s) { s.tags[1] = 10; }, "node 10 is defined twice"},
    {"UnknownNode", [](MshSample& s) { s.triangles[0].nodes[0] = 999; },
     "triangle 19 has node 999, which the file does not define"},
    {"NoArea", [](MshSample& s) { s.points[6] = s.points[0]; }, "has no area"},
    {"TriangleTwice", [](MshSample& s) { s.triangles.push_back(s.triangles[0]); },
     "are the same, at the edge of nodes 10 and 20"},
    {"TriangleInTwoSurfaces",
     [](MshSample& s) {
       s.triangles.push_back(s.triangles[0]);
       s.triangles.back().group = 2, s.triangles.back().entity = 22;
     },
     "is in the physical surfaces 1 and 2; a surface belongs to one subdomain"},
    {"TrianglesOverlap",
     [](MshSample& s) {
       s.triangles.push_back({{10, 20, 130}, 2, 22});
     },
     "overlap at the edge of nodes 10 and 20"},
    {"TooLarge", [](MshSample& s) { s.points[24][0] = 1e200; },
     "node 250 has a coordinate of 1e+200"},
    {"CurveWithoutName", [](MshSample& s) { name_middle(s, "inclusion"); },
     "takes a name, \"inclusion:NAME\""},
    {"CurveWithoutNameAfterTheColon", [](MshSample& s) { name_middle(s, "Crack:"); },
     "curve group 4 \"Crack:\" takes a name, \"crack:NAME\""},
    {"CurveWithBadName", [](MshSample& s) { name_middle(s, "delaminated:a b"); },
     "takes a name, \"delaminated:NAME\""},
    {"CrackNamedLikeInclusion",
     [](MshSample& s) {
       s.names.push_back({1, 8, "crack:stiffener"});
     },
     "\"stiffener\" is the name of a crack and of an inclusion"},
    {"TwoInclusionsOnOneEdge", [](MshSample& s) { add_curve(s, 120, 130, "inclusion:other"); },
     "which do not go together"},
    {"DirichletInside", [](MshSample& s) { add_curve(s, 60, 70, "neumann"); },
     "lies inside the membrane"},
    {"CrackOnTheBoundary",
     [](MshSample& s) {
       s.lines.erase(s.lines.begin());
       add_curve(s, 10, 20, "crack");
     },
     "the edge (-1, -1)-(-0.5, -1) of curve group 5 \"crack\" has a triangle on one side only"},
    {"CurveOffTheTriangles", [](MshSample& s) { add_curve(s, 10, 130, "crack"); },
     "is the edge of no triangle"},
    {"CurveWithStrayNode",
     [](MshSample& s) {
       s.tags.push_back(999);
       s.points.push_back({3, 3, 0});
       add_curve(s, 10, 999, "crack");
     },
     "has a node that belongs to no triangle"},
    {"EdgeInTwoCurves", [](MshSample& s) { add_curve(s, 130, 120, "crack"); },
     "is in curve group 4 \"delaminated:stiffener\" and in curve group 5 \"crack\""},
    {"NothingHeld", [](MshSample& s) { s.names[2].name = "neumann"; },
     "nothing holds the membrane"},
};

INSTANTIATE_TEST_SUITE_P(Each, RefusedImport, ::testing::ValuesIn(faults),
                         [](const auto& case_) { return case_.param.name; });

}  // namespace
}  // namespace anticrack
