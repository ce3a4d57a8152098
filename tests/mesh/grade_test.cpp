// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "mesh/edges.hpp"
#include "mesh/refine.hpp"
#include "mesh/refinement_checks.hpp"
#include "mesh/refinement_mesh.hpp"
#include "support/mesh_quality.hpp"

namespace anticrack::mesh {
namespace {

using testing::expect_refines;
using testing::OnInterface;
using testing::paper;
using testing::plenty;
using testing::structured_mesh;

/// A sample of 16 points a side finds the distance to within h_T/32, and h_T is less than half the
/// distance wherever the tip size does not decide.
constexpr double sampling = 1.05;

std::vector<Point> points(const Mesh& mesh, const std::vector<std::int32_t>& nodes) {
  std::vector<Point> found;
  found.reserve(nodes.size());
  for (const std::int32_t node : nodes) found.push_back(testing::point(mesh, node));
  return found;
}

/// Moves every node by up to `part` of the mesh width except those on the boundary, which stay on
/// it, and the tips.
Mesh perturbed(Mesh mesh, double width, double part, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto shift = [&] { return part * width * (2 * (random() / 4294967296.0) - 1); };
  const std::vector<std::int32_t> fixed = tips(mesh);
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    double& x = mesh.xy[2 * n];
    double& y = mesh.xy[2 * n + 1];
    const bool stays = std::ranges::find(fixed, static_cast<std::int32_t>(n)) != fixed.end();
    const bool on_boundary = std::abs(x) == 1 || std::abs(y) == 1;
    const double dx = shift();
    const double dy = shift();
    if (stays || on_boundary) continue;
    x += dx;
    y += dy;
  }
  return mesh;
}

Mesh moved(Mesh mesh, double angle, const Point& by) {
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    const double x = mesh.xy[2 * n];
    const double y = mesh.xy[2 * n + 1];
    mesh.xy[2 * n] = std::cos(angle) * x - std::sin(angle) * y + by[0];
    mesh.xy[2 * n + 1] = std::sin(angle) * x + std::cos(angle) * y + by[1];
  }
  return mesh;
}

TEST(Grade, MeetsTheSizeRuleOnThePapersSquare) {
  const Mesh base = structured_mesh(16, 16, paper);
  for (const double h0 : {0.2, 0.1}) {
    const Mesh fine = grade(base, {.h0 = h0}, plenty);
    expect_refines(base, fine);
    const auto centres = points(base, tips(base));
    const double worst = testing::worst_size_ratio(fine, centres, h0, 0.2, 1e-13, 1.0);
    EXPECT_LT(worst, sampling);
    // bisection halves areas, so a mesh much finer than asked for would be a waste
    EXPECT_GT(worst, 0.9);
  }
}

TEST(Grade, TakesAQuarterOfTheTrianglesForTwiceTheSize) {
  const Mesh base = structured_mesh(16, 16, paper);
  const auto count = [&](double h0) {
    return static_cast<double>(grade(base, {.h0 = h0}, plenty).triangle_count());
  };
  EXPECT_NEAR(count(0.05) / count(0.1), 4, 0.5);
  EXPECT_LT(count(0.1), 20'000);
}

TEST(Grade, StopsAtTheTipSize) {
  const Mesh base = structured_mesh(16, 16, paper);
  const Mesh fine = grade(base, {.h0 = 0.1, .tip_size = 1e-3}, plenty);
  EXPECT_LT(testing::worst_size_ratio(fine, points(base, tips(base)), 0.1, 0.2, 1e-3, 1.0),
            sampling);
  EXPECT_GT(quality(fine).smallest_diameter, 0.4e-3);
}

TEST(Grade, HalvesARightIsoscelesTriangleExactlyDownToTheSmallestSize) {
  // Coordinates of the base are multiples of 1/8, tips at 0 and at 0.5 and -0.5.
  for (const auto& parts : {paper, std::vector<OnInterface>{{0, 0.5, Kind::delaminated, 0}}}) {
    const Mesh base = structured_mesh(16, 16, parts);
    const Mesh fine = grade(base, {.h0 = 0.2, .tip_size = 1e-13}, plenty);
    expect_refines(base, fine);
    EXPECT_LE(quality(fine).smallest_diameter, 1e-13);
    EXPECT_GT(quality(fine).smallest_diameter, 0.4e-13);
    for (std::size_t t = 0; t < fine.triangle_count(); ++t) {
      std::array<double, 3> squares{};
      for (std::size_t i = 0; i < 3; ++i) {
        const Point a = corner(fine, t, i);
        const Point b = corner(fine, t, (i + 1) % 3);
        squares[i] = (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]);
      }
      std::ranges::sort(squares);
      ASSERT_EQ(squares[0], squares[1]);
      ASSERT_EQ(squares[2], 2 * squares[0]);
    }
  }
}

