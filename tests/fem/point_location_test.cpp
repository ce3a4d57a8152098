// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/point_location.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "support/exact_loads.hpp"

namespace anticrack::fem {
namespace {

constexpr double tolerance = 1e-9;

Triangulation crooked_triangles() {
  const anticrack::testing::PlaneMesh mesh = anticrack::testing::square_mesh(12, 0.2, 5);
  return {mesh.xy, mesh.triangles};
}

PlanePoint place(const Triangulation& part, const Location& location) {
  PlanePoint sum{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto node = static_cast<std::size_t>(
        part.triangles[3 * static_cast<std::size_t>(location.triangle) + i]);
    sum[0] += location.weight[i] * part.xy[2 * node];
    sum[1] += location.weight[i] * part.xy[2 * node + 1];
  }
  return sum;
}

TEST(Locate, FindsEveryPointInItsTriangle) {
  const unsigned seed = 3;
  std::cout << "seed " << seed << "\n";
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  const Triangulation part = crooked_triangles();
  std::vector<PlanePoint> points;
  for (int i = 0; i < 500; ++i) {
    points.push_back({anywhere(random), anywhere(random)});
  }
  const std::vector<Location> found = locate(part, PointSet(points), tolerance);
  ASSERT_EQ(found.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_GE(found[i].triangle, 0) << i;
    EXPECT_GE(found[i].depth, 0);
    const PlanePoint at = place(part, found[i]);
    EXPECT_NEAR(std::hypot(at[0] - points[i][0], at[1] - points[i][1]), 0, 1e-14);
  }
}

TEST(Locate, TakesNodesAndWhatIsOutsideByATrifle) {
  const Triangulation part = crooked_triangles();
  const std::vector<PlanePoint> points{
      {-1, -1}, {part.xy[60], part.xy[61]}, {1 + 1e-10, 0.3}, {1 + 1e-8, 0.3}, {5, 5}};
  const std::vector<Location> found = locate(part, PointSet(points), tolerance);
  for (const std::size_t i : {0U, 1U, 2U}) {
    ASSERT_GE(found[i].triangle, 0) << i;
    const PlanePoint at = place(part, found[i]);
    EXPECT_NEAR(std::hypot(at[0] - points[i][0], at[1] - points[i][1]), 0, 2e-10) << i;
    for (const double weight : found[i].weight) {
      EXPECT_GE(weight, 0);
    }
  }
  EXPECT_EQ(found[3].triangle, -1);
  EXPECT_EQ(found[4].triangle, -1);
}

TEST(Locate, PrefersTheTinyTriangleThatHoldsThePoint) {
  // The first one is large and has the point just outside, within the tolerance.
  const Triangulation part{{0, 0, 1, 0, 0, 1, 1e-12, -1e-12}, {0, 1, 2, 0, 3, 1}};
  const std::vector<PlanePoint> points{{2e-12, -0.5e-12}};
  const std::vector<Location> found = locate(part, PointSet(points), tolerance);
  EXPECT_EQ(found[0].triangle, 1);
  EXPECT_GT(found[0].depth, 0);
}

TEST(DistanceToSegment, IsToTheNearestPointOfIt) {
  EXPECT_EQ(distance_to_segment({0.5, 2}, {0, 0}, {1, 0}), 2);
  EXPECT_EQ(distance_to_segment({4, 4}, {0, 0}, {1, 0}), 5);
  EXPECT_EQ(distance_to_segment({-3, 4}, {0, 0}, {0, 0}), 5);
}

}  // namespace
}  // namespace anticrack::fem
