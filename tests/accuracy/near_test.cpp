// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inclusions and cracks that nearly touch: between them terms far larger than the load cancel. The
// answer has bounds all the same, and they hold what a mesh finer everywhere leads to.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "accuracy/base_meshes.hpp"
#include "accuracy/sequence.hpp"
#include "mesh/refine.hpp"
#include "support/paths.hpp"

namespace anticrack::accuracy {
namespace {

using mesh::Point;

struct Near {
  std::string what;
  std::vector<std::vector<Point>> lines;
  std::string force = "y > 0 ? 1 + x : -1";
  bool tilt = false;
};

std::vector<Near> at_distance(double d) {
  return {
      {"one above the other", {{{-0.5, 0}, {0.5, 0}}, {{-0.5, d}, {0.5, d}}}},
      {"staggered", {{{-0.5, 0}, {0.3, 0}}, {{-0.2, d}, {0.6, d}}}},
      {"pressed together", {{{-0.5, 0}, {0.5, 0}}, {{-0.5, d}, {0.5, d}}}, "y > 0 ? -1 : 1 + x"},
      {"tilting", {{{-0.5, 0}, {0.5, 0}}, {{-0.5, d}, {0.5, d}}}, "y > 0 ? 1 + x : -1", true},
      {"one ends at the other", {{{-0.5, 0}, {0.5, 0}}, {{0, d}, {0, 0.6}}}, "1 + x - 3*y"},
      {"end to end", {{{-0.6, 0}, {-d / 2, 0}}, {{d / 2, 0}, {0.6, 0}}}}};
}

mesh::Mesh near_mesh(const Near& near) {
  mesh::Geometry geometry;
  geometry.boundary = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (const std::vector<Point>& points : near.lines) {
    mesh::InclusionSpec one{fmt::format("fibre-{}", geometry.inclusions.size()), {}, {}};
    one.line = mesh::LineSpec{mesh::Shape::polyline, points};
    one.stretches = {{0, 1}};
    one.motion.tilt = near.tilt;
    geometry.inclusions.push_back(one);
  }
  mesh::MeshOptions options;
  options.preset = mesh::Preset::coarse;
  return generated(geometry, options);
}

TEST(NearlyTouching, HaveBoundsThatHold) {
  for (const double d : {1e-2, 3e-3, 2e-3, 1e-3}) {
    for (const Near& near : at_distance(d)) {
      SCOPED_TRACE(fmt::format("{} at {:g}", near.what, d));
      mesh::Mesh mesh = near_mesh(near);
      const std::vector<std::uint8_t> twice(mesh.triangle_count(), 2);
      const auto fine = factorise(mesh::refine(mesh, twice, 2'000'000));
      fem::Load load;
      load.name = "case";
      load.force = fem::Expression{near.force};
      const contact::Answer better = solve(*fine, load, false);
      for (const std::size_t condensed_up_to :
           {operators::default_condensed_up_to, std::size_t{0}, std::size_t{1}}) {
        const contact::Answer answer = solve_bounded(*factorise(mesh, condensed_up_to), load);
        EXPECT_LE(answer.kkt_relative.equilibrium, 1e-8);
        ASSERT_EQ(answer.no_bracket, "");
        EXPECT_LT(*answer.energy_lower, better.energy);
        EXPECT_GT(*answer.energy_upper, better.energy);
        EXPECT_LT(*answer.energy_upper - *answer.energy_lower, 0.5 * -answer.energy);
        for (std::size_t j = 0; j < answer.inclusions.size(); ++j) {
          const contact::InclusionAnswer& one = answer.inclusions[j];
          ASSERT_TRUE(one.displacement_lower && one.displacement_upper);
          EXPECT_LT(*one.displacement_lower, better.inclusions[j].displacement);
          EXPECT_GT(*one.displacement_upper, better.inclusions[j].displacement);
        }
        std::printf("[ figures  ] %s at %g, %zu triangles, %s: KKT %.1e\n", near.what.c_str(), d,
                    mesh.triangle_count(), testing::path_name(condensed_up_to),
                    answer.kkt_relative.equilibrium);
      }
    }
  }
}

}  // namespace
}  // namespace anticrack::accuracy