TEST(Grade, KeepsAnglesAtTheSmallestSizeWhereCoordinatesAreRounded) {
  for (const Point& by : {Point{0, 0}, Point{0.3, 0.1}, Point{1000, -300}}) {
    for (const double angle : {0.3, 1.1}) {
      const Mesh base =
          moved(structured_mesh(10, 10, {{{-0.4, 0.6, Kind::delaminated, 0}}}), angle, by);
      const Mesh fine = grade(base, {.h0 = 0.2}, plenty);
      expect_refines(base, fine);
      EXPECT_LT(quality(fine).smallest_diameter, 1e-9);
      EXPECT_GT(quality(fine).minimum_angle, 0.99 * bisection_bound(base));
      EXPECT_LT(quality(fine).maximum_angle, 91);
    }
  }
}

TEST(Grade, NeverFallsBelowTheBisectionBound) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const Mesh base = perturbed(structured_mesh(8, 8, paper), 0.25, 0.3, seed);
    ASSERT_NO_THROW(validate(base));
    const double bound = bisection_bound(base);
    ASSERT_LE(bound, quality(base).minimum_angle);
    const Mesh fine = grade(base, {.h0 = 0.15, .tip_size = 1e-8}, plenty);
    expect_refines(base, fine);
    EXPECT_GT(quality(fine).minimum_angle, bound * (1 - 1e-6));
    EXPECT_LT(testing::worst_size_ratio(fine, points(base, tips(base)), 0.15, 0.2, 1e-8,
                                        characteristic_length(base)),
              sampling);
  }
}

TEST(Grade, KeepsAnglesOfAPerturbedMeshAtTheSmallestSize) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const Mesh base =
        moved(perturbed(structured_mesh(8, 8, paper), 0.25, 0.25, seed), 0.7, {0.1, 0.2});
    const Mesh fine = grade(base, {.h0 = 0.2}, plenty);
    expect_refines(base, fine);
    EXPECT_GT(quality(fine).minimum_angle, 0.98 * bisection_bound(base));
  }
}

TEST(Grade, ConformsWhereAllEdgesAreOfOneLength) {
  // Equilateral triangles: which edge is the longest is decided by numbers of nodes alone.
  Mesh base = structured_mesh(12, 12, {});
  for (std::size_t n = 0; n < base.node_count(); ++n) {
    base.xy[2 * n] -= 0.5 * base.xy[2 * n + 1];
    base.xy[2 * n + 1] *= 0.5 * std::numbers::sqrt3;
  }
  const std::vector<std::int32_t> corner_of_square{0};
  for (const double h0 : {0.1, 0.03}) {
    const Mesh fine = grade(base, corner_of_square, {.h0 = h0, .tip_size = 1e-6}, plenty);
    expect_refines(base, fine);
    EXPECT_NEAR(quality(fine).minimum_angle, 30, 1e-6);
  }
}

TEST(Grade, KeepsAPartlyDelaminatedInclusionAndItsNeighbour) {
  const std::vector<OnInterface> parts{{-0.75, 0, Kind::inclusion, 0},
                                       {-0.5, -0.25, Kind::delaminated, 0},
                                       {0.25, 0.5, Kind::delaminated, 1},
                                       {0.75, 0.875, Kind::crack, -1}};
  const Mesh base = structured_mesh(16, 8, parts);
  ASSERT_EQ(tips(base).size(), 8U);
  const Mesh fine = grade(base, {.h0 = 0.2}, plenty);
  expect_refines(base, fine);
  EXPECT_LT(testing::worst_size_ratio(fine, points(base, tips(base)), 0.2, 0.2, 1e-13, 1.0),
            sampling);
}

