// SPDX-License-Identifier: GPL-3.0-or-later
//
// What must hold of a refined mesh, computed in the most obvious way.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"
#include "mesh/quality.hpp"

namespace anticrack::testing {

inline mesh::Point point(const mesh::Mesh& m, std::int32_t node) {
  const auto i = 2 * static_cast<std::size_t>(node);
  return {m.xy[i], m.xy[i + 1]};
}

inline double distance(const mesh::Point& p, const mesh::Point& q) {
  return std::hypot(q[0] - p[0], q[1] - p[1]);
}

/// Of each subdomain.
inline std::vector<double> areas(const mesh::Mesh& m) {
  std::vector<double> sums(m.subdomains.size(), 0.0);
  for (std::size_t t = 0; t < m.triangle_count(); ++t) {
    sums[static_cast<std::size_t>(m.subdomain[t])] += mesh::area(m, t);
  }
  return sums;
}

inline double boundary_length(const mesh::Mesh& m) {
  double sum = 0;
  for (const auto& [a, b] : m.dirichlet) sum += distance(point(m, a), point(m, b));
  return sum;
}

inline double diameter(const mesh::Mesh& m, std::size_t t) {
  const mesh::Point a = mesh::corner(m, t, 0);
  const mesh::Point b = mesh::corner(m, t, 1);
  const mesh::Point c = mesh::corner(m, t, 2);
  return std::max({distance(a, b), distance(b, c), distance(c, a)});
}

/// The least distance of a fine sample of the triangle's sides from `p`; exact at the corners.
inline double sampled_distance(const mesh::Mesh& m, std::size_t t, const mesh::Point& p) {
  constexpr int pieces = 16;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const mesh::Point a = mesh::corner(m, t, i);
    const mesh::Point b = mesh::corner(m, t, (i + 1) % 3);
    const mesh::Point pa{a[0] - p[0], a[1] - p[1]};
    for (int k = 0; k < pieces; ++k) {
      const double s = static_cast<double>(k) / pieces;
      least = std::min(least, std::hypot(pa[0] + s * (b[0] - a[0]), pa[1] + s * (b[1] - a[1])));
    }
  }
  return least;
}

/// A tip as the size rule sees it: R and h_tip of mesh::Grading.
struct GradedTip {
  mesh::Point at{};
  double radius = 0;
  double tip_size = 0;
};

/// The largest h_T / h over all triangles, h the least that a tip allows. A sample overestimates
/// the distance, so this is a lower bound of the truth, short of it by less than 1/32 of h_T at
/// most.
inline double worst_size_ratio(const mesh::Mesh& m, std::span<const GradedTip> tips, double h0,
                               double exponent_m) {
  double worst = 0;
  for (std::size_t t = 0; t < m.triangle_count(); ++t) {
    const double own = diameter(m, t);
    double allowed = h0;
    for (const GradedTip& tip : tips) {
      const auto size = [&](double r) {
        return std::max(tip.tip_size, h0 * std::pow(r / tip.radius, 1 - exponent_m));
      };
      // nearer than this no point of the triangle lies
      const double near = distance(mesh::corner(m, t, 0), tip.at) - own;
      if (near > 0 && size(near) >= allowed) continue;
      allowed = std::min(allowed, size(sampled_distance(m, t, tip.at)));
    }
    worst = std::max(worst, own / allowed);
  }
  return worst;
}

/// Of tips that are alike.
inline double worst_size_ratio(const mesh::Mesh& m, std::span<const mesh::Point> centres, double h0,
                               double exponent_m, double tip_size, double radius) {
  std::vector<GradedTip> tips;
  for (const mesh::Point& centre : centres) tips.push_back({centre, radius, tip_size});
  return worst_size_ratio(m, tips, h0, exponent_m);
}

/// That the interface has its ends, direction, kinds and inclusions of before: every node of the
/// base chain appears in order, and every piece between two of them has the kind and inclusion of
/// their edge and runs forwards.
inline void expect_same_line(const mesh::Mesh& base, const mesh::Mesh& fine, std::size_t line) {
  const mesh::Interface& before = base.interfaces[line];
  const mesh::Interface& after = fine.interfaces[line];
  EXPECT_EQ(after.name, before.name);
  ASSERT_EQ(after.kind.size() + 1, after.nodes.size());
  ASSERT_EQ(after.inclusion.size(), after.kind.size());
  ASSERT_EQ(after.nodes.front(), before.nodes.front());
  ASSERT_EQ(after.nodes.back(), before.nodes.back());
  std::size_t edge = 0;
  for (std::size_t i = 0; i < after.kind.size(); ++i) {
    if (edge + 1 < before.kind.size() && after.nodes[i] == before.nodes[edge + 1]) ++edge;
    ASSERT_EQ(after.kind[i], before.kind[edge]) << "piece " << i;
    ASSERT_EQ(after.inclusion[i], before.inclusion[edge]) << "piece " << i;
    const mesh::Point a = point(base, before.nodes[edge]);
    const mesh::Point b = point(base, before.nodes[edge + 1]);
    const mesh::Point p = point(fine, after.nodes[i]);
    const mesh::Point q = point(fine, after.nodes[i + 1]);
    EXPECT_GT((q[0] - p[0]) * (b[0] - a[0]) + (q[1] - p[1]) * (b[1] - a[1]), 0) << "piece " << i;
  }
  EXPECT_EQ(edge + 1, before.kind.size());
  EXPECT_NEAR(mesh::arc_length(fine, after).back(), mesh::arc_length(base, before).back(),
              1e-12 * mesh::arc_length(base, before).back());
}

/// Everything that every refinement keeps.
inline void expect_refines(const mesh::Mesh& base, const mesh::Mesh& fine) {
  ASSERT_NO_THROW(mesh::validate(fine));
  ASSERT_GE(fine.xy.size(), base.xy.size());
  EXPECT_TRUE(std::equal(base.xy.begin(), base.xy.end(), fine.xy.begin()));
  EXPECT_EQ(fine.subdomains, base.subdomains);
  EXPECT_EQ(fine.tension, base.tension);
  EXPECT_EQ(fine.tension_laws, base.tension_laws);
  EXPECT_EQ(fine.inclusions, base.inclusions);
  EXPECT_EQ(fine.motions, base.motions);
  EXPECT_EQ(fine.warnings, base.warnings);
  const std::vector<double> before = areas(base);
  const std::vector<double> after = areas(fine);
  for (std::size_t s = 0; s < before.size(); ++s) {
    EXPECT_NEAR(after[s], before[s], 1e-12 * before[s]);
  }
  EXPECT_NEAR(boundary_length(fine), boundary_length(base), 1e-12 * boundary_length(base));
  ASSERT_EQ(fine.interfaces.size(), base.interfaces.size());
  for (std::size_t i = 0; i < base.interfaces.size(); ++i) expect_same_line(base, fine, i);
}

}  // namespace anticrack::testing
