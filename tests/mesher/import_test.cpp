// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/import.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesher/msh_writer.hpp"
#include "support/errors.hpp"

namespace anticrack {
namespace {

using mesh::Kind;
using mesh::Mesh;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::MshFormat;
using testing::MshSample;
using testing::rename;
using testing::square_sample;

Mesh import(const MshSample& sample, MshFormat format = MshFormat::ascii41) {
  return mesher::to_mesh(mesher::read_msh(testing::write_msh(sample, format), 1000), {});
}

std::vector<double> x_along(const Mesh& mesh, std::size_t interface = 0) {
  std::vector<double> x;
  for (const auto node : mesh.interfaces[interface].nodes) {
    x.push_back(mesh.xy[2 * static_cast<std::size_t>(node)]);
  }
  return x;
}

void unname(MshSample& sample, int dimension, int tag) {
  std::erase_if(sample.names,
                [&](const auto& n) { return n.dimension == dimension && n.tag == tag; });
}

TEST(Import, GroupsBecomeSubdomainsInterfaceAndBoundary) {
  for (const MshFormat format : testing::all_formats) {
    const Mesh mesh = import(square_sample(), format);
    EXPECT_EQ(mesh.node_count(), 25U);
    EXPECT_EQ(mesh.triangle_count(), 32U);
    EXPECT_THAT(mesh.subdomains, ElementsAre("minus", "plus"));
    EXPECT_THAT(mesh.inclusions, ElementsAre("stiffener"));
    EXPECT_EQ(mesh.dirichlet.size(), 16U);
    EXPECT_THAT(mesh.warnings, IsEmpty());
    ASSERT_EQ(mesh.interfaces.size(), 1U);
    EXPECT_EQ(mesh.interfaces[0].name, "interface");
    EXPECT_THAT(x_along(mesh), ElementsAre(-1, -0.5, 0, 0.5, 1));
    EXPECT_THAT(mesh.interfaces[0].kind,
                ElementsAre(Kind::glue, Kind::delaminated, Kind::delaminated, Kind::glue));
    EXPECT_THAT(mesh.interfaces[0].inclusion, ElementsAre(-1, 0, 0, -1));
  }
}

TEST(Import, CurvesMayBeCracksFreeBondedOrNamelessGlue) {
  EXPECT_EQ(import(square_sample("crack")).interfaces[0].kind[1], Kind::crack);
  EXPECT_EQ(import(square_sample("crack:one")).interfaces[0].kind[1], Kind::crack);
  EXPECT_EQ(import(square_sample("free")).interfaces[0].kind[1], Kind::free);
  EXPECT_EQ(import(square_sample("Free: one")).interfaces[0].kind[1], Kind::free);
  EXPECT_EQ(import(square_sample("inclusion:one")).interfaces[0].kind[1], Kind::inclusion);
  EXPECT_EQ(import(square_sample("")).interfaces[0].kind[1], Kind::glue);
  MshSample unnamed = square_sample();
  unname(unnamed, 1, 4);
  EXPECT_EQ(import(unnamed).interfaces[0].kind[1], Kind::glue);
}

TEST(Import, PartlyDelaminatedInclusionIsOne) {
  MshSample sample = square_sample();
  sample.lines.back().group = 5;
  sample.lines.back().entity = 13;
  sample.names.push_back({1, 5, "inclusion:stiffener"});
  const Mesh mesh = import(sample);
  EXPECT_THAT(mesh.inclusions, ElementsAre("stiffener"));
  EXPECT_THAT(mesh.interfaces[0].kind,
              ElementsAre(Kind::glue, Kind::delaminated, Kind::inclusion, Kind::glue));
  EXPECT_THAT(mesh.interfaces[0].inclusion, ElementsAre(-1, 0, 0, -1));
}

TEST(Import, TheSurfaceNamedPlusIsOnTheLeft) {
  MshSample sample = square_sample();
  rename(sample, 2, 1, "plus");
  rename(sample, 2, 2, "minus");
  EXPECT_THAT(x_along(import(sample)), ElementsAre(1, 0.5, 0, -0.5, -1));
  rename(sample, 2, 1, "lower");
  EXPECT_THAT(x_along(import(sample)), ElementsAre(1, 0.5, 0, -0.5, -1));
  rename(sample, 2, 2, "plus");
  EXPECT_THAT(x_along(import(sample)), ElementsAre(-1, -0.5, 0, 0.5, 1));
}

TEST(Import, WithoutThatNameTheCurvesDirectionDecides) {
  MshSample sample = square_sample();
  rename(sample, 2, 1, "a");
  rename(sample, 2, 2, "b");
  Mesh mesh = import(sample);
  EXPECT_THAT(x_along(mesh), ElementsAre(-1, -0.5, 0, 0.5, 1));
  EXPECT_THAT(mesh.warnings, IsEmpty());
  for (std::size_t i = sample.lines.size() - 2; i < sample.lines.size(); ++i) {
    std::swap(sample.lines[i].nodes[0], sample.lines[i].nodes[1]);
  }
  mesh = import(sample);
  EXPECT_THAT(x_along(mesh), ElementsAre(1, 0.5, 0, -0.5, -1));
  EXPECT_THAT(mesh.warnings, IsEmpty());
}

TEST(Import, WithoutADirectionTheHigherNumberIsPlus) {
  MshSample sample = square_sample();
  rename(sample, 2, 1, "a");
  rename(sample, 2, 2, "b");
  std::swap(sample.lines.back().nodes[0], sample.lines.back().nodes[1]);
  const Mesh mesh = import(sample);
  EXPECT_THAT(x_along(mesh), ElementsAre(-1, -0.5, 0, 0.5, 1));
  EXPECT_THAT(mesh.warnings,
              ElementsAre(HasSubstr(
                  "subdomain \"b\" is taken for its plus side: the lines on it run both ways")));
}

TEST(Import, WithoutDirichletCurveTheWholeBoundaryIsHeld) {
  MshSample sample = square_sample();
  unname(sample, 1, 3);
  Mesh mesh = import(sample);
  EXPECT_EQ(mesh.dirichlet.size(), 16U);
  EXPECT_THAT(mesh.warnings, ElementsAre(HasSubstr("dirichlet")));
  // what is called neumann stays free
  for (std::size_t i = 0; i < 4; ++i) {
    sample.lines[i].group = 6;
    sample.lines[i].entity = 14;
  }
  sample.names.push_back({1, 6, "neumann"});
  EXPECT_EQ(import(sample).dirichlet.size(), 12U);
}

TEST(Import, BoundaryWithoutNameIsFreeBesideADirichletCurve) {
  MshSample sample = square_sample();
  sample.lines.erase(sample.lines.begin(), sample.lines.begin() + 4);
  const Mesh mesh = import(sample);
  EXPECT_EQ(mesh.dirichlet.size(), 12U);
  EXPECT_THAT(mesh.warnings, ElementsAre(HasSubstr("4 edges in no curve group, the first at (-1, "
                                                   "-1), lie on the boundary: taken for neumann")));
}

TEST(Import, ClockwiseTrianglesAreTurnedAndUnusedNodesDropped) {
  MshSample sample = square_sample();
  std::swap(sample.triangles[3].nodes[0], sample.triangles[3].nodes[1]);
  sample.tags.push_back(7'000'000);
  // it may lie anywhere: the centre of an arc
  sample.points.push_back({0, 0, 5});
  const Mesh mesh = import(sample);
  EXPECT_EQ(mesh.node_count(), 25U);
  EXPECT_THAT(mesh.warnings, ElementsAre(HasSubstr("1 node that belongs to no triangle"),
                                         HasSubstr("1 triangle was clockwise")));
}

TEST(Import, AConstantZIsLetGo) {
  MshSample sample = square_sample();
  for (auto& p : sample.points) p[2] = 0.25;
  const Mesh mesh = import(sample);
  EXPECT_EQ(mesh.triangle_count(), 32U);
  EXPECT_THAT(mesh.warnings, ElementsAre("the mesh lies at z = 0.25: taken for z = 0"));
}

TEST(Import, PhysicalSurfacesWithoutNameAreCalledByTheirNumber) {
  MshSample sample = square_sample();
  unname(sample, 2, 1);
  unname(sample, 2, 2);
  EXPECT_THAT(import(sample).subdomains, ElementsAre("1", "2"));
}

TEST(Import, ThreeSurfacesGiveTwoInterfaces) {
  MshSample sample = square_sample("");
  for (auto& t : sample.triangles) {
    const bool top = std::min({t.nodes[0], t.nodes[1], t.nodes[2]}) >= sample.node(-1, 0.5);
    if (top) t.group = 5, t.entity = 25;
  }
  sample.names.push_back({2, 5, "top"});
  const Mesh mesh = import(sample);
  EXPECT_THAT(mesh.subdomains, ElementsAre("minus", "plus", "top"));
  ASSERT_EQ(mesh.interfaces.size(), 2U);
  EXPECT_EQ(mesh.interfaces[0].name, "interface-1");
  EXPECT_EQ(mesh.interfaces[1].name, "interface-2");
  EXPECT_THAT(x_along(mesh, 0), ElementsAre(-1, -0.5, 0, 0.5, 1));
  EXPECT_THAT(x_along(mesh, 1), ElementsAre(1, 0.5, 0, -0.5, -1));
}

TEST(Import, HoldsTheBoundOfTriangles) {
  const std::string bytes = testing::write_msh(square_sample(), MshFormat::binary22);
  EXPECT_EQ(mesher::import_msh(bytes, {}, 32).triangle_count(), 32U);
  EXPECT_TRUE(
      testing::throws([&] { mesher::import_msh(bytes, {}, 31); }, errors::Reason::limit_exceeded));
}

}  // namespace
}  // namespace anticrack
