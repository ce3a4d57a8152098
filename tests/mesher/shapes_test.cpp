// SPDX-License-Identifier: GPL-3.0-or-later
//
// Geometries of every form, planned and meshed by the real helper, which validates what it gives.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "mesh/edges.hpp"
#include "mesh/quality.hpp"
#include "mesh/refine.hpp"
#include "mesher/real_helper.hpp"

namespace anticrack {
namespace {

using mesh::Geometry;
using mesh::Kind;
using mesh::Mesh;
using mesh::MeshOptions;
using mesh::Part;
using mesh::Point;
using mesh::Preset;
using mesh::Shape;
using ::testing::UnorderedElementsAre;

constexpr std::size_t shape_triangles = 1'000'000;

Mesh make_shape(const Geometry& geometry, const MeshOptions& options) {
  return mesher::run(
      testing::real_helper(),
      mesh::GenerateRequest{mesh::plan(geometry, options, shape_triangles), shape_triangles}, {});
}

MeshOptions uniform(double size) { return {Preset::uniform, size}; }

Geometry square_shape() {
  Geometry geometry;
  geometry.boundary = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  return geometry;
}

mesh::InterfaceSpec line(const std::string& name, std::vector<Point> points, bool closed = false) {
  return {name, Shape::polyline, std::move(points), closed};
}

double distance(const Mesh& mesh, std::int32_t a, std::int32_t b) {
  const auto i = 2 * static_cast<std::size_t>(a);
  const auto j = 2 * static_cast<std::size_t>(b);
  return std::hypot(mesh.xy[j] - mesh.xy[i], mesh.xy[j + 1] - mesh.xy[i + 1]);
}

std::map<Kind, double> lengths(const Mesh& mesh) {
  std::map<Kind, double> sums;
  for (const mesh::Interface& interface : mesh.interfaces) {
    for (std::size_t i = 0; i < interface.kind.size(); ++i) {
      sums[interface.kind[i]] += distance(mesh, interface.nodes[i], interface.nodes[i + 1]);
    }
  }
  return sums;
}

double length(const Mesh& mesh, Kind kind) { return lengths(mesh)[kind]; }

std::map<std::string, double> areas(const Mesh& mesh) {
  std::map<std::string, double> sums;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    sums[mesh.subdomains[static_cast<std::size_t>(mesh.subdomain[t])]] += mesh::area(mesh, t);
  }
  return sums;
}

double whole_area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [name, area] : areas(mesh)) sum += area;
  return sum;
}

double dirichlet_length(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b] : mesh.dirichlet) sum += distance(mesh, a, b);
  return sum;
}

std::vector<Point> tip_points(const Mesh& mesh) {
  const std::vector<std::int32_t> tips = mesh::tips(mesh);
  std::vector<Point> found;
  found.reserve(tips.size());
  for (const std::int32_t node : tips) {
    const auto i = 2 * static_cast<std::size_t>(node);
    found.push_back({mesh.xy[i], mesh.xy[i + 1]});
  }
  return found;
}

/// What must hold of every graded mesh: the size is reached at every tip, no angle is below the
/// bound, and equal input gives equal bits.
void expect_graded(const Geometry& geometry, std::size_t tip_count) {
  const Mesh mesh = make_shape(geometry, {});
  const std::vector<std::int32_t> tips = mesh::tips(mesh);
  EXPECT_EQ(tips.size(), tip_count);
  EXPECT_GT(mesh.bisection_bound, 0);
  EXPECT_GE(mesh::minimum_angle(mesh), 0.95 * mesh.bisection_bound);
  for (const std::int32_t tip : tips) {
    double smallest = 1;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = mesh.triangles[3 * t + i];
        const std::int32_t b = mesh.triangles[3 * t + (i + 1) % 3];
        if (a == tip || b == tip) smallest = std::min(smallest, distance(mesh, a, b));
      }
    }
    EXPECT_LE(smallest, 1.01e-13) << "tip " << tip;
  }
  EXPECT_EQ(mesh::encode(make_shape(geometry, {})), mesh::encode(mesh));
}

TEST(Shapes, SlitInOneSubdomain) {
  Geometry geometry = square_shape();
  geometry.interfaces = {line("slit", {{-0.5, 0}, {0, 0.1}, {0.5, 0}})};
  geometry.cracks = {{"crack", {{-0.5, 0}, {0.5, 0}}}};
  const Mesh mesh = make_shape(geometry, uniform(0.1));
  EXPECT_EQ(mesh.subdomains.size(), 1U);
  EXPECT_NEAR(whole_area(mesh), 4, 1e-12);
  EXPECT_NEAR(length(mesh, Kind::crack), 2 * std::hypot(0.5, 0.1), 1e-12);
  EXPECT_NEAR(dirichlet_length(mesh), 8, 1e-12);
  EXPECT_THAT(tip_points(mesh), UnorderedElementsAre(Point{-0.5, 0}, Point{0.5, 0}));
  expect_graded(geometry, 2);
}

