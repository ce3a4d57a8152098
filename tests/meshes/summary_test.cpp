// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "mesh/refine.hpp"
#include "meshes/tension_laws.hpp"
#include "support/errors.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::meshes {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

mesh::Mesh example() {
  anticrack::testing::StructuredOptions options;
  options.columns = 8;
  options.rows = 4;
  mesh::Mesh mesh = anticrack::testing::structured_mesh(options);
  mesh.warnings = {"assumed"};
  return mesh;
}

TEST(Summary, CountsAndMeasures) {
  records::MeshRecord record;
  summarize(example(), record);
  EXPECT_EQ(record.node_count, 81U);
  EXPECT_EQ(record.triangle_count, 128U);
  EXPECT_THAT(record.warnings, ElementsAre("assumed"));
  EXPECT_EQ(record.inclusions.size(), 1U);
  EXPECT_NEAR(record.minimum_angle, 45, 1e-9);
  ASSERT_EQ(record.subdomains.size(), 2U);
  for (const records::SubdomainSummary& subdomain : record.subdomains) {
    EXPECT_EQ(subdomain.node_count, 45U);  // the interface's in both
    EXPECT_EQ(subdomain.triangle_count, 64U);
    EXPECT_NEAR(subdomain.area, 2, 1e-12);
  }
}

TEST(Summary, SaysOfTwentyInclusionsWhyTheyDoNotTilt) {
  mesh::Mesh mesh = example();
  const auto& edges = mesh.interfaces[0].inclusion;
  const auto first = std::ranges::find(edges, 0) - edges.begin();
  mesh.inclusions.clear();
  for (std::int32_t j = 0; j < 23; ++j) {  // the last alone does not tilt
    mesh.inclusions.push_back(std::to_string(j));
    mesh.motions.push_back({j < 22, {}});
    mesh::Interface own = mesh.interfaces[0];
    for (auto& inclusion : own.inclusion) inclusion = -1;
    own.inclusion[static_cast<std::size_t>(first)] = j;
    mesh.interfaces.push_back(own);
  }
  mesh.interfaces.erase(mesh.interfaces.begin());
  records::MeshRecord record;
  summarize(mesh, record);
  ASSERT_EQ(record.warnings.size(), 1U + 20 + 1);
  EXPECT_THAT(record.warnings[1], ::testing::HasSubstr("\"0\" does not tilt"));
  EXPECT_EQ(record.warnings.back(), "and 2 more such inclusions");
}

TEST(Summary, JoinsEdgesOfOneKindToSegments) {
  records::MeshRecord record;
  record.interfaces.resize(3);  // of an attempt before
  summarize(example(), record);
  ASSERT_EQ(record.interfaces.size(), 1U);
  const records::InterfaceSummary& interface = record.interfaces[0];
  EXPECT_NEAR(interface.length, 2, 1e-12);
  EXPECT_EQ(interface.node_count, 9U);
  EXPECT_THAT(interface.start.value(), ElementsAre(DoubleNear(-1, 1e-12), DoubleNear(0, 1e-12)));
  ASSERT_EQ(interface.segments.size(), 3U);
  EXPECT_EQ(interface.segments[0].kind, mesh::Kind::glue);
  EXPECT_EQ(interface.segments[0].inclusion, -1);
  EXPECT_THAT(interface.segments[0].end, DoubleNear(0.5, 1e-12));
  EXPECT_EQ(interface.segments[1].kind, mesh::Kind::delaminated);
  EXPECT_EQ(interface.segments[1].inclusion, 0);
  EXPECT_THAT(interface.segments[1].begin, DoubleNear(0.5, 1e-12));
  EXPECT_THAT(interface.segments[1].end, DoubleNear(1.5, 1e-12));
  EXPECT_EQ(interface.segments[1].edge_count, 4U);
  EXPECT_EQ(interface.segments[2].edge_count, 2U);
}

