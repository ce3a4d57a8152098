// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/sample_result.hpp"

namespace anticrack::figures {
namespace {

using anticrack::testing::sample_result;
using anticrack::testing::sample_u;

double area(const Surface& surface) {
  double sum = 0;
  for (const Triangle& t : surface.triangles) {
    sum += 0.5 *
           std::abs((t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y));
  }
  return sum;
}

TEST(Surface, has_every_triangle_with_the_u_of_its_side) {
  const auto result = sample_result(8);
  const Surface seen = surface(result, result.loads[0], 100000);
  EXPECT_EQ(seen.triangles.size(), 512u);
  EXPECT_DOUBLE_EQ(seen.width(), 2);
  double opening = 0;
  for (const Triangle& triangle : seen.triangles) {
    const bool plus = triangle[0].y + triangle[1].y + triangle[2].y > 0;
    for (const Vertex& v : triangle) {
      EXPECT_DOUBLE_EQ(v.u, sample_u(v.x, v.y, plus, false));
      if (v.x == 0 && v.y == 0) opening = std::max(opening, plus ? v.u : -v.u);
    }
  }
  EXPECT_GT(opening, 0.05);  // both faces are there, apart
}

TEST(Surface, is_coarsened_to_the_limit_and_stays_whole) {
  const auto result = sample_result(40);  // 12800 triangles
  const Surface seen = surface(result, result.loads[0], 3000);
  EXPECT_LE(seen.triangles.size(), 3000u);
  EXPECT_GT(seen.triangles.size(), 800u);
  EXPECT_NEAR(area(seen), 4.0, 0.15);
  for (const Triangle& triangle : seen.triangles) {
    bool minus = false, plus = false;
    for (const Vertex& v : triangle) {
      minus = minus || v.y < 0;
      plus = plus || v.y > 0;
    }
    EXPECT_FALSE(minus && plus);  // the slit stays open
  }
}

TEST(Surface, leaves_out_what_is_not_finite) {
  auto result = sample_result(4);
  for (auto& field : result.loads[0].fields) {
    for (double& u : field.u) u = std::numeric_limits<double>::infinity();
  }
  EXPECT_TRUE(surface(result, result.loads[0], 1000).triangles.empty());
  EXPECT_TRUE(surface({}, {}, 1000).triangles.empty());
}

TEST(Amplification, is_round_and_fits_the_membrane) {
  Surface seen;
  seen.x_max = 2;
  for (const double u : {1e-9, 0.003, 0.02, 0.0863, 0.3, 7.0, 1e5}) {
    seen.highest = u;
    const double height = amplification(seen) * u / seen.width();
    EXPECT_LE(height, 0.38 * (1 + 1e-12)) << u;
    EXPECT_GT(height, 0.2) << u;
  }
  seen.highest = 0;
  EXPECT_EQ(amplification(seen), 1);
}

}  // namespace
}  // namespace anticrack::figures
