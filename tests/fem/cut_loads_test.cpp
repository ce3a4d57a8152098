// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fields that jump where the mesh does not know it, against exact geometry.
#include <gmock/gmock.h>

#include <cmath>
#include <iostream>
#include <random>

#include "fem/adaptive_load.hpp"
#include "support/exact_loads.hpp"
#include "support/load_errors.hpp"

namespace anticrack::testing {
namespace {

constexpr double pi = 3.14159265358979323846;

void expect_right(const LoadErrors& errors, double scale = 1) {
  EXPECT_LT(errors.whole, 1e-11 * scale);
  EXPECT_LT(errors.nodal, 1e-10 * scale);
  EXPECT_LT(errors.report.relative_error_estimate, 1e-10);
}

TEST(StraightJump, IsExactOnMeshesThatDoNotFollowIt) {
  const std::vector<std::pair<std::string, Line>> jumps{{"x = 0", {1, 0, 0}},
                                                        {"y = x", {1, -1, 0}},
                                                        {"slanted", {std::sqrt(2), -1, 0.1}},
                                                        {"flat", {1e-3, 1, 0.3}}};
  for (const std::size_t n : {5U, 20U, 75U}) {
    const PlaneMesh mesh = square_mesh(n, 0.2, 3);
    for (const auto& [name, line] : jumps) {
      const std::string f = beyond(line) + " ? 1 : -0.5";
      const LoadErrors errors = compare(name, mesh, f, loads_cut_by_lines(mesh, {line}, field(f)));
      expect_right(errors);
      EXPECT_GE(errors.report.cut_triangles, 2 * n - 1);
      EXPECT_LT(errors.report.evaluations,
                15 * mesh.triangle_count() + 4000 * errors.report.cut_triangles);
    }
  }
}

TEST(StraightJump, BetweenPolynomials) {
  const PlaneMesh mesh = square_mesh(12, 0.2, 5);
  const Line line{0.7, 1.1, 0.21};
  const std::string f = beyond(line) + " ? 1 + x^2*y : 2 - y^3 + x";
  expect_right(compare("polynomials", mesh, f, loads_cut_by_lines(mesh, {line}, field(f))));
}

TEST(StraightJump, SmallNextToASteepSlope) {
  const PlaneMesh mesh = square_mesh(20, 0.2, 6);
  const Line line{0.3, 1, 0.17};
  const std::string f = "1 + 50*x + 1e-4*" + beyond(line);
  expect_right(compare("small", mesh, f, loads_cut_by_lines(mesh, {line}, field(f))), 50);
}

TEST(StraightJump, CutsOffACornerHoweverSmall) {
  const PlaneMesh mesh{{0, 0, 1, 0, 0.2, 0.9}, {0, 1, 2}};
  for (const double size : {0.5, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12}) {
    const Line line{1, 1.3, size};
    const std::string f = beyond(line) + " ? 1 : -1";
    expect_right(compare("corner " + std::to_string(size), mesh, f,
                         loads_cut_by_lines(mesh, {line}, field(f))));
  }
}

TEST(StraightJump, ThroughACorner) {
  const PlaneMesh mesh{{0.1, 0.3, 1, 0, 0.2, 0.9}, {0, 1, 2}};
  for (const double slope : {0.3, -0.1, 1.0, 2.0, 5.0}) {
    const Line line{slope, -1, slope * 0.1 - 0.3};
    const std::string f = beyond(line) + " ? 1 : -1";
    expect_right(compare("slope " + std::to_string(slope), mesh, f,
                         loads_cut_by_lines(mesh, {line}, field(f))));
  }
}

TEST(JumpOnEdges, CostsNothing) {
  const PlaneMesh mesh = square_mesh(10, 0, 0);
  for (const Line& line : {Line{1, 0, 0}, Line{0, 1, 0}, Line{1, -1, 0}}) {
    const std::string f = beyond(line) + " ? 2 : -1";
    const LoadErrors errors =
        compare("on edges", mesh, f, loads_cut_by_lines(mesh, {line}, field(f)));
    expect_right(errors);
    EXPECT_LE(errors.report.evaluations, 8 * mesh.triangle_count());
    EXPECT_EQ(errors.report.cut_triangles, 0U);
  }
}

TEST(JumpOnEdges, RoundedEdges) {
  PlaneMesh mesh = square_mesh(16, 0, 0);
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    const double x = mesh.xy[2 * i], y = mesh.xy[2 * i + 1];
    mesh.xy[2 * i] = 0.3 + c * x - s * y;
    mesh.xy[2 * i + 1] = 0.2 + s * x + c * y;
  }
  const Line line{-s, c, -s * 0.3 + c * 0.2};
  const std::string f = beyond(line);
  const LoadErrors errors = compare("rounded", mesh, f, loads_cut_by_lines(mesh, {line}, field(f)));
  expect_right(errors);
  EXPECT_LT(errors.report.evaluations, 20 * mesh.triangle_count());
}

/// Nodes on the circle, edges inside it: the lens between chord and arc is seen by no point deep in
/// a triangle.
TEST(JumpOnEdges, ArcBehindItsChord) {
  for (const std::size_t n : {8U, 40U}) {
    PlaneMesh mesh{{0, 0}, {}};
    const auto count = static_cast<std::int32_t>(n);
    for (const double r : {0.6, 1.0}) {
      for (std::size_t i = 0; i < n; ++i) {
        const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(n);
        mesh.xy.push_back(r * std::cos(angle));
        mesh.xy.push_back(r * std::sin(angle));
      }
    }
    for (std::int32_t i = 0; i < count; ++i) {
      const std::int32_t a = 1 + i, b = 1 + (i + 1) % count;
      for (const std::int32_t node : {0, a, b, a, a + count, b, b, a + count, b + count}) {
        mesh.triangles.push_back(node);
      }
    }
    const std::string f = "x^2 + y^2 < 0.36";
    expect_right(compare("arc", mesh, f, loads_of_disc(mesh, {0, 0}, 0.6)));
  }
}

TEST(Circle, AreaAndNodalLoads) {
  for (const std::size_t n : {10U, 20U, 75U}) {
    const PlaneMesh mesh = square_mesh(n, 0.2, 11);
    const std::string f = "x^2 + y^2 < 0.3 ? 1 : 0";
    const std::vector<double> exact = loads_of_disc(mesh, {0, 0}, std::sqrt(0.3));
    double area = 0;
    for (const double part : exact) {
      area += part;
    }
    ASSERT_NEAR(area, 0.3 * pi, 1e-13);
    expect_right(compare("circle", mesh, f, exact));
  }
}

TEST(Circle, Random) {
  const unsigned seed = 20240;
  std::cout << "seed " << seed << "\n";
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 30; ++i) {
    const PlaneMesh mesh = square_mesh(30, 0.2, seed + static_cast<unsigned>(i));
    const double r = uniform(0.2, 0.6), x0 = uniform(-0.35, 0.35), y0 = uniform(-0.35, 0.35);
    SCOPED_TRACE("circle " + std::to_string(i));
    const std::string f = inside({x0, y0}, r);
    expect_right(compare("random circle", mesh, f, loads_of_disc(mesh, {x0, y0}, r)));
  }
}

