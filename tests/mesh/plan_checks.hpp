// SPDX-License-Identifier: GPL-3.0-or-later
//
// What holds of every plan.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "mesh/geometry.hpp"

namespace anticrack::testing {

inline const mesh::Point& point(const mesh::Plan& plan, int i) {
  return plan.points.at(static_cast<std::size_t>(i));
}

inline const mesh::PlannedCurve& curve(const mesh::Plan& plan, int i) {
  return plan.curves.at(static_cast<std::size_t>(i));
}

/// From and to of a signed curve of a loop.
inline std::pair<int, int> ends(const mesh::Plan& plan, int edge) {
  const mesh::PlannedCurve& c = curve(plan, std::abs(edge) - 1);
  return edge > 0 ? std::pair(c.a, c.b) : std::pair(c.b, c.a);
}

inline double loop_area(const mesh::Plan& plan, const std::vector<int>& loop) {
  double twice = 0;
  for (const int edge : loop) {
    const auto [from, to] = ends(plan, edge);
    twice += point(plan, from)[0] * point(plan, to)[1] - point(plan, from)[1] * point(plan, to)[0];
  }
  return twice / 2;
}

inline double face_area(const mesh::Plan& plan, const mesh::PlannedFace& face) {
  double area = loop_area(plan, face.outer);
  for (const auto& hole : face.holes) area += loop_area(plan, hole);
  return area;
}

inline double length(const mesh::Plan& plan, const mesh::PlannedCurve& c) {
  return std::hypot(point(plan, c.b)[0] - point(plan, c.a)[0],
                    point(plan, c.b)[1] - point(plan, c.a)[1]);
}

/// Area of each subdomain.
inline std::map<std::string, double> areas(const mesh::Plan& plan) {
  std::map<std::string, double> sums;
  for (const auto& face : plan.faces) sums[face.name] += face_area(plan, face);
  return sums;
}

/// Number of curves of an interface of a kind, over all its chains.
inline int count(const mesh::Plan& plan, mesh::Kind kind) {
  int n = 0;
  for (const auto& c : plan.curves) n += c.role == mesh::Role::interface && c.kind == kind;
  return n;
}

/// Loops are closed, simple and oriented, cover `area`, and say of every curve the faces it says
/// itself; every curve lies in a loop twice or is embedded once; chains are chains.
inline void expect_consistent(const mesh::Plan& plan, double area) {
  std::vector<int> left(plan.curves.size(), -1);
  std::vector<int> right(plan.curves.size(), -1);
  double sum = 0;
  for (std::size_t f = 0; f < plan.faces.size(); ++f) {
    const auto& face = plan.faces[f];
    EXPECT_FALSE(face.name.empty());
    EXPECT_GT(face.tension, 0);
    const auto walk = [&](const std::vector<int>& loop) {
      ASSERT_GE(loop.size(), 3U);
      std::set<int> passed;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        EXPECT_EQ(ends(plan, loop[i]).second, ends(plan, loop[(i + 1) % loop.size()]).first);
        EXPECT_TRUE(passed.insert(ends(plan, loop[i]).first).second);
        int& side =
            (loop[i] > 0 ? left : right).at(static_cast<std::size_t>(std::abs(loop[i]) - 1));
        EXPECT_EQ(side, -1);
        side = static_cast<int>(f);
      }
    };
    walk(face.outer);
    EXPECT_GT(loop_area(plan, face.outer), 0);
    for (const auto& hole : face.holes) {
      walk(hole);
      EXPECT_LT(loop_area(plan, hole), 0);
    }
    for (const int e : face.embedded) {
      EXPECT_EQ(left.at(static_cast<std::size_t>(e)), -1);
      EXPECT_EQ(right.at(static_cast<std::size_t>(e)), -1);
      left[static_cast<std::size_t>(e)] = right[static_cast<std::size_t>(e)] = static_cast<int>(f);
    }
    sum += face_area(plan, face);
  }
  EXPECT_NEAR(sum, area, 1e-12 * area);
  for (std::size_t e = 0; e < plan.curves.size(); ++e) {
    const auto& c = plan.curves[e];
    EXPECT_EQ(left[e], c.left) << e;
    EXPECT_EQ(right[e], c.right) << e;
    EXPECT_GE(c.intervals, 1);
    EXPECT_GT(length(plan, c), 0);
    const bool outer = c.role == mesh::Role::dirichlet || c.role == mesh::Role::neumann;
    EXPECT_EQ(outer, c.right == -1 || c.left == -1) << e;
    EXPECT_EQ(c.inclusion >= 0,
              c.kind == mesh::Kind::inclusion || c.kind == mesh::Kind::delaminated);
  }
  std::set<std::string> names;
  std::set<int> in_chains;
  for (const auto& chain : plan.interfaces) {
    EXPECT_TRUE(names.insert(chain.name).second) << chain.name;
    ASSERT_FALSE(chain.curves.empty());
    for (std::size_t i = 0; i < chain.curves.size(); ++i) {
      EXPECT_EQ(curve(plan, chain.curves[i]).role, mesh::Role::interface);
      EXPECT_TRUE(in_chains.insert(chain.curves[i]).second);
      if (i == 0) continue;
      EXPECT_EQ(curve(plan, chain.curves[i - 1]).b, curve(plan, chain.curves[i]).a);
    }
  }
  for (std::size_t e = 0; e < plan.curves.size(); ++e) {
    const bool is_interface = plan.curves[e].role == mesh::Role::interface;
    EXPECT_EQ(is_interface, in_chains.count(static_cast<int>(e)) == 1) << e;
    if (is_interface && plan.curves[e].kind == mesh::Kind::glue) {
      EXPECT_NE(plan.faces.at(static_cast<std::size_t>(plan.curves[e].left)).name,
                plan.faces.at(static_cast<std::size_t>(plan.curves[e].right)).name);
    }
  }
}

}  // namespace anticrack::testing
