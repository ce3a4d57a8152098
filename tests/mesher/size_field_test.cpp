// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/size_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "mesh/geometry_primitives.hpp"

namespace anticrack {
namespace {

using mesher::SizedCurve;
using mesher::SizeField;

TEST(SizeField, GrowsAwayFromTheFinerCurve) {
  const SizeField field({{{-1, 0}, {1, 0}, 0.01}, {{-1, 1}, {1, 1}, 0.05}}, 0.1);
  EXPECT_DOUBLE_EQ(field({0, 0}), 0.01);
  EXPECT_DOUBLE_EQ(field({0, 0.25}), 0.035);
  EXPECT_DOUBLE_EQ(field({2, 0}), 0.05);
  EXPECT_DOUBLE_EQ(field({0, 1}), 0.05);
}

TEST(SizeField, TreeGivesTheMinimumOverAllCurves) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::uniform_real_distribution<double> size(0.001, 0.1);
  for (const std::size_t count : {1, 4, 5, 9, 300}) {
    std::vector<SizedCurve> curves;
    double longest = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const mesh::Point a{coordinate(random), coordinate(random)};
      curves.push_back(
          {a, {a[0] + 0.1 * coordinate(random), a[1] + 0.1 * coordinate(random)}, size(random)});
      longest = std::max(longest, curves.back().size);
    }
    const SizeField field(curves, 0.2);
    for (int k = 0; k < 500; ++k) {
      const mesh::Point p{2 * coordinate(random), 2 * coordinate(random)};
      double expected = longest;
      for (const SizedCurve& c : curves) {
        expected = std::min(expected, c.size + 0.2 * mesh::distance(p, mesh::Segment{c.a, c.b}));
      }
      ASSERT_DOUBLE_EQ(field(p), expected);
    }
  }
}

}  // namespace
}  // namespace anticrack
