// SPDX-License-Identifier: GPL-3.0-or-later
//
// Import of files as gmsh itself writes them.
#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "mesher/import_samples.hpp"
#include "support/errors.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack {
namespace {

using mesh::Kind;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t enough = 100'000;

namespace geo = gmsh::model::geo;

/// gmsh, and the way of its files through the import.
class Gmsh : public ::testing::Test {
 protected:
  Gmsh() {
    // its graphics library keeps preferences in the home folder
    setenv("HOME", _folder.path().c_str(), 1);
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
  }
  ~Gmsh() override { gmsh::finalize(); }

  static void group(int dimension, const std::vector<int>& entities, int tag,
                    const std::string& name) {
    gmsh::model::addPhysicalGroup(dimension, entities, tag);
    if (!name.empty()) gmsh::model::setPhysicalName(dimension, tag, name);
  }

  mesh::Mesh through(double version, bool binary, const mesh::MeshOptions& options = {}) const {
    const std::string path = _folder / "case.msh";
    gmsh::option::setNumber("Mesh.MshFileVersion", version);
    gmsh::option::setNumber("Mesh.Binary", binary ? 1 : 0);
    gmsh::write(path);
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    return mesher::import_msh(bytes, options, enough);
  }

  /// Calls with what each of the four formats brings.
  template <class Check>
  void each_format(const Check& check) const {
    for (const double version : {2.2, 4.1}) {
      for (const bool binary : {false, true}) {
        SCOPED_TRACE(version);
        SCOPED_TRACE(binary);
        check(through(version, binary));
      }
    }
  }

 private:
  testing::TemporaryFolder _folder;
};

/// The paper's square and its groups, meshed coarsely.
class GmshFiles : public Gmsh {
 protected:
  GmshFiles() { build(); }

  static void build() {
    const double x[] = {-1, 1, 1, -1, -1, -0.5, 0.5, 1};
    const double y[] = {-1, -1, 1, 1, 0, 0, 0, 0};
    for (int i = 0; i < 8; ++i) geo::addPoint(x[i], y[i], 0, 0.2, i + 1);
    const int ends[][2] = {{5, 6}, {6, 7}, {7, 8}, {5, 1}, {1, 2}, {2, 8}, {8, 3}, {3, 4}, {4, 5}};
    for (int i = 0; i < 9; ++i) geo::addLine(ends[i][0], ends[i][1], i + 1);
    geo::addCurveLoop({4, 5, 6, -3, -2, -1}, 1);
    geo::addCurveLoop({1, 2, 3, 7, 8, 9}, 2);
    geo::addPlaneSurface({1}, 1);
    geo::addPlaneSurface({2}, 2);
    geo::synchronize();
    group(2, {1}, 1, "minus");
    group(2, {2}, 2, "plus");
    group(1, {4, 5, 6, 7, 8, 9}, 3, "dirichlet");
    group(1, {2}, 4, "delaminated:stiffener");
  }
};

/// As text gmsh writes 16 digits, so the coordinates agree but for the last.
void expect_same(const mesh::Mesh& a, const mesh::Mesh& b) {
  EXPECT_THAT(a.xy, ::testing::Pointwise(::testing::DoubleNear(1e-15), b.xy));
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.subdomain, b.subdomain);
  EXPECT_EQ(a.dirichlet, b.dirichlet);
  EXPECT_EQ(a.interfaces[0].nodes, b.interfaces[0].nodes);
  EXPECT_EQ(a.interfaces[0].kind, b.interfaces[0].kind);
}

