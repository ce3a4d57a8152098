// SPDX-License-Identifier: GPL-3.0-or-later
//
// Import of files as gmsh itself writes them.
#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "mesher/import.hpp"
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

/// gmsh with the paper's square and its groups, meshed coarsely.
class GmshFiles : public ::testing::Test {
 protected:
  GmshFiles() {
    // its graphics library keeps preferences in the home folder
    setenv("HOME", _folder.path().c_str(), 1);
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
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
  ~GmshFiles() override { gmsh::finalize(); }

  static void group(int dimension, const std::vector<int>& entities, int tag,
                    const std::string& name) {
    gmsh::model::addPhysicalGroup(dimension, entities, tag);
    gmsh::model::setPhysicalName(dimension, tag, name);
  }

  mesh::Mesh through(double version, bool binary) const {
    const std::string path = _folder / "case.msh";
    gmsh::option::setNumber("Mesh.MshFileVersion", version);
    gmsh::option::setNumber("Mesh.Binary", binary ? 1 : 0);
    gmsh::write(path);
    return mesher::import_msh({path, {}, enough});
  }

 private:
  testing::TemporaryFolder _folder;
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

TEST_F(GmshFiles, AllElementsSavedWithParametersAreRead) {
  gmsh::option::setNumber("Mesh.SaveAll", 1);
  gmsh::option::setNumber("Mesh.SaveParametric", 1);
  gmsh::model::mesh::generate(2);
  for (const bool binary : {false, true}) {
    EXPECT_EQ(through(4.1, binary).interfaces[0].name, "interface");
  }
}

TEST_F(GmshFiles, QuadranglesAreRefused) {
  gmsh::model::mesh::generate(2);
  // the nodes of the corners carry the numbers of their points
  gmsh::model::mesh::addElementsByType(1, 3, {}, {1, 2, 8, 5});
  for (const double version : {2.2, 4.1}) {
    for (const bool binary : {false, true}) {
      const auto error = testing::error_of([&] { through(version, binary); });
      ASSERT_TRUE(error);
      EXPECT_THAT(error->what(), HasSubstr("4-node quadrangles"));
    }
  }
}

TEST_F(GmshFiles, SecondOrderIsRefused) {
  gmsh::model::mesh::generate(2);
  gmsh::model::mesh::setOrder(2);
  for (const double version : {2.2, 4.1}) {
    for (const bool binary : {false, true}) {
      const auto error = testing::error_of([&] { through(version, binary); });
      ASSERT_TRUE(error);
      EXPECT_THAT(error->what(), HasSubstr("save first-order elements"));
    }
  }
}

TEST_F(GmshFiles, OtherVersionsAreRefused) {
  gmsh::model::mesh::generate(2);
  const auto error = testing::error_of([&] { through(4.0, false); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr("format 4 is not read"));
}

}  // namespace
}  // namespace anticrack
