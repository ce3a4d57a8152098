// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/refine.hpp"
#include "mesh/refine_uniform.hpp"
#include "mesh/refinement_checks.hpp"
#include "mesh/refinement_mesh.hpp"
#include "support/mesh_quality.hpp"

namespace anticrack::mesh {
namespace {

using testing::expect_refines;
using testing::structured_mesh;

const std::vector<testing::OnInterface> parts{{-0.5, 0.5, Kind::inclusion, 0},
                                              {-0.25, 0, Kind::delaminated, 0}};

Mesh triangle(const Point& a, const Point& b, const Point& c) {
  Mesh made;
  made.xy = {a[0], a[1], b[0], b[1], c[0], c[1]};
  made.triangles = {0, 1, 2};
  made.subdomain = {0};
  made.subdomains = {"all"};
  return made;
}

TEST(RefineUniform, CutsEveryTriangleIntoFourSimilarOnes) {
  const Mesh base = structured_mesh(8, 4, parts, {-1, 2, -1, 1});
  const Mesh fine = refine_uniform(base);
  expect_refines(base, fine);
  EXPECT_EQ(fine.triangle_count(), 4 * base.triangle_count());
  EXPECT_EQ(fine.dirichlet.size(), 2 * base.dirichlet.size());
  EXPECT_EQ(fine.interfaces[0].kind.size(), 2 * base.interfaces[0].kind.size());
  const Quality before = quality(base);
  const Quality after = quality(fine);
  EXPECT_NEAR(after.minimum_angle, before.minimum_angle, 1e-12);
  EXPECT_NEAR(after.maximum_angle, before.maximum_angle, 1e-12);
  EXPECT_NEAR(after.largest_diameter, before.largest_diameter / 2, 1e-15);
  EXPECT_NEAR(after.smallest_diameter, before.smallest_diameter / 2, 1e-15);
}

TEST(RefineUniform, GoesOnFromAGradedMesh) {
  const Mesh base = grade(structured_mesh(8, 8, parts), {.h0 = 0.3, .tip_size = 1e-6}, 100'000);
  const Mesh fine = refine_uniform(refine_uniform(base));
  expect_refines(base, fine);
  EXPECT_EQ(fine.triangle_count(), 16 * base.triangle_count());
}

/// Two triangles whose common side is a chord of a quarter circle.
Mesh with_chord(const Point& inside) {
  Mesh made;
  made.xy = {1, 0, 0, 1, inside[0], inside[1], 2, 2};
  made.triangles = {0, 1, 2, 1, 0, 3};
  made.subdomain = {0, 0};
  made.subdomains = {"all"};
  made.dirichlet = {{1, 2}};
  made.bends = {
      {.a = {1, 0}, .b = {0, 1}, .centre = {}, .radius = 1, .sweep = std::numbers::pi / 2}};
  made.bent = {{1, 0, 0, 1, 0}};
  return made;
}

TEST(RefineUniform, PutsMiddlesOfChordsOnTheirBend) {
  Mesh mesh = with_chord({0, 0});
  for (std::size_t chords = 1; chords <= 16; chords *= 2) {
    ASSERT_EQ(mesh.bent.size(), chords);
    for (const BentEdge& edge : mesh.bent) {
      for (const auto& [node, u] : {std::pair(edge.a, edge.from), std::pair(edge.b, edge.to)}) {
        const auto [x, y] = position(mesh, node);
        EXPECT_NEAR(x, std::cos(u * std::numbers::pi / 2), 1e-15);
        EXPECT_NEAR(y, std::sin(u * std::numbers::pi / 2), 1e-15);
      }
      EXPECT_EQ(edge.from - edge.to, 1.0 / static_cast<double>(chords)) << "from b to a";
    }
    mesh = refine_uniform(mesh);
    ASSERT_NO_THROW(validate(mesh));
  }
}

/// The middle of the chord would pass beyond the corner behind it.
TEST(RefineUniform, LeavesAChordWhereItsBendSpoilsATriangle) {
  Mesh mesh = with_chord({0, 0});
  mesh.xy[6] = mesh.xy[7] = 0.75;
  const Mesh fine = refine_uniform(mesh);
  ASSERT_NO_THROW(validate(fine));
  ASSERT_EQ(fine.bent.size(), 2U);
  for (const BentEdge& half : fine.bent)
    EXPECT_NEAR(half.chord, std::numbers::sqrt2, 1e-15) << "a part of it";
  EXPECT_EQ(refine_uniform(fine).bent.size(), 4U);
  EXPECT_EQ(fine.bends, mesh.bends);
  EXPECT_NEAR(quality(fine).minimum_angle, quality(mesh).minimum_angle, 1e-12);
}

TEST(BisectionBound, IsTheSmallestAngleThatDeepBisectionReaches) {
  const Mesh bases[] = {triangle({0, 0}, {1, 0}, {0.5, 0.5 * std::numbers::sqrt3}),
                        triangle({0, 0}, {1, 0}, {0, 1}), triangle({0, 0}, {3, 0}, {1, 0.7}),
                        triangle({0, 0}, {1, 0}, {0.95, 0.9})};
  for (const Mesh& base : bases) {
    const Mesh fine = grade(base, {.h0 = 0.05}, 100'000);
    ASSERT_GT(fine.triangle_count(), 300U);
    EXPECT_NEAR(quality(fine).minimum_angle, bisection_bound(base), 1e-9);
  }
  EXPECT_NEAR(bisection_bound(bases[0]), 30, 1e-12);
  EXPECT_NEAR(bisection_bound(bases[1]), 45, 1e-12);
}

TEST(Quality, OfAKnownTriangle) {
  const Quality found = quality(triangle({0, 0}, {4, 0}, {0, 3}));
  EXPECT_NEAR(found.minimum_angle, std::atan2(3, 4) * 180 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(found.maximum_angle, 90, 1e-12);
  EXPECT_EQ(found.smallest_diameter, 5);
  EXPECT_EQ(found.largest_diameter, 5);
  EXPECT_EQ(found.shortest_edge, 3);
}

TEST(CharacteristicLength, IsHalfTheSideOfASquareHoweverItIsCut) {
  EXPECT_NEAR(characteristic_length(structured_mesh(6, 4, parts)), 1, 1e-14);
  EXPECT_NEAR(characteristic_length(structured_mesh(6, 4, parts, {0, 8, 0, 2})), 2, 1e-14);
}

}  // namespace
}  // namespace anticrack::mesh