TEST(Circle, SmallerThanATriangleButSeen) {
  const PlaneMesh mesh = square_mesh(10, 0, 0);
  const std::string f = inside({0.01, -0.02}, 0.1);
  const LoadErrors errors = compare("small", mesh, f, loads_of_disc(mesh, {0.01, -0.02}, 0.1));
  EXPECT_LT(errors.whole, 1e-11);
}

TEST(Crossing, QuadrantsOfExample2) {
  const std::string f = "x*y > 0 ? 1 : -1";
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
    for (const std::size_t n : {9U, 75U}) {
      const PlaneMesh mesh = square_mesh(n, 0.2, seed);
      expect_right(compare("quadrants", mesh, f,
                           loads_cut_by_lines(mesh, {{1, 0, 0}, {0, 1, 0}}, field(f))));
    }
  }
}

TEST(Crossing, CheckerboardAsFineAsTheMesh) {
  std::vector<Line> lines;
  for (int i = -3; i <= 3; ++i) {
    lines.push_back({1, 0, 0.1 * pi * i});
    lines.push_back({0, 1, 0.1 * pi * i});
  }
  const std::string f = "sin(10*x)*sin(10*y) > 0 ? 1 : -1";
  for (const std::size_t n : {7U, 15U, 40U}) {
    const PlaneMesh mesh = square_mesh(n, 0.2, 17);
    expect_right(compare("checkerboard", mesh, f, loads_cut_by_lines(mesh, lines, field(f))));
  }
}