TEST(Summary, SeparatesSegmentsOfDifferentInclusions) {
  anticrack::testing::StructuredOptions options;
  options.columns = 8;
  options.inclusions = {"left", "right"};
  options.kind = [](double) { return mesh::Kind::delaminated; };
  options.inclusion = [](double x) { return x < 0 ? 0 : 1; };
  records::MeshRecord record;
  summarize(anticrack::testing::structured_mesh(options), record);
  ASSERT_EQ(record.interfaces[0].segments.size(), 2U);
  EXPECT_EQ(record.interfaces[0].segments[1].inclusion, 1);
}

TEST(Summary, MeasuresShapesAndTheBoundary) {
  mesh::Mesh mesh = example();
  mesh.tension = {1, 2.5};
  mesh.bisection_bound = 44;
  std::erase_if(mesh.dirichlet, [&](const auto& edge) {  // the bottom
    return mesh.xy[2 * static_cast<std::size_t>(edge[0]) + 1] == -1 &&
           mesh.xy[2 * static_cast<std::size_t>(edge[1]) + 1] == -1;
  });
  records::MeshRecord record;
  summarize(mesh, record);
  EXPECT_EQ(record.subdomains[0].tension, 1);
  EXPECT_EQ(record.subdomains[1].tension, 2.5);
  for (const records::SubdomainSummary& subdomain : record.subdomains) {
    EXPECT_NEAR(subdomain.minimum_angle, 45, 1e-9);
    EXPECT_NEAR(subdomain.shortest_edge, 0.25, 1e-12);
    EXPECT_NEAR(subdomain.longest_edge, std::sqrt(0.125), 1e-12);
    EXPECT_FALSE(subdomain.floating);
  }
  EXPECT_EQ(record.bisection_bound, 44);
  EXPECT_FALSE(record.subdomains[1].tension_law);
  EXPECT_NEAR(record.dirichlet_length, 6, 1e-12);
  EXPECT_NEAR(record.neumann_length, 2, 1e-12);
  summarize(mesh, record);  // of an attempt before
  EXPECT_NEAR(record.neumann_length, 2, 1e-12);
}

TEST(Summary, TellsTheMeanOfALawOrWhereItWasWritten) {
  mesh::Mesh mesh = example();  // from -1 to 1
  mesh.tension_laws.resize(2);
  mesh.tension_laws[1] = {"3 + x", "1", 30};
  records::MeshRecord record;
  summarize(mesh, record);
  EXPECT_EQ(record.subdomains[0].tension, 1);
  EXPECT_NEAR(record.subdomains[1].tension, 2, 1e-12);
  EXPECT_EQ(record.subdomains[1].tension_law, mesh.tension_laws[1]);

  mesh.tension_laws[1].across = "x";
  const auto field_with = [&](const records::MeshDefinition& definition) {
    record.definition = definition;
    return anticrack::testing::error_of([&] { summarize(mesh, record); })->fields().front().field;
  };
  records::GeometrySource source;
  source.geometry.regions = {{"other"}, {mesh.subdomains[1]}};
  EXPECT_EQ(field_with(source), "geometry.regions[1].tension_law.across");
  EXPECT_EQ(field_with(records::UploadRef{}),
            "options.tension_laws[" + mesh.subdomains[1] + "].across");
  EXPECT_EQ(field_with(records::Refinement{}), "tension_law.across");
}

TEST(Laws, AreLookedAtInThePointOfTheirRegionIfItHasOne) {
  records::GeometrySource source;
  mesh::RegionSpec& region = source.geometry.regions.emplace_back();
  region.at = {0, 0};
  region.tension_law = mesh::TensionLaw{"x - 0.1", "", 0};
  EXPECT_EQ(anticrack::testing::error_of([&] { check_laws(source, 100); })->fields().front().field,
            "regions[0].tension_law.along");
  region.outline = mesh::OutlineSpec{mesh::Shape::circle, {{0.6, 0.6}}, 0.2};
  EXPECT_NO_THROW(check_laws(source, 100));
}