/// One subdomain, a slit of five edges in it.
Mesh slit_mesh() {
  Mesh made = structured_mesh(16, 16, {});
  made.subdomain.assign(made.triangle_count(), 0);
  made.subdomains = {"all"};
  auto& nodes = made.interfaces[0].nodes;
  nodes = std::vector<std::int32_t>(nodes.begin() + 4, nodes.begin() + 10);
  made.interfaces[0].kind.assign(5, Kind::crack);
  made.interfaces[0].inclusion.assign(5, -1);
  return made;
}

/// Columns and rows `low` to `high` of sixteen are a subdomain of their own, the ring around it
/// closed, counterclockwise, delaminated along its lower side.
Mesh ring_mesh(int low, int high) {
  Mesh made = structured_mesh(16, 16, {});
  made.subdomains = {"inside", "outside"};
  made.tension = {2, 0.5};
  made.tension_laws = {{}, {"1 + x", "", 0}};
  made.inclusions = {"rim"};
  made.motions = {{true, {}}};
  for (std::size_t t = 0; t < made.triangle_count(); ++t) {
    const auto cell = static_cast<int>(t / 2);
    const auto within = [&](int i) { return low <= i && i < high; };
    made.subdomain[t] = within(cell % 16) && within(cell / 16) ? 0 : 1;
  }
  Interface ring{"ring", {}, {}, {}};
  const int side = high - low;
  for (int k = 0; k < 4 * side; ++k) {
    const int along = k % side;
    const int i = k < side ? low + along : k < 2 * side ? high : k < 3 * side ? high - along : low;
    const int j = k < side ? low : k < 2 * side ? low + along : k < 3 * side ? high : high - along;
    ring.nodes.push_back(17 * j + i);
    ring.kind.push_back(k < side ? Kind::delaminated : Kind::glue);
    ring.inclusion.push_back(k < side ? 0 : -1);
  }
  ring.nodes.push_back(ring.nodes.front());
  made.interfaces = {ring};
  return made;
}

/// One subdomain of squares 1/16 wide with rows of slits two squares long, four squares between
/// their middles, from the left; and, below them, one as long as asked for.
Mesh many_slits(int rows, int in_a_row, int long_slit) {
  constexpr int n = 32;
  Mesh made = structured_mesh(n, n, {});
  made.subdomain.assign(made.triangle_count(), 0);
  made.subdomains = {"all"};
  made.interfaces.clear();
  const auto add = [&](int column, int row, int length) {
    Interface slit{"slit" + std::to_string(made.interfaces.size()), {}, {}, {}};
    for (int i = 0; i <= length; ++i) slit.nodes.push_back((n + 1) * row + column + i);
    slit.kind.assign(static_cast<std::size_t>(length), Kind::crack);
    slit.inclusion.assign(static_cast<std::size_t>(length), -1);
    made.interfaces.push_back(slit);
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < in_a_row; ++i) add(4 * i + 2, 4 * j + 6, 2);
  if (long_slit > 0) add(2, 2, long_slit);
  return made;
}

/// The rule of `Grading` for that mesh, whose R is 1: all tips but the long slit's two alike.
std::vector<testing::GradedTip> many_tips(const Mesh& base, double h0, double tip_size) {
  std::vector<testing::GradedTip> all;
  const std::vector<std::int32_t> found = tips(base);
  const double share = found.size() > 16 ? 4 / std::sqrt(static_cast<double>(found.size())) : 1;
  for (const std::int32_t node : found) {
    const Interface& last = base.interfaces.back();
    const bool ends_it = node == last.nodes.front() || node == last.nodes.back();
    const double length = ends_it ? static_cast<double>(last.kind.size()) / 16 : 1.0 / 8;
    const double radius = std::min(1.0, std::max(share, length));
    const double end = found.size() > 16 ? 1e-3 * std::pow(h0, 5) / std::pow(radius, 4) : 1e-13;
    all.push_back({testing::point(base, node), radius, tip_size > 0 ? tip_size : end});
  }
  return all;
}

