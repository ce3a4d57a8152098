// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/plan_layers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/sample_result.hpp"

namespace anticrack::figures {
namespace {

using anticrack::testing::sample_result;

/// A square of two triangles with u = x.
Surface slope() {
  Surface surface;
  const Vertex a{0, 0, 0, 1, 0, 2}, b{1, 0, 1, 1, 0, 2}, c{1, 1, 1, 1, 0, 8}, d{0, 1, 0, 1, 0, 8};
  surface.triangles = {{a, b, c}, {a, c, d}};
  surface.highest = surface.x_max = surface.y_max = 1;
  return surface;
}

TEST(Contour, runs_where_u_has_the_level) {
  const std::vector<Stretch> lines = contour(slope(), 0.3);
  ASSERT_EQ(lines.size(), 2u);
  double length = 0;
  for (const Stretch& line : lines) {
    ASSERT_EQ(line.size(), 2u);
    for (const Spot& spot : line) EXPECT_DOUBLE_EQ(spot.x, 0.3);
    length += std::abs(line[1].y - line[0].y);
  }
  EXPECT_DOUBLE_EQ(length, 1);
  EXPECT_TRUE(contour(slope(), 1.5).empty());
}

TEST(Contour, of_a_level_at_vertices_has_no_loose_ends) {
  for (const Stretch& line : contour(slope(), 1)) EXPECT_EQ(line.size(), 2u);
}

TEST(FluxClasses, sort_triangles_by_size_and_keep_what_is_cut_off) {
  const auto classes = flux_classes(slope(), {6, 5}, 10);  // means of 4 and 6
  ASSERT_EQ(classes.size(), 10u);
  EXPECT_EQ(classes[8].size(), 1u);
  EXPECT_EQ(classes[9].size(), 1u);
  EXPECT_EQ(flux_classes(slope(), {}, 10)[0].size(), 2u);
}

TEST(LooseSide, lies_on_the_minus_side) {
  const auto sides = loose_sides({{{0, 0}, {1, 0}}, {{2, 0}, {2, 1}}}, 0.1);
  ASSERT_EQ(sides.size(), 2u);
  for (const Spot& spot : sides[0]) EXPECT_DOUBLE_EQ(spot.y, -0.1);  // walked to the right
  for (const Spot& spot : sides[1]) EXPECT_DOUBLE_EQ(spot.x, 2.1);   // walked upwards
}

TEST(PlanLayers, find_the_nodes_of_interfaces_again) {
  auto result = sample_result(4);
  const results::MeshPlan plan = plan_of(result);
  ASSERT_EQ(plan.interfaces.size(), 1u);
  EXPECT_EQ(results::first_fault(plan), "");
  for (std::size_t i = 0; i < result.interfaces[0].node_count(); ++i) {
    const auto node = static_cast<std::size_t>(plan.interfaces[0].nodes[i]);
    EXPECT_EQ(result.mesh.xy[2 * node], result.interfaces[0].x[i]);
  }
  result.interfaces[0].x[2] += 1e-12;
  EXPECT_TRUE(plan_of(result).interfaces.empty());
}

TEST(PlanLayers, know_from_the_case_that_no_traction_acts) {
  auto result = sample_result(4);
  const auto free = [&](const std::string& case_text) {
    result.case_text = case_text;
    return plan_of(result).free;
  };
  EXPECT_FALSE(free(""));
  EXPECT_TRUE(free("neumann = 'all'  # no traction acts"));
  EXPECT_FALSE(free("[[load]]\nname = 'traction'\n'traction' = 2"));
}

TEST(PlanLayers, label_levels_apart_from_each_other) {
  const auto result = sample_result(20);
  const Surface seen = surface(result, result.loads[0], 10000);
  const MeshLayers layers = plan_layers(result, seen, flux_peaks(seen), 8, 10);
  EXPECT_FALSE(layers.contours.empty());
  ASSERT_GT(layers.levels.size(), 2u);
  for (std::size_t i = 0; i < layers.levels.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Spot a = layers.levels[i].first, b = layers.levels[j].first;
      EXPECT_GT(std::hypot(a.x - b.x, a.y - b.y), 0.15);
    }
  }
  EXPECT_FALSE(layers.loose.empty());
  EXPECT_TRUE(layers.plus_sides.empty());
}

}  // namespace
}  // namespace anticrack::figures