TEST(Summary, TellsTheTipsAndHowFineTheMeshIsThere) {
  const mesh::Mesh fine = mesh::grade(example(), {.h0 = 0.4, .tip_size = 1e-3}, 100'000);
  records::MeshRecord record;
  summarize(fine, record);
  ASSERT_EQ(record.tips.size(), 2U);
  EXPECT_EQ(record.tips[0].at, (mesh::Point{-0.5, 0}));
  EXPECT_EQ(record.tips[1].at, (mesh::Point{0.5, 0}));
  for (const records::TipSummary& tip : record.tips) {
    EXPECT_EQ(tip.interface, "sigma");
    EXPECT_LE(tip.smallest_edge, 1e-3);
    EXPECT_GT(tip.smallest_edge, 0.2e-3);
  }
}

TEST(Summary, ASubdomainFloatsWhereOnlyInterfacesHoldAPartOfIt) {
  mesh::Mesh mesh = example();
  const auto floating = [&] {
    records::MeshRecord record;
    summarize(mesh, record);
    return std::vector<bool>{record.subdomains[0].floating, record.subdomains[1].floating};
  };
  // the upper one keeps the ends of the interface, which the lower one's sides hold
  std::erase_if(mesh.dirichlet, [&](const auto& edge) {
    return mesh.xy[2 * static_cast<std::size_t>(edge[0]) + 1] > 0 ||
           mesh.xy[2 * static_cast<std::size_t>(edge[1]) + 1] > 0;
  });
  EXPECT_THAT(floating(), ElementsAre(false, false));
  // now the bottom alone is held
  std::erase_if(mesh.dirichlet, [&](const auto& edge) {
    return mesh.xy[2 * static_cast<std::size_t>(edge[0]) + 1] != -1 ||
           mesh.xy[2 * static_cast<std::size_t>(edge[1]) + 1] != -1;
  });
  EXPECT_THAT(floating(), ElementsAre(false, true));
  // a slit parts nothing while one can walk around its end, and does when it goes all the way
  mesh.subdomain.assign(mesh.triangle_count(), 0);
  mesh.subdomains = {"all", "none"};
  mesh::Interface whole = mesh.interfaces[0];
  mesh.interfaces[0].nodes.pop_back();
  mesh.interfaces[0].kind.pop_back();
  mesh.interfaces[0].inclusion.pop_back();
  EXPECT_THAT(floating(), ElementsAre(false, false));
  mesh.interfaces[0] = whole;
  EXPECT_THAT(floating(), ElementsAre(true, false));
}

TEST(MeshBlock, HoldsTheArraysOfTheMesh) {
  const mesh::Mesh mesh = example();
  const records::Block block = mesh_block(mesh);
  std::vector<std::string> names;
  for (const records::ArrayLayout& array : block.arrays) {
    names.push_back(array.name);
  }
  EXPECT_THAT(names,
              ElementsAre("nodes", "triangles", "subdomain", "boundary", "interfaces/0/nodes",
                          "interfaces/0/edge_kind", "interfaces/0/edge_inclusion"));
  EXPECT_THAT(block.arrays[0].shape, ElementsAre(81, 2));
  EXPECT_THAT(block.arrays[1].shape, ElementsAre(128, 3));
  EXPECT_THAT(block.arrays[2].shape, ElementsAre(128));
  EXPECT_THAT(block.arrays[3].shape, ElementsAre(32, 2));
  EXPECT_THAT(block.arrays[4].shape, ElementsAre(9));
  EXPECT_THAT(block.arrays[5].shape, ElementsAre(8));
  std::vector<double> xy(mesh.xy.size());
  std::memcpy(xy.data(), block.bytes.data() + block.arrays[0].offset, xy.size() * sizeof(double));
  EXPECT_EQ(xy, mesh.xy);
  std::vector<std::int32_t> kinds(8);
  std::memcpy(kinds.data(), block.bytes.data() + block.arrays[5].offset, 8 * sizeof(std::int32_t));
  EXPECT_THAT(kinds, ElementsAre(1, 1, 4, 4, 4, 4, 1, 1));
}

}  // namespace
}  // namespace anticrack::meshes
