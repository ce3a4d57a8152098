// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "errors/errors.hpp"
#include "mesh/codec.hpp"
#include "mesh/refine.hpp"
#include "mesh/refinement_checks.hpp"
#include "mesh/refinement_mesh.hpp"
#include "support/errors.hpp"
#include "support/mesh_quality.hpp"

namespace anticrack::mesh {
namespace {

using testing::expect_refines;
using testing::structured_mesh;

constexpr std::size_t most = 1'000'000;
const std::vector<testing::OnInterface> line{
    {-0.5, 0, Kind::delaminated, 0}, {0, 0.25, Kind::inclusion, 0}, {0.5, 0.75, Kind::crack, -1}};

/// Triangles of every shape, graded towards tips and cut at no dyadic place.
Mesh graded_square(unsigned seed) {
  Mesh mesh = structured_mesh(8, 8, line);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> step(-0.07, 0.07);
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    double &x = mesh.xy[2 * i], &y = mesh.xy[2 * i + 1];
    if (std::abs(x) == 1 || std::abs(y) == 1 || y == 0) continue;
    x += step(random);
    y += step(random);
  }
  return grade(mesh, {.h0 = 0.5, .tip_size = 1e-3}, most);
}

std::vector<std::uint8_t> random_levels(const Mesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> levels(mesh.triangle_count());
  for (std::uint8_t& level : levels)
    level = static_cast<std::uint8_t>(std::max(0, static_cast<int>(random() % 8) - 4));
  return levels;
}

/// The triangle of the base that all corners of a triangle lie in.
std::size_t parent_of(const Mesh& base, const Mesh& fine, std::size_t t) {
  for (std::size_t in = 0; in < base.triangle_count(); ++in) {
    bool inside = true;
    for (std::size_t i = 0; i < 9; ++i) {
      const Point p = corner(base, in, i % 3), q = corner(base, in, (i + 1) % 3),
                  x = corner(fine, t, i / 3);
      const double cross = (q[0] - p[0]) * (x[1] - p[1]) - (q[1] - p[1]) * (x[0] - p[0]);
      inside = inside && cross > -1e-9 * area(base, in);
    }
    if (inside) return in;
  }
  ADD_FAILURE() << "triangle " << t << " is part of no other";
  return 0;
}

TEST(Refine, AgainAndAgainKeepsAnglesAndConforms) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Mesh mesh = graded_square(seed);
    const double bound = mesh.bisection_bound;
    ASSERT_GT(bound, 1);
    for (unsigned round = 0; round < 4; ++round) {
      const Mesh fine = refine(mesh, random_levels(mesh, 10 * seed + round), most);
      expect_refines(mesh, fine);
      EXPECT_EQ(fine.bisection_bound, bound);
      EXPECT_GT(quality(fine).minimum_angle, bound * (1 - 1e-9));
      EXPECT_GT(fine.triangle_count(), mesh.triangle_count());
      mesh = fine;
    }
  }
}

TEST(Refine, MakesPartsAsSmallAsAskedFor) {
  const Mesh base = graded_square(3);
  const std::vector<std::uint8_t> levels = random_levels(base, 7);
  const Mesh fine = refine(base, levels, most);
  std::vector<double> parts(base.triangle_count());
  for (std::size_t t = 0; t < fine.triangle_count(); ++t) {
    const std::size_t in = parent_of(base, fine, t);
    parts[in] += area(fine, t);
    EXPECT_LT(area(fine, t), area(base, in) * std::exp2(-levels[in]) * (1 + 1e-9));
    EXPECT_EQ(fine.subdomain[t], base.subdomain[in]);
  }
  for (std::size_t t = 0; t < parts.size(); ++t)
    EXPECT_NEAR(parts[t], area(base, t), 1e-9 * area(base, t));
}

TEST(Refine, LeavesAMeshWithoutMarks) {
  const Mesh base = graded_square(1);
  const Mesh same = refine(base, std::vector<std::uint8_t>(base.triangle_count(), 0), most);
  EXPECT_EQ(encode(same), encode(base));
}

TEST(Refine, TwiceEverywhereCutsEachEdgeOfRightTriangles) {
  const Mesh base = structured_mesh(8, 8, line);
  const Mesh fine = refine(base, std::vector<std::uint8_t>(base.triangle_count(), 2), most);
  expect_refines(base, fine);
  EXPECT_EQ(fine.triangle_count(), 4 * base.triangle_count());
  EXPECT_EQ(fine.dirichlet.size(), 2 * base.dirichlet.size());
  EXPECT_EQ(fine.interfaces[0].kind.size(), 2 * base.interfaces[0].kind.size());
}

/// At tips whose neighbourhood rounding of coordinates makes a grid of.
TEST(Refine, EndsBeforeRoundingSpoilsTheShape) {
  for (const double unit : {1e-3, 1.0, 1e3}) {
    SCOPED_TRACE(unit);
    Mesh mesh = structured_mesh(8, 8, line);
    for (std::size_t i = 0; i < mesh.xy.size(); ++i)
      mesh.xy[i] = unit * (mesh.xy[i] / 3 + (i % 2 == 0 ? 50.1 : 20.7));
    const double bound = bisection_bound(mesh);
    std::vector<Point> centres;
    for (const std::int32_t tip : tips(mesh)) centres.push_back(testing::point(mesh, tip));
    mesh = grade(mesh, {.h0 = 0.1 * unit}, most);
    std::size_t before = 0;
    for (int round = 0; round < 8; ++round) {
      before = mesh.triangle_count();
      std::vector<std::uint8_t> levels(before, 0);
      for (std::size_t t = 0; t < before; ++t)
        for (std::size_t i = 0; i < 3; ++i)
          if (std::ranges::find(centres, corner(mesh, t, i)) != centres.end()) levels[t] = 8;
      mesh = refine(mesh, levels, most);
      ASSERT_GT(quality(mesh).minimum_angle, 0.9 * bound) << "round " << round;
    }
    EXPECT_EQ(mesh.triangle_count(), before);
  }
}

TEST(Refine, RefusesMoreTrianglesThanAllowed) {
  const Mesh base = graded_square(2);
  const std::vector<std::uint8_t> levels(base.triangle_count(), 2);
  const std::size_t needed = refine(base, levels, most).triangle_count();
  EXPECT_NO_THROW(refine(base, levels, needed));
  EXPECT_TRUE(
      testing::throws([&] { refine(base, levels, needed - 1); }, errors::Reason::limit_exceeded));
}

TEST(Refine, GoesOnAlikeFromAStoredMesh) {
  const Mesh base = graded_square(4);
  const Mesh once = refine(base, random_levels(base, 1), most);
  const std::vector<std::uint8_t> levels = random_levels(once, 2);
  const Bytes wanted = encode(refine(once, levels, most));
  EXPECT_EQ(encode(refine(once, levels, most)), wanted);
  const auto reply = std::get<Mesh>(decode_reply(encode(MesherReply(once))));
  EXPECT_EQ(encode(refine(reply, levels, most)), wanted);
  // The bound, which says where the reference edges are, is in the record of a stored mesh.
  Mesh stored = decode_mesh(encode(once));
  stored.bisection_bound = once.bisection_bound;
  EXPECT_EQ(encode(refine(stored, levels, most)), wanted);
}

}  // namespace
}  // namespace anticrack::mesh