TEST_F(GmshFiles, FourFormatsGiveOneMesh) {
  gmsh::model::mesh::generate(2);
  const mesh::Mesh mesh = through(4.1, false);
  EXPECT_THAT(mesh.warnings, IsEmpty());
  EXPECT_THAT(mesh.subdomains, ElementsAre("minus", "plus"));
  EXPECT_THAT(mesh.inclusions, ElementsAre("stiffener"));
  ASSERT_EQ(mesh.interfaces.size(), 1U);
  const std::vector<double> s = mesh::arc_length(mesh, mesh.interfaces[0]);
  EXPECT_NEAR(s.back(), 2, 1e-12);
  for (std::size_t i = 0; i + 1 < s.size(); ++i) {
    const double middle = (s[i] + s[i + 1]) / 2;
    EXPECT_EQ(mesh.interfaces[0].kind[i],
              middle > 0.5 && middle < 1.5 ? Kind::delaminated : Kind::glue);
  }
  EXPECT_EQ(mesh.xy[2 * static_cast<std::size_t>(mesh.interfaces[0].nodes[0])], -1);
  expect_same(through(4.1, true), mesh);
  // the old format has its nodes in another order
  const mesh::Mesh old = through(2.2, false);
  EXPECT_EQ(old.triangle_count(), mesh.triangle_count());
  EXPECT_EQ(old.interfaces[0].kind, mesh.interfaces[0].kind);
  expect_same(through(2.2, true), old);
}

TEST_F(GmshFiles, OtherElementsAndNoneAreRefused) {
  const auto expect_refused = [this](const char* told) {
    for (const double version : {2.2, 4.1}) {
      for (const bool binary : {false, true}) {
        const auto error = testing::error_of([&] { through(version, binary); });
        ASSERT_TRUE(error);
        EXPECT_THAT(error->what(), HasSubstr(told));
      }
    }
  };
  expect_refused("; mesh i");  // there is a geometry alone
  gmsh::model::mesh::generate(2);
  gmsh::model::mesh::setOrder(2);
  expect_refused("save first-order elements");
  gmsh::model::mesh::setOrder(1);
  // the nodes of the corners carry the numbers of their points
  gmsh::model::mesh::addElementsByType(1, 3, {}, {1, 2, 8, 5});
  expect_refused("4-node quadrangles");
}

/// All interfaces together; 2 means 2 to rounding.
void expect_lengths(const mesh::Mesh& mesh, const std::map<Kind, double>& expected) {
  const auto found = testing::lengths(mesh);
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [kind, length] : expected) EXPECT_NEAR(found.at(kind), length, 1e-12);
}

/// Sets options and changes the model after it was meshed.
struct Written {
  const char* name;
  std::function<void()> change;
};

void set(const std::string& option, double value) { gmsh::option::setNumber(option, value); }

const Written written[] = {
    {"SaveAll", [] { set("Mesh.SaveAll", 1); }},
    {"SaveParametric", [] { set("Mesh.SaveParametric", 1); }},
    {"SaveParametricAll", [] { set("Mesh.SaveParametric", 1), set("Mesh.SaveAll", 1); }},
    {"SaveGroupsOfNodes", [] { set("Mesh.SaveGroupsOfNodes", 1); }},
    {"ElementTagType", [] { set("Mesh.SaveElementTagType", 3); }},
    {"Parts", [] { gmsh::model::mesh::partition(3); }},
    {"PartsAll", [] { gmsh::model::mesh::partition(3), set("Mesh.SaveAll", 1); }},
    {"PartsWithParameters", [] { gmsh::model::mesh::partition(2), set("Mesh.SaveParametric", 1); }},
    {"PartsWithoutTopology",
     [] { set("Mesh.PartitionCreateTopology", 0), gmsh::model::mesh::partition(3); }},
    {"PartsWithoutGroups",
     [] { set("Mesh.PartitionCreatePhysicals", 0), gmsh::model::mesh::partition(3); }},
    {"PartsWithGhosts",
     [] { set("Mesh.PartitionCreateGhostCells", 1), gmsh::model::mesh::partition(4); }},
    {"GroupOfPoints",
     [] {
       gmsh::model::addPhysicalGroup(0, {1, 2}, 13);
     }},
    {"Backwards",
     [] {
       gmsh::model::addPhysicalGroup(1, {-1, -3}, 7), gmsh::model::setPhysicalName(1, 7, "glue");
     }},
    {"Overlapping",
     [] {
       gmsh::model::addPhysicalGroup(1, {2}, 8),
           gmsh::model::setPhysicalName(1, 8, "inclusion:stiffener");
     }},
};