TEST(Shapes, CrackFromTheNeumannSide) {
  Geometry geometry = square_shape();
  geometry.interfaces = {line("cut", {{1, 0}, {0.25, 0}})};
  geometry.cracks = {{"crack", {{1, 0}, {0.25, 0}}}};
  geometry.neumann = {{{1, -1}, {1, 1}}};
  const Mesh mesh = make_shape(geometry, uniform(0.1));
  EXPECT_NEAR(dirichlet_length(mesh), 6, 1e-12);
  EXPECT_THAT(tip_points(mesh), UnorderedElementsAre(Point{0.25, 0}));
  expect_graded(geometry, 1);
}

TEST(Shapes, RingThatIsPartlyDelaminated) {
  Geometry geometry = square_shape();
  geometry.interfaces = {line("ring", {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}, true)};
  geometry.inclusions = {{"rim", {{-0.25, -0.5}, {0.5, 0.25}}, {{{0, -0.5}, {0.25, -0.5}}}}};
  geometry.regions = {{"core", {0, 0}, 2.5}};
  const Mesh mesh = make_shape(geometry, uniform(0.1));
  ASSERT_EQ(mesh.subdomains.size(), 2U);
  EXPECT_NEAR(areas(mesh)["core"], 1, 1e-12);
  EXPECT_NEAR(whole_area(mesh), 4, 1e-12);
  const bool core_first = mesh.subdomains[0] == "core";
  EXPECT_EQ(mesh.tension,
            core_first ? (std::vector<double>{2.5, 1}) : (std::vector<double>{1, 2.5}));
  ASSERT_EQ(mesh.interfaces.size(), 1U);
  EXPECT_EQ(mesh.interfaces[0].nodes.front(), mesh.interfaces[0].nodes.back());
  EXPECT_NEAR(length(mesh, Kind::delaminated), 0.25, 1e-12);
  EXPECT_NEAR(length(mesh, Kind::inclusion), 1.25, 1e-12);
  EXPECT_NEAR(length(mesh, Kind::glue), 2.5, 1e-12);
  expect_graded(geometry, 4);
}

TEST(Shapes, ThreeSubdomainsAtACrossPoint) {
  Geometry geometry = square_shape();
  geometry.interfaces = {line("across", {{-1, 0}, {1, 0}}), line("up", {{0.25, 0}, {0.25, 1}})};
  geometry.cracks = {{"crack", {{-0.5, 0}, {-0.25, 0}}}};
  geometry.regions = {{"low", {0, -0.5}}, {"left", {-0.5, 0.5}}, {"right", {0.5, 0.5}}};
  const Mesh mesh = make_shape(geometry, uniform(0.1));
  EXPECT_THAT(mesh.subdomains, UnorderedElementsAre("low", "left", "right"));
  EXPECT_NEAR(areas(mesh)["low"], 2, 1e-12);
  EXPECT_NEAR(areas(mesh)["left"], 1.25, 1e-12);
  EXPECT_NEAR(areas(mesh)["right"], 0.75, 1e-12);
  EXPECT_NEAR(length(mesh, Kind::glue), 2.75, 1e-12);
  // glue alone meets in the cross point, so it is not a tip
  EXPECT_THAT(tip_points(mesh), UnorderedElementsAre(Point{-0.5, 0}, Point{-0.25, 0}));
  expect_graded(geometry, 2);
}

TEST(Shapes, CrossOfACrackAndAnInclusion) {
  Geometry geometry = square_shape();
  geometry.interfaces = {line("across", {{-1, 0}, {1, 0}}), line("up", {{0, -1}, {0, 1}})};
  geometry.inclusions = {{"rigid", {{0.25, 0}, {0.75, 0}}, {}}};
  geometry.cracks = {{"crack", {{0, -0.5}, {0, 0.5}}}};
  const Mesh mesh = make_shape(geometry, uniform(0.1));
  EXPECT_EQ(mesh.subdomains.size(), 4U);
  EXPECT_NEAR(whole_area(mesh), 4, 1e-12);
  EXPECT_NEAR(length(mesh, Kind::inclusion), 0.5, 1e-12);
  EXPECT_NEAR(length(mesh, Kind::crack), 1, 1e-12);
  EXPECT_NEAR(length(mesh, Kind::glue), 2.5, 1e-12);
  EXPECT_THAT(tip_points(mesh),
              UnorderedElementsAre(Point{0.25, 0}, Point{0.75, 0}, Point{0, -0.5}, Point{0, 0.5}));
  expect_graded(geometry, 4);
  geometry.regions = {{"stiff", {-0.5, 0.5}, 2}};  // now the field is singular where they cross
  expect_graded(geometry, 5);
}