TEST(Grade, MeetsTheSizeRuleOfEveryTipWhereThereAreMany) {
  struct Case {
    int rows, in_a_row, long_slit;
    double h0, tip_size;
  };
  for (const Case& c : {Case{2, 4, 0, 0.2, 0}, Case{3, 3, 0, 0.2, 0}, Case{6, 7, 24, 0.1, 0},
                        Case{6, 7, 28, 0.2, 1e-6}}) {
    SCOPED_TRACE(c.rows * c.in_a_row);
    const Mesh base = many_slits(c.rows, c.in_a_row, c.long_slit);
    const auto all = many_tips(base, c.h0, c.tip_size);
    const Mesh fine = grade(base, {.h0 = c.h0, .tip_size = c.tip_size}, plenty);
    expect_refines(base, fine);
    const double worst = testing::worst_size_ratio(fine, all, c.h0, 0.2);
    EXPECT_LT(worst, sampling);
    EXPECT_GT(worst, 0.9);
    const double least = std::ranges::min_element(all, {}, &testing::GradedTip::tip_size)->tip_size;
    EXPECT_GT(quality(fine).smallest_diameter, 0.4 * least);
    EXPECT_EQ(grade(base, {.h0 = c.h0, .tip_size = c.tip_size}, plenty).xy, fine.xy);
  }
}

TEST(Grade, OfManyTipsDoesNotReachOverTheMembrane) {
  const Mesh base = many_slits(6, 3, 0);  // in the left half
  const double h0 = 0.04;
  const auto all = many_tips(base, h0, 0);
  ASSERT_EQ(all.size(), 36U);
  const Mesh fine = grade(base, {.h0 = h0}, plenty);
  double least_far = h0;
  for (std::size_t t = 0; t < fine.triangle_count(); ++t) {
    const bool far = std::ranges::all_of(all, [&](const testing::GradedTip& tip) {
      return testing::distance(corner(fine, t, 0), tip.at) > tip.radius + 2 * h0;
    });
    if (far) least_far = std::min(least_far, testing::diameter(fine, t));
  }
  EXPECT_LT(least_far, h0);  // some are far
  EXPECT_GT(least_far, h0 / 2);
}

TEST(Grade, TakesNoDefaultTipSizeBelowTheOneAskedFor) {
  for (const int rows : {2, 6}) {
    const Mesh base = many_slits(rows, 4, 0);
    const Mesh fine = grade(base, {.h0 = 0.2, .least_tip_size = 1e-3}, plenty);
    EXPECT_EQ(fine.xy, grade(base, {.h0 = 0.2, .tip_size = 1e-3}, plenty).xy);
  }
}

TEST(Grade, ConformsAcrossASlitInOneSubdomain) {
  const Mesh base = slit_mesh();
  const Mesh fine = grade(base, {.h0 = 0.2}, plenty);
  expect_refines(base, fine);
  EXPECT_GT(fine.interfaces[0].kind.size(), 100U);
}

TEST(Grade, ReachesTheTipOfASlitAtTheNeumannBoundary) {
  Mesh base = structured_mesh(16, 16, {});
  base.subdomain.assign(base.triangle_count(), 0);
  base.subdomains = {"all"};
  Interface& slit = base.interfaces[0];
  slit.nodes.resize(9);  // from the left side to the centre
  slit.kind.assign(8, Kind::crack);
  slit.inclusion.assign(8, -1);
  std::erase_if(base.dirichlet, [&](const auto& edge) {
    return testing::point(base, edge[0])[0] == -1 && testing::point(base, edge[1])[0] == -1;
  });
  const Mesh fine = grade(base, {.h0 = 0.2}, plenty);
  expect_refines(base, fine);
  EXPECT_EQ(tips(fine), std::vector<std::int32_t>{slit.nodes.back()});
  EXPECT_LE(quality(fine).smallest_diameter, 1e-13);
}

TEST(Grade, KeepsARingClosedAndTheTensionInside) {
  const Mesh base = ring_mesh(5, 11);
  ASSERT_EQ(tips(base).size(), 2U);
  const Mesh fine = grade(base, {.h0 = 0.2}, plenty);
  expect_refines(base, fine);
  EXPECT_EQ(fine.interfaces[0].nodes.front(), fine.interfaces[0].nodes.back());
}

