// SPDX-License-Identifier: GPL-3.0-or-later
//
// Meshes of geometries, made by the real helper.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <thread>

#include "mesh/codec.hpp"
#include "mesh/quality.hpp"
#include "mesh/refine.hpp"
#include "mesher/real_helper.hpp"
#include "support/errors.hpp"
#include "support/paper_geometry.hpp"

namespace anticrack {
namespace {

using mesh::Geometry;
using mesh::Kind;
using mesh::Mesh;
using mesh::MeshOptions;
using mesh::Point;
using testing::paper_geometry;
using testing::paper_options;

constexpr std::size_t enough = 1'000'000;

Mesh make(const Geometry& geometry, const MeshOptions& options = paper_options()) {
  return mesher::run(testing::real_helper(),
                     mesh::GenerateRequest{mesh::plan(geometry, options, enough), enough}, {});
}

Point point(const Mesh& mesh, std::int32_t node) {
  const auto i = 2 * static_cast<std::size_t>(node);
  return {mesh.xy[i], mesh.xy[i + 1]};
}

double area(const Mesh& mesh, std::int32_t subdomain) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.subdomain[t] == subdomain) sum += mesh::area(mesh, t);
  }
  return sum;
}

TEST(Generate, PaperPresetHasTheSizeOfThePapersMesh) {
  const Mesh mesh = make(paper_geometry());
  // 5674 and 5700 triangles, 2958 and 2971 nodes in the paper
  const std::size_t triangles_made[] = {5696, 5694};
  const std::size_t nodes_made[] = {2969, 2968};
  for (std::int32_t s = 0; s < 2; ++s) {
    std::size_t triangles = 0;
    std::set<std::int32_t> nodes;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      if (mesh.subdomain[t] != s) continue;
      ++triangles;
      nodes.insert(&mesh.triangles[3 * t], &mesh.triangles[3 * t] + 3);
    }
    EXPECT_EQ(triangles, triangles_made[s]);
    EXPECT_EQ(nodes.size(), nodes_made[s]);
    // Euler's formula with 240 edges on the boundary of the subdomain
    EXPECT_EQ(triangles, 2 * nodes.size() - 2 - 240);
    EXPECT_NEAR(area(mesh, s), 2, 1e-12);
  }
  EXPECT_GT(mesh::minimum_angle(mesh), 20);
  EXPECT_EQ(mesh.dirichlet.size(), 160U);
  EXPECT_EQ(mesh.subdomains, (std::vector<std::string>{"omega1", "omega2"}));
  EXPECT_EQ(mesh.inclusions, std::vector<std::string>{"inclusion"});
  EXPECT_EQ(mesh.tension, (std::vector<double>{1, 1}));
  EXPECT_TRUE(mesh.warnings.empty());
  EXPECT_EQ(mesh.bisection_bound, 0);
}

TEST(Generate, InterfaceNodesOfThePaperLieExactly) {
  const Mesh mesh = make(paper_geometry());
  ASSERT_EQ(mesh.interfaces.size(), 1U);
  const mesh::Interface& interface = mesh.interfaces[0];
  EXPECT_EQ(interface.name, "interface");
  ASSERT_EQ(interface.nodes.size(), 161U);
  for (std::size_t i = 0; i < 161; ++i) {
    const Point p = point(mesh, interface.nodes[i]);
    EXPECT_NEAR(p[0], -1 + static_cast<double>(i) / 80, 2e-16);
    EXPECT_EQ(p[1], 0.0);
  }
  for (std::size_t i = 0; i < 160; ++i) {
    const bool on_inclusion = i >= 40 && i < 120;
    EXPECT_EQ(interface.kind[i], on_inclusion ? Kind::delaminated : Kind::glue);
    EXPECT_EQ(interface.inclusion[i], on_inclusion ? 0 : -1);
  }
  // the plus side lies above
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    double y = 0;
    for (std::size_t k = 0; k < 3; ++k) y += point(mesh, mesh.triangles[3 * t + k])[1];
    ASSERT_EQ(mesh.subdomain[t], y > 0 ? 1 : 0);
  }
}

