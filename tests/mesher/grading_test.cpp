// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/grading.hpp"

#include <gmock/gmock.h>

#include "mesh/quality.hpp"
#include "mesh/refine.hpp"
#include "mesh/refinement_mesh.hpp"
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

TEST(Grading, GivesTheSameMeshTwice) {
  const auto made = [] { return graded(base(), options(mesh::Preset::graded, 0.1), plenty); };
  EXPECT_EQ(made().xy, made().xy);
  EXPECT_EQ(made().triangles, made().triangles);
}

}  // namespace
}  // namespace anticrack::mesher