TEST(Grade, ConformsWhereInterfacesCross) {
  Mesh base = structured_mesh(16, 16, paper);
  Interface upright{"upright", {}, {}, {}};
  for (int j = 0; j <= 16; ++j) {
    upright.nodes.push_back(17 * j + 6);
    if (j == 16) break;
    upright.kind.push_back(j >= 8 && j < 12 ? Kind::crack : Kind::glue);
    upright.inclusion.push_back(-1);
  }
  base.interfaces.push_back(upright);
  base.subdomains = {"sw", "nw", "se", "ne"};
  for (std::size_t t = 0; t < base.triangle_count(); ++t) {
    if (t / 2 % 16 >= 6) base.subdomain[t] += 2;
  }
  const std::int32_t crossing = 17 * 8 + 6;
  const std::vector<std::int32_t> found = tips(base);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_TRUE(std::ranges::find(found, crossing) != found.end());
  const Mesh fine = grade(base, {.h0 = 0.2}, plenty);
  expect_refines(base, fine);
  EXPECT_LT(testing::worst_size_ratio(fine, points(base, found), 0.2, 0.2, 1e-13, 1.0), sampling);
}

TEST(Grade, DoesNotDependOnTheUnitOfLength) {
  const Mesh base = perturbed(structured_mesh(8, 8, paper), 0.25, 0.3, 7);
  const Mesh fine = grade(base, {.h0 = 0.2, .tip_size = 1e-6}, plenty);
  // powers of four have exact roots, so the two runs round alike
  for (const double unit : {1024.0 * 1024.0, 1.0 / 4096.0}) {
    Mesh scaled = base;
    for (double& value : scaled.xy) value *= unit;
    const Mesh other = grade(scaled, {.h0 = 0.2 * unit, .tip_size = 1e-6 * unit}, plenty);
    EXPECT_EQ(other.triangles, fine.triangles);
    std::vector<double> xy = fine.xy;
    for (double& value : xy) value *= unit;
    EXPECT_EQ(other.xy, xy);
  }
}

TEST(Grade, GivesTheSameBitsTwice) {
  const Mesh base = perturbed(structured_mesh(8, 8, paper), 0.25, 0.3, 11);
  const Mesh first = grade(base, {.h0 = 0.1}, plenty);
  const Mesh second = grade(base, {.h0 = 0.1}, plenty);
  EXPECT_EQ(first.xy, second.xy);
  EXPECT_EQ(first.triangles, second.triangles);
  EXPECT_EQ(first.subdomain, second.subdomain);
  EXPECT_EQ(first.dirichlet, second.dirichlet);
  EXPECT_EQ(first.interfaces[0].nodes, second.interfaces[0].nodes);
}

TEST(Grade, LeavesAMeshThatIsFineEnoughAlone) {
  const Mesh base = structured_mesh(16, 16, paper);
  const Mesh same = grade(base, {.h0 = 1, .m = 1}, plenty);
  EXPECT_EQ(same.xy, base.xy);
  EXPECT_EQ(same.triangle_count(), base.triangle_count());
  expect_refines(base, same);
}

TEST(Grade, WithoutATipOrWithMOneIsUniform) {
  const Mesh plain = structured_mesh(16, 16, {});
  const Mesh cracked = structured_mesh(16, 16, paper);
  const Mesh fine = grade(plain, {.h0 = 0.05}, plenty);
  EXPECT_EQ(grade(cracked, {.h0 = 0.05, .m = 1}, plenty).triangles, fine.triangles);
  // diagonals of sqrt(2)/8 are halved twice, to sqrt(2)/32: four bisections of every triangle
  EXPECT_EQ(fine.triangle_count(), 16 * plain.triangle_count());
}

TEST(Grade, GoesTowardsTheNodesItIsGiven) {
  const Mesh base = structured_mesh(16, 16, {});
  const std::vector<std::int32_t> corners{0, 16};
  const Mesh fine = grade(base, corners, {.h0 = 0.2}, plenty);
  expect_refines(base, fine);
  EXPECT_LT(testing::worst_size_ratio(fine, points(base, corners), 0.2, 0.2, 1e-13, 1.0), sampling);
  EXPECT_GT(fine.triangle_count(), base.triangle_count() + 500);
}

TEST(Grade, FindsTipsThatLieAboveOneAnother) {
  // the square turned by a right angle, so the tips differ in y
  const Mesh base = moved(structured_mesh(16, 16, paper), std::numbers::pi / 2, {0, 0});
  const Mesh fine = grade(base, {.h0 = 0.2}, plenty);
  EXPECT_LT(testing::worst_size_ratio(fine, points(base, tips(base)), 0.2, 0.2, 1e-13, 1.0),
            sampling);
}

}  // namespace
}  // namespace anticrack::mesh