TEST_F(GmshFiles, WhatOptionsChangeIsTheSameMembrane) {
  for (const Written& of : written) {
    SCOPED_TRACE(of.name);
    gmsh::clear();
    build();
    gmsh::model::mesh::generate(2);
    const mesh::Mesh plain = through(4.1, false);
    of.change();
    for (const double version : {2.0, 2.1, 2.2, 4.1}) {
      for (const bool binary : {false, true}) {
        SCOPED_TRACE(version);
        SCOPED_TRACE(binary);
        if (version < 4 && std::string(of.name).ends_with("All")) {
          // gmsh leaves the groups out
          const auto error = testing::error_of([&] { through(version, binary); });
          ASSERT_TRUE(error);
          EXPECT_THAT(error->what(), HasSubstr("but none of its lines is in a group; save it as"));
          continue;
        }
        const mesh::Mesh mesh = through(version, binary);
        EXPECT_EQ(mesh.triangle_count(), plain.triangle_count());
        EXPECT_EQ(mesh.subdomains, plain.subdomains);
        EXPECT_EQ(mesh.inclusions, plain.inclusions);
        EXPECT_EQ(mesh.dirichlet.size(), plain.dirichlet.size());
        EXPECT_EQ(mesh.interfaces.size(), 1U);
        EXPECT_THAT(mesh.warnings, IsEmpty());
        expect_lengths(mesh, {{Kind::glue, 1}, {Kind::delaminated, 1}});
        for (const std::size_t s : {0U, 1U}) EXPECT_NEAR(testing::area_of(mesh, s), 2, 1e-9);
      }
    }
    for (const char* option : {"Mesh.SaveAll", "Mesh.SaveParametric", "Mesh.SaveGroupsOfNodes",
                               "Mesh.SaveElementTagType", "Mesh.PartitionCreateGhostCells"})
      set(option, 0);
    set("Mesh.PartitionCreateTopology", 1);
    set("Mesh.PartitionCreatePhysicals", 1);
  }
}

TEST_F(GmshFiles, GroupsOfPartsAreRefused) {
  gmsh::model::mesh::generate(2);
  set("Mesh.PartitionOldStyleMsh2", 0);
  gmsh::model::mesh::partition(3);
  const auto error = testing::error_of([&] { through(2.2, false); });
  set("Mesh.PartitionOldStyleMsh2", 1);
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr("groups of its own"));
}

TEST_F(GmshFiles, AnInclusionWithoutItsLinesIsMissed) {
  gmsh::model::mesh::generate(2);
  gmsh::model::removePhysicalGroups({{1, 4}});
  gmsh::model::setPhysicalName(1, 4, "delaminated:stiffener");
  each_format([&](const mesh::Mesh& mesh) {
    EXPECT_THAT(mesh.warnings,
                ElementsAre("curve group 4 \"delaminated:stiffener\" has no line in the file: left "
                            "out; save its curve with the surfaces"));
  });
}

