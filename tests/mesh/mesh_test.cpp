// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mesh.hpp"
#include "mesh/quality.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "support/errors.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack {
namespace {

using mesh::Kind;
using mesh::Mesh;
using ::testing::HasSubstr;

Mesh sound() {
  testing::StructuredOptions options;
  options.columns = 8;
  options.rows = 2;
  return testing::structured_mesh(options);
}

struct Damage {
  const char* name;
  std::function<void(Mesh&)> make;
  std::string message;
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }

class DamagedMesh : public ::testing::TestWithParam<Damage> {};

TEST_P(DamagedMesh, IsRefused) {
  Mesh mesh = sound();
  GetParam().make(mesh);
  const auto error = testing::error_of([&] { mesh::validate(mesh); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), errors::Reason::mesh_invalid);
  EXPECT_THAT(error->what(), HasSubstr(GetParam().message));
}

const Damage damages[] = {
    {"OddCoordinates", [](Mesh& m) { m.xy.push_back(0); }, "two a node"},
    {"OddTriangles", [](Mesh& m) { m.triangles.push_back(0); }, "three a triangle"},
    {"Empty", [](Mesh& m) { m = {}; }, "no triangle"},
    {"SubdomainCount", [](Mesh& m) { m.subdomain.pop_back(); }, "subdomain has 63 entries for 64"},
    {"NotFinite", [](Mesh& m) { m.xy[7] = std::numeric_limits<double>::quiet_NaN(); },
     "y of node 3 is nan"},
    {"NodeTooLarge", [](Mesh& m) { m.triangles[4] = 45; }, "triangle 1 has node 45"},
    {"NodeNegative", [](Mesh& m) { m.triangles[4] = -1; }, "triangle 1 has node -1"},
    {"SubdomainTooLarge", [](Mesh& m) { m.subdomain[5] = 2; }, "triangle 5 is in subdomain 2"},
    {"Clockwise", [](Mesh& m) { std::swap(m.triangles[3], m.triangles[4]); }, "triangle 1 at node"},
    {"NoArea", [](Mesh& m) { m.triangles[2] = m.triangles[1]; }, "has area 0"},
    {"EmptySubdomain", [](Mesh& m) { m.subdomains.push_back("third"); },
     "subdomain 2 (\"third\") has no triangle"},
    {"UnusedNode",
     [](Mesh& m) {
       m.xy.insert(m.xy.end(), {5.0, 6.0});
     },
     "node 45 (5, 6) belongs to no triangle"},
    {"TriangleTwice",
     [](Mesh& m) {
       m.triangles.insert(m.triangles.end(), {m.triangles[0], m.triangles[1], m.triangles[2]});
       m.subdomain.push_back(0);
     },
     "on the same side"},
    {"ShortInterface", [](Mesh& m) { m.interfaces[0].nodes = {18}; }, "has 1 nodes"},
    {"KindCount", [](Mesh& m) { m.interfaces[0].kind.pop_back(); }, "7 kinds"},
    {"InterfaceNode", [](Mesh& m) { m.interfaces[0].nodes[3] = 99; }, "node 99 at place 3"},
    {"UnknownKind", [](Mesh& m) { m.interfaces[0].kind[2] = static_cast<Kind>(6); }, "kind 6"},
    {"InclusionIndex", [](Mesh& m) { m.interfaces[0].inclusion[3] = 1; }, "has inclusion 1"},
    {"InclusionOnGlue", [](Mesh& m) { m.interfaces[0].inclusion[0] = 0; },
     "edge 0 of interface \"sigma\" has kind 1 and inclusion 0"},
    {"InclusionOnAFreeCrack", [](Mesh& m) { m.interfaces[0].kind[3] = Kind::free; },
     "kind 5 and inclusion 0"},
    {"NoInclusion", [](Mesh& m) { m.interfaces[0].inclusion[3] = -1; }, "kind 4 and inclusion -1"},
    {"InterfaceOffTheEdges", [](Mesh& m) { m.interfaces[0].nodes[1] = 20; },
     "belongs to 0 triangles"},
    {"InterfaceOnTheBoundary",
     [](Mesh& m) {
       m.interfaces.push_back({"edge", {0, 1}, {Kind::crack}, {-1}});
     },
     "belongs to 1 triangles; it takes one on each side"},
    {"GlueInsideASubdomain",
     [](Mesh& m) {
       m.interfaces.push_back({"stray", {10, 11}, {Kind::glue}, {-1}});
     },
     "is glue and has subdomain 0 on both sides"},
    {"ClosedChainOfOneEdge",
     [](Mesh& m) {
       m.interfaces.push_back({"fold", {10, 11, 10}, {Kind::crack, Kind::crack}, {-1, -1}});
     },
     "more than once"},
    {"TensionCount", [](Mesh& m) { m.tension = {1}; }, "tension has 1 entries for 2 subdomains"},
    {"TensionZero",
     [](Mesh& m) {
       m.tension = {1, 0};
     },
     "tension of subdomain 1 (\"upper\") is 0"},
    {"LawCount", [](Mesh& m) { m.tension_laws.resize(1); },
     "tension_laws has 1 entries for 2 subdomains"},
    {"LawWithoutAlong",
     [](Mesh& m) {
       m.tension_laws = {{"1", "", 0}, {"", "1", 0}};
     },
     "subdomain 1 (\"upper\"): the tension along is empty"},
    {"LawTurnedTooFar",
     [](Mesh& m) {
       m.tension_laws = {{"1", "", 361}, {}};
     },
     "the angle of the tension is 361"},
    {"TensionNotFinite",
     [](Mesh& m) {
       m.tension = {std::numeric_limits<double>::infinity(), 1};
     },
     "tension of subdomain 0 (\"lower\") is inf"},
    {"MotionCount", [](Mesh& m) { m.motions.resize(2); }, "motions has 2 entries for 1 inclusions"},
    {"FixedNowhere",
     [](Mesh& m) {
       m.motions = {{false, std::numeric_limits<double>::infinity()}};
     },
     "fixed at inf; give a finite"},
    {"FixedAndTilting",
     [](Mesh& m) {
       m.motions = {{true, 0.5}};
     },
     "fixed at 0.5 and tilts"},
    {"InterfaceTwice", [](Mesh& m) { m.interfaces.push_back(m.interfaces[0]); }, "more than once"},
    {"InterfaceMissing", [](Mesh& m) { m.interfaces.clear(); }, "lies on no interface"},
    {"DirichletInside",
     [](Mesh& m) {
       m.dirichlet.push_back({9, 10});
     },
     "belongs to 2 triangles"},
    {"DirichletNode",
     [](Mesh& m) {
       m.dirichlet.push_back({0, 45});
     },
     "joins nodes 0 and 45"},
    {"DirichletTwice",
     [](Mesh& m) {
       m.dirichlet.push_back({1, 0});
     },
     "dirichlet twice"},
};

INSTANTIATE_TEST_SUITE_P(Each, DamagedMesh, ::testing::ValuesIn(damages),
                         [](const auto& case_) { return case_.param.name; });

TEST(Mesh, SoundOneIsAccepted) {
  Mesh mesh = sound();
  EXPECT_NO_THROW(mesh::validate(mesh));
  for (const mesh::Motion& motion : {mesh::Motion{}, {true, {}}, {false, -0.5}}) {
    mesh.motions = {motion};
    EXPECT_NO_THROW(mesh::validate(mesh));
  }
}

/// All of it one subdomain: what was the interface no longer parts it.
Mesh whole() {
  Mesh mesh = sound();
  mesh.subdomains = {"all"};
  mesh.subdomain.assign(mesh.triangle_count(), 0);
  mesh.inclusions.clear();
  mesh.interfaces.clear();
  return mesh;
}

TEST(Mesh, WithoutInterfacesIsAccepted) { EXPECT_NO_THROW(mesh::validate(whole())); }

TEST(Mesh, TensionPerSubdomainIsAccepted) {
  Mesh mesh = sound();
  mesh.tension = {0.5, 2};
  EXPECT_NO_THROW(mesh::validate(mesh));
}

TEST(Mesh, SlitsMayCrossShareEndsAndReachTheBoundary) {
  Mesh mesh = whole();
  mesh.interfaces = {
      {"along", {18, 19, 20, 21}, {Kind::crack, Kind::crack, Kind::crack}, {-1, -1, -1}},
      {"across", {10, 19, 28}, {Kind::crack, Kind::crack}, {-1, -1}},
      {"next", {21, 30}, {Kind::crack}, {-1}}};
  EXPECT_NO_THROW(mesh::validate(mesh));
}

TEST(Mesh, ClosedChainsAreAccepted) {
  Mesh mesh = whole();
  // around two squares, one subdomain inside and outside
  mesh.interfaces = {{"ring",
                      {10, 11, 12, 21, 20, 19, 10},
                      std::vector<Kind>(6, Kind::crack),
                      std::vector<std::int32_t>(6, -1)}};
  EXPECT_NO_THROW(mesh::validate(mesh));
  // an island is glued all around
  mesh.subdomains = {"outside", "inside"};
  for (const std::size_t square : {9U, 10U}) {
    mesh.subdomain[2 * square] = mesh.subdomain[2 * square + 1] = 1;
  }
  mesh.interfaces[0].kind.assign(6, Kind::glue);
  EXPECT_NO_THROW(mesh::validate(mesh));
}

TEST(Mesh, AreaIsSigned) {
  Mesh mesh = sound();
  EXPECT_DOUBLE_EQ(mesh::area(mesh, 0), 0.25 * 0.5 / 2);
  std::swap(mesh.triangles[0], mesh.triangles[1]);
  EXPECT_DOUBLE_EQ(mesh::area(mesh, 0), -0.25 * 0.5 / 2);
}

TEST(Mesh, MinimumAngleIsThatOfTheSharpestCorner) {
  Mesh mesh;
  mesh.xy = {0, 0, 1, 0, 0, 1, 2, 0};
  mesh.triangles = {0, 1, 2};
  EXPECT_NEAR(mesh::minimum_angle(mesh), 45, 1e-12);
  mesh.triangles.insert(mesh.triangles.end(), {1, 3, 2});
  EXPECT_NEAR(mesh::minimum_angle(mesh), 18.434948822922, 1e-9);
}

TEST(Mesh, ArcLengthRunsAlongTheInterface) {
  const Mesh mesh = sound();
  const std::vector<double> s = mesh::arc_length(mesh, mesh.interfaces[0]);
  ASSERT_EQ(s.size(), 9U);
  for (std::size_t i = 0; i < s.size(); ++i) {
    EXPECT_DOUBLE_EQ(s[i], 0.25 * static_cast<double>(i));
  }
}

}  // namespace
}  // namespace anticrack