TEST(Shapes, InclusionOnAnArc) {
  Geometry geometry = square_shape();
  geometry.interfaces = {{"arc", Shape::arc, {{-1, 0}, {0, 0.5}, {1, 0}}, false}};
  const auto on_arc = [](double angle) {
    return Point{1.25 * std::sin(angle), -0.75 + 1.25 * std::cos(angle)};
  };
  const Part part{on_arc(-0.3), on_arc(0.4)};
  geometry.inclusions = {{"bow", part, {part}}};
  const Mesh mesh = make_shape(geometry, uniform(0.02));
  EXPECT_EQ(mesh.subdomains.size(), 2U);
  EXPECT_NEAR(whole_area(mesh), 4, 1e-12);
  EXPECT_NEAR(length(mesh, Kind::delaminated), 1.25 * 0.7, 1e-3);
  for (const std::int32_t node : mesh.interfaces.at(0).nodes) {
    const auto i = 2 * static_cast<std::size_t>(node);
    EXPECT_NEAR(std::hypot(mesh.xy[i], mesh.xy[i + 1] + 0.75), 1.25, 1e-3);
  }
  expect_graded(geometry, 2);
}

TEST(Shapes, EdgesFollowAnAlignedLine) {
  Geometry geometry = square_shape();
  geometry.interfaces = {line("across", {{-1, 0}, {1, 0}})};
  MeshOptions options = uniform(0.1);
  options.align = {{{-0.75, 0.5}, {0.75, 0.625}}, {{-0.5, -1}, {-0.5, 1}}};
  const Mesh mesh = make_shape(geometry, options);
  EXPECT_EQ(mesh.subdomains.size(), 2U);
  EXPECT_EQ(mesh.interfaces.size(), 1U);
  EXPECT_EQ(mesh::tips(mesh).size(), 0U);
  EXPECT_NEAR(dirichlet_length(mesh), 8, 1e-12);
  double along_first = 0;
  double along_second = 0;
  mesh::EdgeTable(mesh.triangles).each([&](std::span<const mesh::EdgeUse> uses) {
    const auto i = 2 * static_cast<std::size_t>(uses[0].from);
    const auto j = 2 * static_cast<std::size_t>(uses[0].to);
    const auto off_first = [&](std::size_t k) {
      return std::abs(mesh.xy[k]) > 0.75 + 1e-12
                 ? 1
                 : std::abs(mesh.xy[k + 1] - 0.5625 - mesh.xy[k] / 12);
    };
    const double length = std::hypot(mesh.xy[j] - mesh.xy[i], mesh.xy[j + 1] - mesh.xy[i + 1]);
    if (std::max(off_first(i), off_first(j)) < 1e-12) along_first += length;
    if (mesh.xy[i] == -0.5 && mesh.xy[j] == -0.5) along_second += length;
  });
  EXPECT_NEAR(along_first, std::hypot(1.5, 0.125), 1e-12);
  EXPECT_NEAR(along_second, 2, 1e-12);
}

TEST(Shapes, PartlyDelaminatedInclusion) {
  Geometry geometry = square_shape();
  geometry.interfaces = {line("across", {{-1, 0}, {1, 0}})};
  geometry.inclusions = {{"rigid", {{-0.5, 0}, {0.5, 0}}, {{{-0.25, 0}, {0.125, 0}}}}};
  const Mesh mesh = make_shape(geometry, uniform(0.1));
  EXPECT_NEAR(length(mesh, Kind::delaminated), 0.375, 1e-12);
  EXPECT_NEAR(length(mesh, Kind::inclusion), 0.625, 1e-12);
  EXPECT_NEAR(length(mesh, Kind::glue), 1, 1e-12);
  expect_graded(geometry, 4);
}

TEST(Shapes, TwoInclusionsAHairApart) {
  Geometry geometry = square_shape();
  geometry.interfaces = {line("across", {{-1, 0}, {1, 0}})};
  const Part left{{-0.5, 0}, {0, 0}};
  const Part right{{1e-6, 0}, {0.5, 0}};
  geometry.inclusions = {{"left", left, {left}}, {"right", right, {right}}};
  const Mesh mesh = make_shape(geometry, uniform(0.1));
  EXPECT_NEAR(length(mesh, Kind::delaminated), 1 - 1e-6, 1e-12);
  EXPECT_NEAR(whole_area(mesh), 4, 1e-12);
  EXPECT_GT(mesh::minimum_angle(mesh), 10);
  expect_graded(geometry, 4);
}