TEST_F(GmshFiles, Version1IsRefused) {
  gmsh::model::mesh::generate(2);
  const auto error = testing::error_of([&] { through(1, false); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr("MSH 1, which is not read; convert it: gmsh old.msh -save"));
}

void crack(int group, int open_at = 0) {
  gmsh::plugin::setNumber("Crack", "Dimension", 1);
  gmsh::plugin::setNumber("Crack", "PhysicalGroup", group);
  gmsh::plugin::setNumber("Crack", "OpenBoundaryPhysicalGroup", open_at);
  gmsh::plugin::run("Crack");
}

std::size_t gmsh_nodes() {
  std::vector<std::size_t> tags;
  std::vector<double> xyz, parameters;
  gmsh::model::mesh::getNodes(tags, xyz, parameters);
  return tags.size();
}

TEST_F(GmshFiles, LipsOfTheCrackPluginAreMadeOne) {
  gmsh::model::mesh::generate(2);
  const std::size_t nodes = gmsh_nodes();
  crack(4);
  ASSERT_GT(gmsh_nodes(), nodes);
  each_format([&](const mesh::Mesh& mesh) {
    EXPECT_EQ(mesh.node_count(), nodes);
    EXPECT_THAT(mesh.subdomains, ElementsAre("minus", "plus"));
    EXPECT_THAT(mesh.inclusions, ElementsAre("stiffener"));
    ASSERT_EQ(mesh.interfaces.size(), 1U);
    expect_lengths(mesh, {{Kind::glue, 1}, {Kind::delaminated, 1}});
    EXPECT_NEAR(testing::area_of(mesh, 0), 2, 1e-12);
    EXPECT_NEAR(testing::area_of(mesh, 1), 2, 1e-12);
    EXPECT_THAT(mesh.warnings, ElementsAre(HasSubstr("that lie on another")));
  });
}

TEST_F(GmshFiles, OneLipWithLinesIsEnough) {
  gmsh::model::mesh::generate(2);
  crack(4);
  std::vector<int> entities;
  gmsh::model::getEntitiesForPhysicalGroup(1, 4, entities);
  ASSERT_EQ(entities.size(), 2U);
  gmsh::model::removePhysicalGroups({{1, 4}});
  group(1, {entities[0]}, 4, "crack");
  each_format([&](const mesh::Mesh& mesh) {
    expect_lengths(mesh, {{Kind::glue, 1}, {Kind::crack, 1}});
    EXPECT_EQ(mesh.warnings.size(), 1U);
  });
}

/// gmsh keeps their names.
void remove_groups() {
  gmsh::model::removePhysicalGroups();
  for (const char* name : {"dirichlet", "delaminated:stiffener"})
    gmsh::model::removePhysicalName(name);
}

TEST_F(GmshFiles, NamesOfGroupsThatAreNotThereAreRefusedUnlessCurvesAreGiven) {
  gmsh::model::mesh::generate(2);
  gmsh::model::removePhysicalGroups();
  for (const double version : {2.2, 4.1}) {
    const auto error = testing::error_of([&] { through(version, false); });
    ASSERT_TRUE(error);
    EXPECT_THAT(error->what(), HasSubstr("but none of its lines is in a group"));
    mesh::MeshOptions options;
    options.curve_groups = {{2, "delaminated:stiffener"}};
    expect_lengths(through(version, false, options), {{Kind::glue, 1}, {Kind::delaminated, 1}});
  }
}

TEST_F(GmshFiles, WithoutPhysicalGroupsAdjacencyDecides) {
  gmsh::model::mesh::generate(2);
  remove_groups();
  each_format([&](const mesh::Mesh& mesh) {
    EXPECT_THAT(mesh.subdomains, ElementsAre("1", "2"));
    expect_lengths(mesh, {{Kind::glue, 2}});
    EXPECT_THAT(mesh.warnings,
                ElementsAre(HasSubstr("the file has no physical surface"),
                            HasSubstr("curves 4, 5, 6, 7, 8, 9 (in no group) lie on the boundary: "
                                      "taken for dirichlet"),
                            HasSubstr("curves 1, 2, 3 (in no group) lie between two subdomains: "
                                      "taken for glue")));
  });
}

TEST_F(GmshFiles, ACrackWithoutPhysicalGroupsIsOne) {
  gmsh::model::mesh::generate(2);
  crack(4);
  remove_groups();
  each_format([&](const mesh::Mesh& mesh) {
    expect_lengths(mesh, {{Kind::glue, 1}, {Kind::crack, 1}});
  });
}

TEST_F(GmshFiles, ACurveInTwoGroupsTakesTheKeyword) {
  group(1, {1, 2, 3}, 9, "sigma");
  gmsh::model::mesh::generate(2);
  each_format([&](const mesh::Mesh& mesh) {
    expect_lengths(mesh, {{Kind::glue, 1}, {Kind::delaminated, 1}});
    EXPECT_THAT(mesh.warnings, ElementsAre(HasSubstr("curve group 9 \"sigma\" lies between two "
                                                     "subdomains: taken for glue")));
  });
}

/// A square with a line from its middle to the right, to its side or not so far.
class GmshSlit : public Gmsh {
 protected:
  void build(double end) {
    const double x[] = {-1, 1, 1, 1, -1, 0, end};
    const double y[] = {-1, -1, 0, 1, 1, 0, 0};
    const bool embedded = end < 1;
    for (int i = 0; i < (embedded ? 7 : 6); ++i) geo::addPoint(x[i], y[i], 0, 0.2, i + 1);
    for (int i = 1; i < 6; ++i) geo::addLine(i, i % 5 + 1, i);
    geo::addLine(6, embedded ? 7 : 3, 6);
    geo::addCurveLoop({1, 2, 3, 4, 5}, 1);
    geo::addPlaneSurface({1}, 1);
    geo::synchronize();
    gmsh::model::mesh::embed(1, {6}, 2, 1);
    group(2, {1}, 1, "plate");
    group(1, {1, 2, 3, 4, 5}, 2, "dirichlet");
    group(1, {6}, 3, "crack:slit");
    group(0, {3}, 4, "");
    gmsh::model::mesh::generate(2);
  }

  void expect_slit(double length, std::size_t nodes) const {
    each_format([&](const mesh::Mesh& mesh) {
      EXPECT_EQ(mesh.node_count(), nodes);
      EXPECT_THAT(mesh.subdomains, ElementsAre("plate"));
      ASSERT_EQ(mesh.interfaces.size(), 1U);
      expect_lengths(mesh, {{Kind::crack, length}});
      EXPECT_EQ(testing::points_of(mesh, 0).front(), (std::array<double, 2>{0, 0}));
      EXPECT_NEAR(testing::area_of(mesh, 0), 4, 1e-12);
    });
  }
};

TEST_F(GmshSlit, EmbeddedLineIsASlitDoubledOrNot) {
  build(0.5);
  const std::size_t nodes = gmsh_nodes();
  expect_slit(0.5, nodes);
  crack(3);
  ASSERT_GT(gmsh_nodes(), nodes);
  expect_slit(0.5, nodes);
}

TEST_F(GmshSlit, CrackOpenAtTheBoundary) {
  build(1);
  const std::size_t nodes = gmsh_nodes();
  crack(3, 4);
  ASSERT_GT(gmsh_nodes(), nodes);
  expect_slit(1, nodes);
}

TEST_F(Gmsh, DiskWithARing) {
  geo::addPoint(0, 0, 0, 0.2, 1);
  for (int ring = 0; ring < 2; ++ring) {
    const double r = ring == 0 ? 0.5 : 1;
    const int p = 2 + 4 * ring;
    geo::addPoint(r, 0, 0, 0.2, p);
    geo::addPoint(0, r, 0, 0.2, p + 1);
    geo::addPoint(-r, 0, 0, 0.2, p + 2);
    geo::addPoint(0, -r, 0, 0.2, p + 3);
    for (int i = 0; i < 4; ++i) geo::addCircleArc(p + i, 1, p + (i + 1) % 4, 1 + 4 * ring + i);
    geo::addCurveLoop({1 + 4 * ring, 2 + 4 * ring, 3 + 4 * ring, 4 + 4 * ring}, 1 + ring);
  }
  geo::addPlaneSurface({1}, 1);
  geo::addPlaneSurface({2, 1}, 2);
  geo::synchronize();
  group(2, {1}, 1, "core");
  group(2, {2}, 2, "around");
  group(1, {1, 2, 3, 4}, 3, "delaminated:wire");
  group(1, {5, 6, 7, 8}, 4, "Dirichlet");
  for (int i = 1; i <= 4; ++i) gmsh::model::mesh::setTransfiniteCurve(i, 11);
  gmsh::model::mesh::generate(2);
  each_format([&](const mesh::Mesh& mesh) {
    ASSERT_EQ(mesh.interfaces.size(), 1U);
    const auto& ring = mesh.interfaces[0];
    ASSERT_EQ(ring.nodes.size(), 41U);
    EXPECT_EQ(ring.nodes.front(), ring.nodes.back());
    // 40 chords of the circle
    const double angle = std::acos(-1.0) / 40;
    EXPECT_NEAR(testing::lengths(mesh).at(Kind::delaminated), 40 * std::sin(angle), 1e-9);
    EXPECT_NEAR(testing::area_of(mesh, 0), 40 * 0.125 * std::sin(2 * angle), 1e-9);
    // counterclockwise as its arcs, the core on its left
    const auto points = testing::points_of(mesh, 0);
    EXPECT_GT(points[0][0] * points[1][1] - points[1][0] * points[0][1], 0);
    EXPECT_THAT(mesh.warnings, IsEmpty());
  });
}

/// Two squares side by side, each with curves of its own, in so many pieces.
class GmshNeighbours : public Gmsh {
 protected:
  void build(int left_pieces, int right_pieces) {
    for (int side = 0; side < 2; ++side) {
      const double x[] = {0, 1, 1, 0};
      const double y[] = {0, 0, 1, 1};
      const int first = 1 + 4 * side;
      for (int i = 0; i < 4; ++i) geo::addPoint(x[i] + side, y[i], 0, 0.3, first + i);
      for (int i = 0; i < 4; ++i) geo::addLine(first + i, first + (i + 1) % 4, first + i);
      geo::addCurveLoop({first, first + 1, first + 2, first + 3}, 1 + side);
      geo::addPlaneSurface({1 + side}, 1 + side);
    }
    geo::synchronize();
    // curve 2 of the left lies on curve 8 of the right
    gmsh::model::mesh::setTransfiniteCurve(2, left_pieces + 1);
    gmsh::model::mesh::setTransfiniteCurve(8, right_pieces + 1);
    group(2, {1}, 1, "left");
    group(2, {2}, 2, "right");
    group(1, {1, 3, 4, 5, 6, 7}, 3, "dirichlet");
    gmsh::model::mesh::generate(2);
  }
};

TEST_F(GmshNeighbours, AreGluedWhereTheirNodesAgree) {
  build(5, 5);
  const std::size_t nodes = gmsh_nodes();
  each_format([&](const mesh::Mesh& mesh) {
    EXPECT_EQ(mesh.node_count(), nodes - 6);
    ASSERT_EQ(mesh.interfaces.size(), 1U);
    EXPECT_EQ(mesh.interfaces[0].nodes.size(), 6U);
    expect_lengths(mesh, {{Kind::glue, 1}});
    EXPECT_THAT(mesh.warnings, ElementsAre(HasSubstr("6 nodes that lie on another"),
                                           HasSubstr("meshed separately: taken for glue")));
  });
}

TEST_F(GmshNeighbours, AreRefusedWhereTheyDoNot) {
  for (const int pieces : {3, 10}) {
    gmsh::clear();
    build(5, pieces);
    const auto error = testing::error_of([&] { through(4.1, false); });
    ASSERT_TRUE(error);
    EXPECT_THAT(error->what(), HasSubstr("hanging node"));
    EXPECT_THAT(error->what(), HasSubstr("the same Transfinite Curve on both"));
  }
}

}  // namespace
}  // namespace anticrack
