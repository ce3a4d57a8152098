// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "figures/plan_layers.hpp"
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

TEST(Surface, has_the_fluxes_that_python_has) {
  std::ifstream table(ANTICRACK_SAME "/flux.txt");
  results::Result result;
  results::Field field;
  double shown = 0, highest = 0;
  for (std::string line; std::getline(table, line);) {
    std::istringstream words(line);
    std::string what;
    double x = 0, y = 0, third = 0;
    words >> what >> x >> y >> third;
    if (what == "node") {
      result.mesh.xy.insert(result.mesh.xy.end(), {x, y});
      field.nodes.push_back(static_cast<std::int32_t>(field.nodes.size()));
      field.u.push_back(third);
    }
    if (what == "triangle")
      for (const double corner : {x, y, third})
        field.triangles.push_back(static_cast<std::int32_t>(corner));
    if (what == "drawn") {
      shown = x;
      highest = y;
    }
  }
  result.mesh.tension = {2};
  results::Load load;
  load.fields = {field};
  for (const std::size_t limit : {100, 2}) {  // also of triangles that are merged
    const Peaks seen = flux_peaks(surface(result, load, limit));
    EXPECT_NEAR(seen.shown, shown, 1e-9);
    EXPECT_NEAR(seen.highest, highest, 1e-9);
    EXPECT_TRUE(seen.cut_off());
  }
}

TEST(Surface, knows_the_slope_and_the_flux_of_each_side) {
  auto result = sample_result(8);
  for (auto& field : result.loads[0].fields)
    for (std::size_t i = 0; i < field.nodes.size(); ++i) {
      const auto node = static_cast<std::size_t>(field.nodes[i]);
      field.u[i] = 3 * result.mesh.xy[2 * node] - 4 * result.mesh.xy[2 * node + 1];
    }
  for (const Triangle& triangle : surface(result, result.loads[0], 100000).triangles)
    for (const Vertex& v : triangle) EXPECT_NEAR(v.flux, 5, 1e-12);  // of a law the mean is known
  result.mesh.tension_law.clear();
  for (const Triangle& triangle : surface(result, result.loads[0], 100000).triangles)
    for (const Vertex& v : triangle) {
      const bool plus = triangle[0].y + triangle[1].y + triangle[2].y > 0;  // T = 2, else 1
      EXPECT_NEAR(v.slope_x, 3, 1e-12);
      EXPECT_NEAR(v.slope_y, -4, 1e-12);
      EXPECT_NEAR(v.flux, plus ? 10 : 5, 1e-12);
    }
}

TEST(Surface, is_refined_where_triangles_are_long) {
  const auto result = sample_result(2);
  Surface seen = surface(result, result.loads[0], 1000);  // 32 triangles, edges of 0.71
  seen.triangles = refined(seen.triangles, 0.4, 200);
  EXPECT_EQ(seen.triangles.size(), 128u);
  EXPECT_NEAR(area(seen), 4, 1e-12);
  EXPECT_EQ(refined(seen.triangles, 0.2, 200).size(), 128u);  // 512 are too many
  EXPECT_EQ(refined(seen.triangles, 0.4, 1000).size(), 128u);
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

/// The sample with the interface's crack inside one subdomain: a slit.
results::Result slit_result(int n) {
  results::Result result = sample_result(n);
  result.mesh.subdomains = {"whole"};
  result.mesh.tension = {1};
  result.mesh.tension_law = {};
  std::fill(result.mesh.subdomain.begin(), result.mesh.subdomain.end(), 0);
  for (results::Load& load : result.loads) {
    const results::Field lower = load.fields[0];
    const results::Field upper = load.fields[1];
    results::Field whole = lower;
    std::vector<std::int32_t> place(upper.nodes.size());
    for (std::size_t i = 0; i < upper.nodes.size(); ++i) {
      const auto node = static_cast<std::size_t>(upper.nodes[i]);
      const double x = result.mesh.xy[2 * node];
      const bool tied = result.mesh.xy[2 * node + 1] == 0 && std::abs(x) >= 0.5 - 1e-9;
      if (tied) {
        const auto same = std::find(lower.nodes.begin(), lower.nodes.end(), upper.nodes[i]);
        place[i] = static_cast<std::int32_t>(same - lower.nodes.begin());
        continue;
      }
      place[i] = static_cast<std::int32_t>(whole.nodes.size());
      whole.nodes.push_back(upper.nodes[i]);
      whole.u.push_back(upper.u[i]);
    }
    for (const std::int32_t corner : upper.triangles) {
      whole.triangles.push_back(place[static_cast<std::size_t>(corner)]);
    }
    load.fields = {whole};
  }
  return result;
}

/// Largest difference of u between the faces seen at the middle of the crack.
double opening_at_the_middle(const Surface& surface) {
  double low = 1e9, high = -1e9;
  for (const Triangle& triangle : surface.triangles) {
    for (const Vertex& v : triangle) {
      if (v.y != 0 || std::abs(v.x) > 0.1) continue;
      low = std::min(low, v.u);
      high = std::max(high, v.u);
    }
  }
  return high - low;
}

TEST(Surface, of_a_slit_is_open) {
  const auto result = slit_result(40);
  ASSERT_EQ(results::first_fault(result), "");
  for (const std::size_t limit : {100000u, 3000u}) {
    const Surface seen = surface(result, result.loads[0], limit);
    EXPECT_LE(seen.triangles.size(), limit);
    EXPECT_GT(opening_at_the_middle(seen), 0.1) << limit;
    for (const Triangle& triangle : seen.triangles) {
      const auto [low, high] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
      const double x = (triangle[0].x + triangle[1].x + triangle[2].x) / 3;
      EXPECT_FALSE(low < 0 && high > 0 && std::abs(x) < 0.4) << "a triangle spans the slit";
    }
    EXPECT_NEAR(area(seen), 4.0, 0.15);
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
  seen.x_max = seen.y_max = 2;
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