TEST(Shapes, InclusionOfOneSegment) {
  Geometry geometry = square_shape();
  geometry.interfaces = {line("across", {{-1, 0}, {1, 0}})};
  const Part part{{-0.0625, 0}, {0.0625, 0}};
  geometry.inclusions = {{"short", part, {part}}};
  const Mesh mesh = make_shape(geometry, uniform(0.25));
  const auto& kinds = mesh.interfaces.at(0).kind;
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), Kind::delaminated), 1);
  expect_graded(geometry, 2);
}

TEST(Shapes, DefaultMeshOfThePapersSquareIsAsLargeAsThePapers) {
  Geometry geometry = square_shape();
  geometry.interfaces = {line("interface", {{-1, 0}, {1, 0}})};
  const Part part{{-0.5, 0}, {0.5, 0}};
  geometry.inclusions = {{"inclusion", part, {part}}};
  const std::size_t triangles = make_shape(geometry, {}).triangle_count();
  EXPECT_GE(triangles, 9'000U);
  EXPECT_LE(triangles, 12'000U);
  expect_graded(geometry, 2);
}

TEST(Shapes, HolesOfEveryForm) {
  Geometry geometry = square_shape();
  geometry.holes = {
      {"round", {Shape::circle, {{0.5, 0.5}}, 0.2}},
      {"tiny", {Shape::circle, {{-0.7, 0.7}}, 1e-3}},
      {"square", {Shape::polyline, {{-0.6, -0.6}, {-0.2, -0.6}, {-0.2, -0.2}, {-0.6, -0.2}}}},
      {"bean", {Shape::spline, {{0.3, -0.5}, {0.5, -0.6}, {0.7, -0.5}, {0.5, -0.4}}}}};
  geometry.cracks = {{"notch", {}, true, mesh::LineSpec{Shape::segment, {{-0.1, -0.4}}, 0, 0.2}}};
  geometry.neumann_sides = {"square", "side-3"};
  const Mesh mesh = make_shape(geometry, uniform(0.1));
  EXPECT_EQ(mesh.subdomains.size(), 1U);
  const double holes = 0.04 * std::numbers::pi + 0.16 + 0.054;
  EXPECT_NEAR(whole_area(mesh), 4 - holes, 5e-3);
  EXPECT_NEAR(dirichlet_length(mesh), 6 + 0.4 * std::numbers::pi + 0.93, 0.02);
  EXPECT_NEAR(length(mesh, Kind::crack), 0.2, 1e-12);
  EXPECT_THAT(tip_points(mesh), UnorderedElementsAre(Point{0, -0.4}));
  expect_graded(geometry, 1);
}

TEST(Shapes, SidesLinesOfTheirOwnAndARegion) {
  Geometry geometry;
  geometry.sides = {{"base", {Shape::polyline, {{-1, 0}, {1, 0}}}},
                    {"arch", {Shape::arc, {{1, 0}, {0, 1}, {-1, 0}}}}};
  mesh::InclusionSpec bar{"bar", {}, {}};
  bar.line = mesh::LineSpec{Shape::segment, {{0, 0.5}}, 30, 0.8};
  bar.stretches = {{0, 0.5}};
  bar.delaminated_side = mesh::LineSide::left;
  geometry.inclusions = {bar};
  geometry.regions = {{"disc", {}, 2, mesh::OutlineSpec{Shape::circle, {{0, 0.5}}, 0.2}}};
  const Mesh mesh = make_shape(geometry, uniform(0.05));
  EXPECT_NEAR(areas(mesh)["disc"], 0.04 * std::numbers::pi, 2e-3);
  EXPECT_NEAR(whole_area(mesh), std::numbers::pi / 2, 5e-3);
  EXPECT_NEAR(length(mesh, Kind::delaminated), 0.4, 1e-12);
  EXPECT_NEAR(length(mesh, Kind::inclusion), 0.4, 1e-12);
  // walked back, so that the side that comes off is its minus side
  const mesh::Interface& chain = mesh.interfaces.at(0);
  EXPECT_GT(mesh::position(mesh, chain.nodes.front())[0], 0.3);
  EXPECT_EQ(chain.kind.back(), Kind::delaminated);
  expect_graded(geometry, 5);
}

}  // namespace
}  // namespace anticrack
