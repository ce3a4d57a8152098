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

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

class RefusedImport : public ::testing::TestWithParam<Fault> {};

TEST_P(RefusedImport, SaysWhy) {
  MshSample sample = testing::square_sample();
  GetParam().make(sample);
  for (const auto format : {testing::MshFormat::ascii22, testing::MshFormat::binary41}) {
    const auto error = testing::error_of(
        [&] { mesher::to_mesh(mesher::read_msh(testing::write_msh(sample, format), 1000)); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->reason(), errors::Reason::mesh_invalid);
    EXPECT_THAT(error->what(), HasSubstr(GetParam().message));
  }
}

void name_middle(MshSample& sample, const std::string& name) {
  sample.names.back().name = name;
}

void add_curve(MshSample& sample, int from, int to, const std::string& name) {
  sample.lines.push_back({{from, to}, 5, 13});
  sample.names.push_back({1, 5, name});
}

const Fault faults[] = {
    {"NoTriangles", [](MshSample& s) { s.triangles.clear(); }, "the mesh has no triangle"},
    {"OneSurface",
     [](MshSample& s) {
       for (auto& t : s.triangles) t.group = 1, t.entity = 21;
     },
     "one surface, \"minus\"; an interface must cut"},
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
    {"OutOfPlane", [](MshSample& s) { s.points[12][2] = 0.25; }, "node 130 lies at z = 0.25"},
    {"NodeTwice", [](MshSample& s) { s.tags[1] = 10; }, "node 10 is there twice"},
    {"UnknownNode", [](MshSample& s) { s.triangles[0].nodes[0] = 999; },
     "triangle 19 has node 999, which the file does not define"},
    {"NoArea", [](MshSample& s) { s.points[6] = s.points[0]; }, "has no area"},
    {"TriangleTwice", [](MshSample& s) { s.triangles.push_back(s.triangles[0]); },
     "triangles overlap"},
    {"UnknownCurve", [](MshSample& s) { name_middle(s, "fissure"); },
     "physical curve 4 is named \"fissure\", which means nothing here"},
    {"CurveWithoutName", [](MshSample& s) { name_middle(s, "inclusion"); },
     "takes a name, \"inclusion:NAME\""},
    {"CurveWithBadName", [](MshSample& s) { name_middle(s, "delaminated:a b"); },
     "takes a name, \"delaminated:NAME\""},
    {"CrackNamedLikeInclusion",
     [](MshSample& s) {
       s.names.push_back({1, 8, "crack:stiffener"});
     },
     "\"stiffener\" is the name of a crack and of an inclusion"},
    {"DirichletInside", [](MshSample& s) { add_curve(s, 60, 70, "neumann"); },
     "lies inside the membrane"},
    {"CrackOnTheBoundary", [](MshSample& s) { add_curve(s, 10, 20, "crack"); },
     "a triangle on one side only"},
    {"CrackInsideASurface", [](MshSample& s) { add_curve(s, 60, 70, "crack"); },
     "has surface \"minus\" on both sides"},
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
     "belongs to two curves"},
    {"TipOnTheBoundary", [](MshSample& s) { add_curve(s, 110, 120, "inclusion:stiffener"); },
     "reaches the boundary at (-1, 0)"},
    {"SharedTip",
     [](MshSample& s) {
       s.lines.back().group = 5;
       s.lines.back().entity = 13;
       s.names.push_back({1, 5, "crack"});
     },
     "share the tip (0, 0)"},
    {"NothingHeld", [](MshSample& s) { s.names[2].name = "neumann"; },
     "nothing holds the membrane"},
    {"SurfacesApart",
     [](MshSample& s) {
       // the upper surface gets its own copies of the nodes on the interface
       for (int i = 0; i < 5; ++i) {
         s.tags.push_back(1000 + i);
         s.points.push_back({-1 + 0.5 * i, 0, 0});
       }
       for (auto& t : s.triangles) {
         for (int& node : t.nodes) {
           if (t.group == 2 && node >= 110 && node <= 150) node = 1000 + (node - 110) / 10;
         }
       }
       s.lines.clear();
       s.names.clear();
     },
     "shares no edge with another"},
    {"Island",
     [](MshSample& s) {
       for (auto& t : s.triangles) {
         t.group = 1, t.entity = 21;
         const bool around =
             t.nodes[0] == 70 || t.nodes[0] == 120 || t.nodes[0] == 80 || t.nodes[0] == 130;
         if (around) t.group = 2, t.entity = 22;
       }
       s.names.pop_back();
       s.lines.resize(16);
     },
     "closes to a ring"},
};

INSTANTIATE_TEST_SUITE_P(Each, RefusedImport, ::testing::ValuesIn(faults),
                         [](const auto& case_) { return case_.param.name; });

}  // namespace
}  // namespace anticrack
