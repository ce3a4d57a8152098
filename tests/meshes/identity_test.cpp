// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/identity.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "support/paper_geometry.hpp"

namespace anticrack::meshes {
namespace {

using records::GeometrySource;
using records::UploadRef;

GeometrySource paper(mesh::Preset preset = mesh::Preset::paper, double size = 0) {
  return {anticrack::testing::paper_geometry(), {preset, size}};
}

TEST(Identity, IsEqualForEqualDefinitions) {
  EXPECT_EQ(identity(paper()).size(), 64U);
  EXPECT_EQ(identity(paper()), identity(paper()));
  EXPECT_EQ(identity(UploadRef{"ab"}), identity(UploadRef{"ab"}));
  GeometrySource negative_zero = paper();
  negative_zero.geometry.interfaces[0].points[0][1] = -0.0;
  EXPECT_EQ(identity(negative_zero), identity(paper()));
  // without effect on these presets
  EXPECT_EQ(identity(paper(mesh::Preset::paper, 0.5)), identity(paper()));
  GeometrySource tip_size = paper(mesh::Preset::uniform, 0.1);
  tip_size.options.tip_size = 1e-3;
  EXPECT_EQ(identity(tip_size), identity(paper(mesh::Preset::uniform, 0.1)));
}

TEST(Identity, IsThatOfTheWholeDefinition) {
  std::set<std::string> seen = {
      identity(paper()), identity(UploadRef{"ab"}), identity(UploadRef{"ac"}),
      identity(paper(mesh::Preset::uniform, 0.5)), identity(paper(mesh::Preset::uniform, 0.25))};
  ASSERT_EQ(seen.size(), 5U);
  const std::vector<std::function<void(mesh::Geometry&)>> changes = {
      [](mesh::Geometry& g) { g.boundary[2][0] = 1.5; },
      [](mesh::Geometry& g) {
        g.boundary.push_back({-1, 0.5});
      },
      [](mesh::Geometry& g) {
        auto& points = g.interfaces[0].points;
        std::swap(points[0], points[1]);
      },
      // the same points, another division between the lists
      [](mesh::Geometry& g) {
        auto& points = g.interfaces[0].points;
        points.insert(points.begin(), g.boundary.back());
        g.boundary.pop_back();
      },
      [](mesh::Geometry& g) { g.interfaces[0].name = "sigma"; },
      [](mesh::Geometry& g) { g.interfaces[0].shape = mesh::Shape::spline; },
      [](mesh::Geometry& g) { g.interfaces[0].closed = true; },
      [](mesh::Geometry& g) { g.interfaces.push_back(g.interfaces[0]); },
      [](mesh::Geometry& g) {
        g.neumann = {{{-1, -1}, {1, -1}}};
      },
      [](mesh::Geometry& g) {
        g.regions = {{"stiff", {0, 0.5}, 1}};
      },
      [](mesh::Geometry& g) {
        g.regions = {{"stiff", {0, 0.5}, 2}};
      },
      [](mesh::Geometry& g) {
        g.regions = {{"stiff", {0, -0.5}, 2}};
      },
      [](mesh::Geometry& g) { g.inclusions[0].name = "other"; },
      [](mesh::Geometry& g) {
        g.inclusions[0].part.to = {0.4, 0};
      },
      [](mesh::Geometry& g) { g.inclusions[0].delaminated.clear(); },
      [](mesh::Geometry& g) { g.inclusions.clear(); },
      [](mesh::Geometry& g) {
        g.cracks = {{"crack", {{0.6, 0}, {0.8, 0}}}};
      },
      [](mesh::Geometry& g) {
        g.cracks = {{"crack", {{0.6, 0}, {0.8, 0}}, false}};
      },
      [](mesh::Geometry& g) { g.inclusions[0].motion.tilt = true; },
      [](mesh::Geometry& g) { g.inclusions[0].motion.fixed = 0; },
      [](mesh::Geometry& g) { g.inclusions[0].motion.fixed = 1; },
      [](mesh::Geometry& g) { g.inclusions[0].delaminated_side = mesh::LineSide::left; },
      [](mesh::Geometry& g) { g.inclusions[0].delaminated_side = mesh::LineSide::right; },
      [](mesh::Geometry& g) {
        g.inclusions[0].stretches = {{0, 1}};
      },
      [](mesh::Geometry& g) { g.inclusions[0].line.emplace(); },
      [](mesh::Geometry& g) {
        g.inclusions[0].line = {{mesh::Shape::segment, {{0, 0}}, 0, 1}};
      },
      [](mesh::Geometry& g) {
        g.inclusions[0].line = {{mesh::Shape::segment, {{0, 0}}, 1, 0}};
      },
      [](mesh::Geometry& g) {
        g.regions = {{"stiff", {}, 1, mesh::OutlineSpec{}}};
      },
      [](mesh::Geometry& g) { g.sides.emplace_back(); },
      [](mesh::Geometry& g) { g.holes.emplace_back(); },
      [](mesh::Geometry& g) { g.neumann_sides = {"side-1"}; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    GeometrySource source = paper();
    changes[i](source.geometry);
    EXPECT_TRUE(seen.insert(identity(source)).second) << i;
  }
}

TEST(Identity, CountsEveryOptionOfAGeometryAndOfAnUpload) {
  const std::vector<std::function<void(mesh::MeshOptions&)>> changes = {
      [](mesh::MeshOptions&) {},
      [](mesh::MeshOptions& o) { o.preset = mesh::Preset::uniform; },
      [](mesh::MeshOptions& o) { o.size = 0.1; },
      [](mesh::MeshOptions& o) { o.tip_size = 0.1; },
      [](mesh::MeshOptions& o) { o.grading = 0.1; },
      [](mesh::MeshOptions& o) {
        o.align = {{{0, 0}, {1, 1}}};
      },
      [](mesh::MeshOptions& o) {
        o.align = {{{0, 0}}, {{1, 1}}};
      },
      [](mesh::MeshOptions& o) {
        o.curve_groups = {{1, "crack"}};
      },
      [](mesh::MeshOptions& o) {
        o.surface_groups = {{1, "crack"}};
      },
      [](mesh::MeshOptions& o) {
        o.surface_groups = {{-1, "crack"}};
      },
      [](mesh::MeshOptions& o) {
        o.tension = {{"crack", 1}};
      },
      [](mesh::MeshOptions& o) {
        o.tension = {{"crack", 2}};
      },
      [](mesh::MeshOptions& o) {
        o.inclusion_motions = {{"a", {true, {}}}};
      },
      [](mesh::MeshOptions& o) {
        o.inclusion_motions = {{"a", {false, 1}}};
      },
      [](mesh::MeshOptions& o) {
        o.inclusion_motions = {{"b", {false, 1}}};
      },
      [](mesh::MeshOptions& o) {
        o.tension_laws = {{"b", {"1", "", 0}}};
      },
      [](mesh::MeshOptions& o) {
        o.tension_laws = {{"b", {"1", "", 30}}};
      }};
  std::set<std::string> seen;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    GeometrySource source = paper(mesh::Preset::graded);
    changes[i](source.options);
    EXPECT_TRUE(seen.insert(identity(source)).second) << i;
    EXPECT_TRUE(seen.insert(identity(UploadRef{"ab", source.options})).second) << i;
  }
}

TEST(Identity, IsTheSameOnEveryMachine) {
  GeometrySource source = paper();
  source.geometry.cracks = {{"crack", {{0.6, 0}, {0.8, 0}}}};
  EXPECT_EQ(identity(source).substr(0, 16), "29142922090a5e84");
  EXPECT_EQ(identity(UploadRef{"ab", {mesh::Preset::uniform}}).substr(0, 16), "3be790fdbcc4f98d");
}

TEST(Identity, TellsOwnersApart) {
  EXPECT_EQ(identity(paper(), ""), identity(paper()));
  EXPECT_EQ(identity(paper(), "ann"), identity(paper(), "ann"));
  EXPECT_NE(identity(paper(), "ann"), identity(paper()));
  EXPECT_NE(identity(paper(), "ann"), identity(paper(), "bob"));
  EXPECT_NE(identity(paper(), "ann"), identity(UploadRef{"ab"}, "ann"));
}

}  // namespace
}  // namespace anticrack::meshes