TEST(Crossing, ThreeRandomLines) {
  const unsigned seed = 4711;
  std::cout << "seed " << seed << "\n";
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 40; ++i) {
    const PlaneMesh mesh = square_mesh(15, 0.2, seed + static_cast<unsigned>(i));
    std::vector<Line> lines;
    for (int k = 0; k < 3; ++k) {
      const double angle = uniform(0, pi);
      lines.push_back({std::cos(angle), std::sin(angle), uniform(-0.4, 0.4)});
    }
    std::string f = "1";
    for (const Line& line : lines) {
      f += "*(" + beyond(line) + " ? 1 : -0.5)";
    }
    SCOPED_TRACE("case " + std::to_string(i));
    expect_right(compare("three lines", mesh, f, loads_cut_by_lines(mesh, lines, field(f))));
  }
}

/// Two jumps that end at each other: a tip too narrow for the samples may poke into a triangle, so
/// a few cases are allowed to be no better than 1e-5.
TEST(Crossing, RandomDiscCutByALine) {
  const unsigned seed = 808;
  std::cout << "seed " << seed << "\n";
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int missed = 0;
  for (int i = 0; i < 40; ++i) {
    const PlaneMesh mesh = square_mesh(25, 0.2, seed + static_cast<unsigned>(i));
    const double r = uniform(0.3, 0.6), x0 = uniform(-0.3, 0.3), y0 = uniform(-0.3, 0.3);
    const double angle = uniform(0, 2 * pi);
    const Line line{std::cos(angle), std::sin(angle),
                    std::cos(angle) * x0 + std::sin(angle) * y0 + uniform(-0.7, 0.7) * r};
    const std::string f = inside({x0, y0}, r) + " && " + beyond(line);
    const LoadErrors errors =
        compare("disc and line", mesh, f, loads_of_disc(mesh, {x0, y0}, r, {line}));
    EXPECT_LT(errors.whole, 1e-5) << i;
    missed += errors.whole > 1e-11 || errors.nodal > 1e-10 ? 1 : 0;
  }
  EXPECT_LE(missed, 3);
}

TEST(Kink, IsExactLikeAJump) {
  const PlaneMesh mesh = square_mesh(20, 0.2, 23);
  const std::string f = "abs(x - 0.3) + abs(x + y)*x";
  const LoadErrors errors =
      compare("kinks", mesh, f, loads_cut_by_lines(mesh, {{1, 0, 0.3}, {1, 1, 0}}, field(f)));
  expect_right(errors);
  EXPECT_LT(errors.report.evaluations,
            15 * mesh.triangle_count() + 6000 * errors.report.cut_triangles);
}

TEST(SmallTriangles, RoundingDoesNotRunAway) {
  // Triangles shrink by half towards a point of the jump, down to where coordinates run out.
  PlaneMesh mesh;
  const double x0 = 0.3, y0 = 0.4;
  double size = 0.5;
  for (int level = 0; level < 48; ++level, size /= 2) {
    const auto first = static_cast<std::int32_t>(mesh.node_count());
    for (const PlanePoint& corner :
         {PlanePoint{-0.9, -0.7}, PlanePoint{1.1, -0.2}, PlanePoint{-0.1, 0.8}}) {
      mesh.xy.push_back(x0 + size * corner[0]);
      mesh.xy.push_back(y0 + size * corner[1]);
    }
    for (std::int32_t i = 0; i < 3; ++i) {
      mesh.triangles.push_back(first + i);
    }
  }
  const Line line{0.6, -1, 0.6 * x0 - y0};
  const std::string f = beyond(line) + " ? 1 : -1";
  const std::vector<double> exact = loads_cut_by_lines(mesh, {line}, field(f));
  std::vector<double> load;
  const auto report = integrate(mesh, f, load);
  EXPECT_LT(report.evaluations, 6000 * mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const double area = polygon_area(corners(mesh, t));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(load[3 * t + i], exact[3 * t + i], 1e-10 * area + 1e-14 * std::sqrt(area)) << t;
    }
  }
}

}  // namespace
}  // namespace anticrack::testing