TEST(Generate, UniformPresetHasElementsOfItsSize) {
  const Mesh mesh = make(paper_geometry(), {mesh::Preset::uniform, 0.05});
  EXPECT_NEAR(static_cast<double>(mesh.triangle_count()), 4 / (std::sqrt(3.0) / 4 * 0.05 * 0.05),
              0.1 * 3695);
  EXPECT_GT(mesh::minimum_angle(mesh), 25);
}

/// By halving a coarse mesh: as many triangles, of no worse shape, and the interface where it was.
TEST(Generate, AFineMeshIsLikeACoarseOne) {
  const Mesh coarse = make(paper_geometry(), {mesh::Preset::uniform, 0.016});
  const Mesh fine = make(paper_geometry(), {mesh::Preset::uniform, 0.008});
  EXPECT_NEAR(static_cast<double>(fine.triangle_count()), 4 / (std::sqrt(3.0) / 4 * 0.008 * 0.008),
              0.1 * 144'000);
  EXPECT_GT(mesh::minimum_angle(fine), 0.95 * mesh::minimum_angle(coarse));
  EXPECT_LT(mesh::longest_edge(fine), 0.55 * mesh::longest_edge(coarse));
  ASSERT_EQ(fine.interfaces.size(), 1U);
  for (const auto node : fine.interfaces[0].nodes) EXPECT_EQ(point(fine, node)[1], 0);
  EXPECT_NEAR(area(fine, 0), 2, 1e-11);
  EXPECT_NEAR(area(fine, 1), 2, 1e-11);
}

/// A fine mesh of a disc with an arc in it, halved from a coarse one: as many triangles as asked
/// for, of good shape, and no node of the boundary or the arc on a chord.
TEST(Generate, AFineMeshOfCurvesLiesOnThem) {
  Geometry geometry;
  geometry.sides = {{"", {mesh::Shape::arc, {{1, 0}, {0, 1}, {-1, 0}}}},
                    {"", {mesh::Shape::arc, {{-1, 0}, {0, -1}, {1, 0}}}}};
  geometry.cracks = {
      {"c", {}, true, mesh::LineSpec{mesh::Shape::arc, {{0, -0.5}, {0.5, 0}, {0, 0.5}}}}};
  constexpr double size = 0.006;
  const Mesh mesh = make(geometry, {mesh::Preset::uniform, size});
  const double expected = std::numbers::pi / (std::sqrt(3.0) / 4 * size * size);
  EXPECT_NEAR(static_cast<double>(mesh.triangle_count()), expected, 0.08 * expected);
  EXPECT_GT(mesh::minimum_angle(mesh), 15) << "at the tips, where chords are shorter";
  EXPECT_LT(mesh::longest_edge(mesh), 1.5 * size);
  EXPECT_EQ(mesh.dirichlet.size(), mesh.dirichlet.size() / 8 * 8) << "halved twice, of two sides";
  const auto radius = [&](std::int32_t node) {
    const auto [x, y] = point(mesh, node);
    return std::hypot(x, y);
  };
  for (const auto& edge : mesh.dirichlet) EXPECT_NEAR(radius(edge[0]), 1, 1e-15);
  ASSERT_EQ(mesh.interfaces.size(), 1U);
  for (const auto node : mesh.interfaces[0].nodes) EXPECT_NEAR(radius(node), 0.5, 1e-15);
  EXPECT_EQ(mesh::encode(make(geometry, {mesh::Preset::uniform, size})), mesh::encode(mesh));
}

/// Edges on circles about 0 with the radii 1 and 0.5 know how far these lie to the left of them.
void expect_chords(const Mesh& mesh) {
  for (const mesh::ChordEdge& edge : mesh.chords) {
    const mesh::Point a = point(mesh, edge.a), b = point(mesh, edge.b);
    const mesh::Point middle{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
    const double radius = std::hypot(middle[0], middle[1]) > 0.75 ? 1 : 0.5,
                 height = edge.chord * edge.chord / (8 * radius),
                 left = a[0] * b[1] - a[1] * b[0] > 0 ? -1 : 1;
    for (const auto& [p, off] :
         {std::pair(a, edge.at_a), std::pair(middle, edge.at_middle), std::pair(b, edge.at_b)})
      EXPECT_NEAR(off, left * (radius - std::hypot(p[0], p[1])), 2e-3 * height + 1e-15);
    EXPECT_LE(std::abs(edge.at_middle), 1.001 * height);
  }
}

TEST(Generate, EdgesOnChordsKnowTheirCurve) {
  Geometry geometry;
  geometry.sides = {{"", {mesh::Shape::arc, {{1, 0}, {0, 1}, {-1, 0}}}},
                    {"", {mesh::Shape::arc, {{-1, 0}, {0, -1}, {1, 0}}}}};
  geometry.cracks = {
      {"c", {}, true, mesh::LineSpec{mesh::Shape::arc, {{0, -0.5}, {0.5, 0}, {0, 0.5}}}}};
  for (const double size : {0.3, 0.02, 0.006}) {
    const Mesh mesh = make(geometry, {mesh::Preset::uniform, size});
    EXPECT_EQ(mesh.chords.size(), mesh.dirichlet.size() + mesh.interfaces[0].kind.size()) << size;
    expect_chords(mesh);
    const Mesh fine =
        mesh::refine(mesh, std::vector<std::uint8_t>(mesh.triangle_count(), 3), 10'000'000);
    EXPECT_EQ(fine.chords.size(), fine.dirichlet.size() + fine.interfaces[0].kind.size());
    expect_chords(fine);
  }
}

/// Walks all parts of the boundary with the membrane on the left and expects of the middle of each
/// edge that it lies on the part of that name, and that the parts are all of it.
void expect_parts(const Mesh& mesh,
                  const std::map<std::string, std::function<bool(double, double)>>& lies_on) {
  std::map<std::int32_t, std::int32_t> next;
  for (const auto& [a, b] : mesh.dirichlet) next[a] = b;
  std::size_t walked = 0;
  ASSERT_EQ(mesh.boundary_parts.size(), lies_on.size());
  for (const mesh::BoundaryPart& part : mesh.boundary_parts) {
    std::int32_t node = part.first;
    do {
      const Point a = point(mesh, node), b = point(mesh, node = next.at(node));
      EXPECT_TRUE(lies_on.at(part.name)((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)) << part.name;
      ASSERT_LE(++walked, mesh.dirichlet.size());
    } while (node != part.last);
  }
  EXPECT_EQ(walked, mesh.dirichlet.size());
}

TEST(Generate, PartsOfTheBoundaryKeepTheirNames) {
  Geometry square = paper_geometry();
  square.holes = {{"", {mesh::Shape::circle, {{0.5, 0.5}}, 0.2}},
                  {"slot", {mesh::Shape::polyline, {{-0.6, -0.6}, {-0.4, -0.6}, {-0.5, -0.3}}}}};
  const auto round = [](double x, double y) { return std::hypot(x - 0.5, y - 0.5) < 0.21; };
  const auto slot = [](double x, double y) { return x < -0.39 && x > -0.61 && y > -0.61 && y < 0; };
  const auto low = [](double, double y) { return y == -1; };
  const auto high = [](double, double y) { return y == 1; };
  const auto left = [](double x, double) { return x == -1; };
  const auto right = [](double x, double) { return x == 1; };
  Geometry turned = square;
  std::ranges::reverse(turned.boundary);  // begins at (-1, 1)
  for (const MeshOptions& options : {MeshOptions{}, MeshOptions{mesh::Preset::uniform, 0.02}}) {
    const Mesh mesh = make(square, options);
    expect_parts(mesh, {{"side-1", low},
                        {"side-2", right},
                        {"side-3", high},
                        {"side-4", left},
                        {"hole-1", round},
                        {"slot", slot}});
    expect_parts(mesh::decode_mesh(mesh::encode(mesh)), {{"side-1", low},
                                                         {"side-2", right},
                                                         {"side-3", high},
                                                         {"side-4", left},
                                                         {"hole-1", round},
                                                         {"slot", slot}});
    expect_parts(mesh::refine(mesh, std::vector<std::uint8_t>(mesh.triangle_count(), 3), enough),
                 {{"side-1", low},
                  {"side-2", right},
                  {"side-3", high},
                  {"side-4", left},
                  {"hole-1", round},
                  {"slot", slot}});
    expect_parts(make(turned, options), {{"side-1", high},
                                         {"side-2", right},
                                         {"side-3", low},
                                         {"side-4", left},
                                         {"hole-1", round},
                                         {"slot", slot}});
  }
  Geometry disc;
  disc.sides = {
      {"under", {mesh::Shape::arc, {{1, 0}, {0, -1}, {-1, 0}}}},
      {"", {mesh::Shape::arc, {{-1, 0}, {-0.7071067811865476, 0.7071067811865476}, {0, 1}}}},
      {"end", {mesh::Shape::arc, {{0, 1}, {0.7071067811865476, 0.7071067811865476}, {1, 0}}}}};
  disc.cracks = {{"c", {}, true, mesh::LineSpec{mesh::Shape::polyline, {{-0.5, 0}, {0.5, 0}}}}};
  expect_parts(make(disc, {}), {{"under", [](double, double y) { return y < 0; }},
                                {"side-2", [](double x, double y) { return y > 0 && x < 0; }},
                                {"end", [](double x, double y) { return y > 0 && x > 0; }}});
}

/// An edge crack and a fibre that begins at the edge, where u is held.
TEST(Generate, PartsMayReachTheHeldBoundary) {
  Geometry geometry;
  geometry.boundary = {{0, -5}, {30, -5}, {30, 5}, {0, 5}};
  geometry.cracks = {{"c", {}, true, mesh::LineSpec{mesh::Shape::polyline, {{0, 0}, {5, 0}}}}};
  mesh::InclusionSpec fibre{"fibre", {}, {}};
  fibre.line = mesh::LineSpec{mesh::Shape::polyline, {{20, 0}, {30, 0}}};
  fibre.stretches = {{0, 0.5}};
  geometry.inclusions = {fibre};
  const Mesh mesh = make(geometry, {});
  EXPECT_NO_THROW(mesh::validate(mesh));
  std::set<Point> held;
  for (const auto& edge : mesh.dirichlet)
    for (const auto node : edge) held.insert(point(mesh, node));
  EXPECT_TRUE(held.contains(Point{0, 0}));
  EXPECT_TRUE(held.contains(Point{30, 0}));
  // the mouth of the crack is no tip, its end is one, and so is where the fibre comes off
  std::set<Point> tips;
  for (const auto node : mesh::tips(mesh)) tips.insert(point(mesh, node));
  EXPECT_FALSE(tips.contains(Point{0, 0}));
  EXPECT_TRUE(tips.contains(Point{5, 0}));
  EXPECT_TRUE(tips.contains(Point{20, 0}));
}

/// Map coordinates: a mesh far from the origin is that at the origin, moved.
TEST(Generate, FarFromTheOriginIsTheSameMesh) {
  constexpr Point corner{441'870.603, 6'329'699.7};
  const auto slit_in = [](const Point& at, double extent) {
    Geometry geometry;
    const auto p = [&](double x, double y) {
      return Point{at[0] + x * extent, at[1] + y * extent};
    };
    geometry.boundary = {p(0, 0), p(1, 0), p(1, 1), p(0, 1)};
    geometry.interfaces = {{"cut", mesh::Shape::polyline, {p(0, 0.25), p(0.5, 0.5), p(1, 0.5)}}};
    geometry.cracks = {{"slit", {p(0.25, 0.375), p(0.75, 0.5)}}};
    return geometry;
  };
  const MeshOptions uniform{mesh::Preset::uniform};
  for (const double extent : {2000.0, 2.0, 0.1}) {
    const Mesh near = make(slit_in({0, 0}, extent), uniform);
    const Mesh far = make(slit_in(corner, extent), uniform);
    EXPECT_NEAR(static_cast<double>(far.triangle_count()),
                static_cast<double>(near.triangle_count()), 0.1 * 6000);
    EXPECT_NEAR(area(far, 0) + area(far, 1), extent * extent, 1e-6 * extent * extent);
    EXPECT_GT(mesh::minimum_angle(far), 30);
    const auto length = [](const Mesh& mesh) {
      double sum = 0;
      for (const auto& interface : mesh.interfaces) sum += mesh::arc_length(mesh, interface).back();
      return sum;
    };
    EXPECT_NEAR(length(far), length(near), 1e-6 * extent);
  }
  EXPECT_TRUE(testing::throws([&] { make(slit_in(corner, 0.01), uniform); },
                              errors::Reason::geometry_invalid));
}

TEST(Generate, UnitOfLengthDoesNotMatter) {
  Geometry geometry = paper_geometry();
  const auto scale = [](Point& p) {
    for (double& value : p) value *= 1e-7;
  };
  for (Point& p : geometry.boundary) scale(p);
  for (Point& p : geometry.interfaces[0].points) scale(p);
  auto& inclusion = geometry.inclusions[0];
  scale(inclusion.part.from);
  scale(inclusion.part.to);
  inclusion.delaminated = {inclusion.part};
  const Mesh mesh = make(geometry);
  EXPECT_NEAR(static_cast<double>(mesh.triangle_count()), 11'400, 200);
  EXPECT_NEAR(area(mesh, 1), 2e-14, 1e-24);
}

TEST(Generate, BentInterfaceInAClockwisePolygon) {
  Geometry geometry;
  geometry.boundary = {{0, 0}, {0, 2}, {1, 3}, {3, 2}, {4, 0}, {2, 0.5}};
  geometry.interfaces = {{"interface", mesh::Shape::polyline, {{0, 1}, {1, 1.5}, {2, 1}, {4, 0}}}};
  geometry.inclusions = {{"a", {{0.5, 1.25}, {1.5, 1.25}}, {{{0.5, 1.25}, {0.75, 1.375}}}}};
  geometry.cracks = {{"c", {{2.5, 0.75}, {3, 0.5}}}, {"d", {{3.25, 0.375}, {3.5, 0.25}}, false}};
  geometry.inclusions[0].motion.tilt = true;
  const Mesh mesh = make(geometry);
  const auto& kinds = mesh.interfaces[0].kind;
  EXPECT_EQ(
      std::set<Kind>(kinds.begin(), kinds.end()),
      (std::set<Kind>{Kind::glue, Kind::crack, Kind::inclusion, Kind::delaminated, Kind::free}));
  EXPECT_EQ(mesh.motions, (std::vector<mesh::Motion>{{true, {}}}));
  EXPECT_EQ(kinds.size(), 160U);
  EXPECT_GT(mesh::minimum_angle(mesh), 10);
  // every node of the interface lies on one of its three edges
  for (const auto node : mesh.interfaces[0].nodes) {
    const Point p = point(mesh, node);
    const double y = p[0] <= 1 ? 1 + p[0] / 2 : 2 - p[0] / 2;
    EXPECT_NEAR(p[1], y, 1e-14);
  }
}

TEST(Generate, EightAtOnceGiveTheSameMesh) {
  const mesh::Bytes expected = mesh::encode(make(paper_geometry()));
  std::vector<mesh::Bytes> made(8);
  {
    std::vector<std::jthread> threads;
    for (auto& bytes : made) {
      threads.emplace_back([&bytes] { bytes = mesh::encode(make(paper_geometry())); });
    }
  }
  for (const auto& bytes : made) EXPECT_EQ(bytes, expected);
}

TEST(Generate, MoreTrianglesThanAskedForAreRefused) {
  const auto plan = mesh::plan(paper_geometry(), paper_options(), enough);
  EXPECT_TRUE(testing::throws(
      [&] {
        mesher::run(testing::real_helper(), mesh::GenerateRequest{plan, 5000}, {});
      },
      errors::Reason::limit_exceeded));
}

}  // namespace
}  // namespace anticrack
