// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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
