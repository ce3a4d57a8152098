// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/grading.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "mesh/edges.hpp"
#include "mesh/quality.hpp"
#include "mesh/refine.hpp"
#include "mesh/refinement_mesh.hpp"
#include "mesher/real_helper.hpp"
#include "support/errors.hpp"
#include "support/mesh_quality.hpp"

namespace anticrack::mesher {
namespace {

using errors::Reason;
using testing::error_of;
using ::testing::HasSubstr;
using testing::OnInterface;
using testing::structured_mesh;
using testing::throws;

constexpr std::size_t plenty = 1'000'000;
const std::vector<OnInterface> paper{{-0.5, 0.5, mesh::Kind::delaminated, 0}};

mesh::MeshOptions options(mesh::Preset preset, double size = 0) {
  mesh::MeshOptions made;
  made.preset = preset;
  made.size = size;
  return made;
}

mesh::Mesh base() { return structured_mesh(16, 16, paper); }

/// The paper's square with its left half pressed to needles of four degrees.
mesh::Mesh needles() { return structured_mesh(16, 16, paper, {-1, 1, -0.07, 0.07}); }

TEST(Grading, OfAnUploadStartsFromItsLongestEdge) {
  const mesh::Mesh fine = graded(base(), options(mesh::Preset::graded), plenty);
  EXPECT_GT(fine.triangle_count(), base().triangle_count());
  EXPECT_LE(mesh::quality(fine).smallest_diameter, 1e-13);
  // far from the tips one bisection at most, also those that others ask for
  EXPECT_GE(mesh::quality(fine).largest_diameter, mesh::quality(base()).largest_diameter / 2);
  EXPECT_NEAR(fine.bisection_bound, 45, 1e-9);
}

/// T+ = T-/4: the exponent at the ends is arctan(1/2)/pi, and m is 0.8 of it; with T+ = 4 T- the
/// exponent is above 1/4. A grading that is asked for stays.
TEST(Grading, StaysBelowTheExponentOfUnequalTensions) {
  const auto triangles = [](double below, double above, double m) {
    mesh::Mesh mesh = base();
    mesh.tension = {below, above};
    mesh::MeshOptions chosen = options(mesh::Preset::graded);
    chosen.grading = m;
    return graded(std::move(mesh), chosen, plenty).triangles;
  };
  const double unset = mesh::MeshOptions().grading;
  const double exponent = std::atan(0.5) / std::numbers::pi;
  EXPECT_EQ(triangles(1, 0.25, unset), triangles(1, 1, 0.8 * exponent));
  EXPECT_EQ(triangles(1, 4, unset), triangles(1, 1, unset));
  EXPECT_EQ(triangles(1, 0.25, 0.19), triangles(1, 1, 0.19));
  EXPECT_NE(triangles(1, 0.25, unset), triangles(1, 1, unset));
}

TEST(Grading, UniformWithoutASizeLeavesTheMeshAlone) {
  const mesh::Mesh same = graded(base(), options(mesh::Preset::uniform), plenty);
  EXPECT_EQ(same.triangles, base().triangles);
  EXPECT_EQ(same.bisection_bound, 0);
}

TEST(Grading, UniformWithASizeHasNoLongerEdgeAndNoTips) {
  const mesh::Mesh fine = graded(base(), options(mesh::Preset::uniform, 0.1), plenty);
  EXPECT_LE(mesh::quality(fine).largest_diameter, 0.1);
  EXPECT_GT(mesh::quality(fine).smallest_diameter, 0.05);
  EXPECT_GT(fine.bisection_bound, 44);
}

TEST(Grading, RefusesTooManyTrianglesAndNamesTheOptions) {
  const auto error = error_of([] { graded(base(), options(mesh::Preset::graded, 0.01), 100'000); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::limit_exceeded);
  ASSERT_EQ(error->fields().size(), 2U);
  EXPECT_EQ(error->fields()[0].field, "options.size");
  EXPECT_EQ(error->fields()[1].field, "options.tip_size");
  EXPECT_THAT(error->what(), HasSubstr("raise options.size"));
  EXPECT_TRUE(throws([] { graded(base(), options(mesh::Preset::uniform, 0.001), 100'000); },
                     Reason::limit_exceeded, "options.size"));
}

TEST(Grading, NamesOptionsThatAreNoSizes) {
  mesh::MeshOptions bad = options(mesh::Preset::graded, 0.1);
  bad.tip_size = 1e-15;
  EXPECT_TRUE(
      throws([&] { graded(base(), bad, plenty); }, Reason::invalid_argument, "options.tip_size"));
  bad.tip_size = 0;
  bad.grading = 2;
  EXPECT_TRUE(
      throws([&] { graded(base(), bad, plenty); }, Reason::invalid_argument, "options.grading"));
  EXPECT_TRUE(throws([] { graded(base(), options(mesh::Preset::graded, 1e-15), plenty); },
                     Reason::invalid_argument, "options.size"));
}

TEST(Grading, StopsEarlierWhereTheBaseHasNeedles) {
  const double bound = mesh::bisection_bound(needles());
  ASSERT_LT(bound, 5);
  const mesh::Mesh fine = graded(needles(), options(mesh::Preset::graded), plenty);
  EXPECT_GE(mesh::minimum_angle(fine), bound * 0.95);
  const double least = mesh::smallest_tip_size(needles(), mesh::tips(needles()));
  mesh::MeshOptions bad = options(mesh::Preset::graded);
  bad.tip_size = 1.01 * least;
  EXPECT_TRUE(throws([&] { graded(needles(), bad, plenty); }, Reason::invalid_argument,
                     "options.tip_size"));
}

/// Fibres in cells of the unit square, half as long as a cell is wide, turned and shifted within.
mesh::Geometry fibres(int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto draw = [&] { return random() / 4294967296.0; };
  const int rows = static_cast<int>(std::ceil(std::sqrt(count)));
  mesh::Geometry geometry;
  geometry.boundary = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int k = 0; k < count; ++k) {
    const double x = (k % rows + 0.35 + 0.3 * draw()) / rows;
    const double y = (k / rows + 0.35 + 0.3 * draw()) / rows;
    const double angle = std::numbers::pi * draw();
    const double dx = 0.25 * std::cos(angle) / rows;
    const double dy = 0.25 * std::sin(angle) / rows;
    const mesh::Part part{{x - dx, y - dy}, {x + dx, y + dy}};
    const std::string name = "fibre" + std::to_string(k);
    geometry.interfaces.push_back({name, mesh::Shape::polyline, {part.from, part.to}});
    geometry.inclusions.push_back({name, part, {part}});
  }
  return geometry;
}

TEST(Grading, OfManyFibresByDefaultResolvesEachAndNoMore) {
  const struct {
    int fibres;
    std::size_t most;
  } cases[] = {{100, 250'000}, {1'000, 1'500'000}};
  for (const auto& [count, most] : cases) {
    SCOPED_TRACE(count);
    const mesh::GenerateRequest request{mesh::plan(fibres(count, 3), {}, most), most};
    const mesh::Mesh fine = run(testing::real_helper(), request, {});
    EXPECT_GT(mesh::minimum_angle(fine), 15);
    ASSERT_EQ(fine.interfaces.size(), static_cast<std::size_t>(count));
    for (const mesh::Interface& fibre : fine.interfaces) {
      const std::vector<double> s = mesh::arc_length(fine, fibre);
      const auto away = std::ranges::count_if(
          s, [&](double at) { return 0.01 * s.back() < at && at < 0.99 * s.back(); });
      ASSERT_GE(away, 16);
      for (const double edge : {s[1], s.back() - s[s.size() - 2]}) ASSERT_LT(edge, 1e-4 * s.back());
    }
  }
}

TEST(Grading, GivesTheSameMeshTwice) {
  const auto made = [] { return graded(base(), options(mesh::Preset::graded, 0.1), plenty); };
  EXPECT_EQ(made().xy, made().xy);
  EXPECT_EQ(made().triangles, made().triangles);
}

}  // namespace
}  // namespace anticrack::mesher
