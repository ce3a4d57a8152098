// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of the energy against what finer and finer meshes lead to.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>

#include "accuracy/base_meshes.hpp"
#include "accuracy/error_norms.hpp"
#include "accuracy/paper_limits.hpp"
#include "accuracy/sequence.hpp"
#include "mesh/refine.hpp"

namespace anticrack::accuracy {
namespace {

void check_example(std::size_t i, const operators::MeshOperator& op) {
  fem::Load load;
  load.force = fem::Expression{paper_forces[i]};
  const contact::Answer answer = solve_bounded(op, load);
  ASSERT_EQ(answer.no_bracket, "");
  const double limit = energy_limits[i];
  std::printf(
      "[ figures  ] example %zu, %7zu triangles: [%.7f, %.7f], limit %.6f; gap over error %.2f, "
      "error %.4f\n",
      i + 1, op.mesh().triangle_count(), *answer.energy_lower, *answer.energy_upper, limit,
      (*answer.energy_upper - *answer.energy_lower) / (*answer.energy_upper - limit),
      *answer.error_bound_relative);
  EXPECT_LT(*answer.energy_lower, limit);
  EXPECT_GT(*answer.energy_upper, limit);
  const contact::InclusionAnswer& inclusion = answer.inclusions.front();
  ASSERT_TRUE(inclusion.displacement_lower && inclusion.displacement_upper);
  const double lower = *inclusion.displacement_lower, upper = *inclusion.displacement_upper;
  std::printf(
      "[ figures  ] A %.7f in [%.7f, %.7f], limit %.7f; half over error %.2f, estimate over error "
      "%.2f\n",
      inclusion.displacement_mesh, lower, upper, a_limits[i],
      (upper - lower) / 2 / std::abs(inclusion.displacement_mesh - a_limits[i]),
      inclusion.displacement_estimated_error.value_or(NAN) /
          (a_limits[i] - inclusion.displacement_mesh));
  EXPECT_LT(lower, a_limits[i]);
  EXPECT_GT(upper, a_limits[i]);
  EXPECT_EQ(inclusion.displacement, lower + 0.5 * (upper - lower));
  EXPECT_EQ(answer.energy,
            *answer.energy_lower + 0.5 * (*answer.energy_upper - *answer.energy_lower));
  EXPECT_GT(inclusion.displacement_scale.value_or(0), std::abs(inclusion.displacement_mesh));
}

TEST(Bracket, HasAScaleOfAThatHardlyDependsOnTheMesh) {
  std::vector<double> scales;
  for (const double h0 : {0.2, 0.1, 0.05}) {
    const auto op = factorise(mesh::grade(diagonals(), {h0, 0.2, 0}, 2'000'000));
    fem::Load load;
    load.force = fem::Expression{"x"};  // odd, so that A is 0
    scales.push_back(solve_bounded(*op, load).inclusions[0].displacement_scale.value_or(0));
    std::printf("[ figures  ] h0 %g: scale of A %.5f\n", h0, scales.back());
    EXPECT_NEAR(scales.back(), scales.front(), 0.02 * scales.front());
  }
  EXPECT_GT(scales.back(), 0);
}

TEST(Bracket, ContainsTheEnergyAndAOfThePaperExamples) {
  for (double h0 = 0.4; h0 > 0.02; h0 /= 2) {
    const auto op = factorise(mesh::grade(diagonals(), {h0, 0.2, 0}, 2'000'000));
    for (std::size_t i = 0; i < 4; ++i) check_example(i, *op);
  }
}

TEST(Bracket, ContainsThemOnTheMeshesOfThePresets) {
  using mesh::Preset;
  for (const Preset preset : {Preset::graded, Preset::coarse, Preset::paper, Preset::uniform}) {
    mesh::MeshOptions options;
    options.preset = preset;
    mesh::Mesh mesh = generated(options);
    for (int refined = 0; refined < 3; ++refined) {
      const auto op = factorise(mesh);
      for (std::size_t i = 0; i < 4; ++i) check_example(i, *op);
      mesh = mesh::refine(mesh, std::vector<std::uint8_t>(mesh.triangle_count(), 2), 2'000'000);
    }
  }
}

TEST(Bracket, OfAJoinedMembraneIsAsCloseAsOfDenseMatrices) {
  const auto mesh =
      std::make_shared<const mesh::Mesh>(mesh::grade(diagonals(), {0.05, 0.2, 0}, 2'000'000));
  const auto dense = operators::MeshOperator::factorise(mesh, 2, {});
  const auto joined = operators::MeshOperator::factorise(mesh, 2, {}, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    check_example(i, *joined);
    fem::Load load;
    load.force = fem::Expression{paper_forces[i]};
    const auto of_dense = solve_bounded(*dense, load), of_joined = solve_bounded(*joined, load);
    const contact::InclusionAnswer &one = of_dense.inclusions[0], &other = of_joined.inclusions[0];
    const auto width = [](const contact::InclusionAnswer& of) {
      return *of.displacement_upper - *of.displacement_lower;
    };
    EXPECT_NEAR(width(other), width(one), 0.1 * width(one)) << "but for signs of rounding";
    EXPECT_TRUE(other.displacement_estimated_error) << "by the adjoint";
  }
}

TEST(Bracket, OfAMirroredMembraneIsTheSameButForTheOrderOfTheFans) {
  const mesh::Mesh mesh = mesh::grade(shaken(11), {0.2, 0.2, 0}, 2'000'000);
  fem::Load load;
  load.force = fem::Expression{"1 - 2*x + (y > 0 ? 3 : -3)"};
  const contact::Answer answer = solve_bounded(*factorise(mesh), load);
  load.force = fem::Expression{"1 + 2*x + (y > 0 ? 3 : -3)"};
  const contact::Answer in_x = solve_bounded(*factorise(mirrored(mesh, Mirror::x)), load);
  load.force = fem::Expression{"1 - 2*x + (y < 0 ? 3 : -3)"};
  const contact::Answer in_y = solve_bounded(*factorise(mirrored(mesh, Mirror::y)), load);
  for (const contact::Answer* image : {&in_x, &in_y}) {
    const double gap = *answer.energy_upper - *answer.energy_lower;
    EXPECT_NEAR(*image->energy_lower, *answer.energy_lower, 0.02 * gap);
    EXPECT_NEAR(*image->energy_upper, *answer.energy_upper, 1e-9 * gap);
    const contact::InclusionAnswer &one = answer.inclusions[0], &other = image->inclusions[0];
    const double width = *one.displacement_upper - *one.displacement_lower;
    EXPECT_NEAR(*other.displacement_lower, *one.displacement_lower, 0.15 * width);
    EXPECT_NEAR(*other.displacement_upper, *one.displacement_upper, 0.15 * width);
  }
}

/// Bounds over true errors in the energy norm.
void check_effectivity(const char* title, mesh::Kind kind, const testing::ExactSolution& exact) {
  for (double h0 = 0.4; h0 > 0.02; h0 /= 2) {
    const auto op = factorise(mesh::grade(diagonals(kind), {h0, 0.2, 0}, 2'000'000));
    fem::Load load;
    load.boundary_value = exact.boundary;
    const contact::Answer answer = solve_bounded(*op, load);
    ASSERT_EQ(answer.no_bracket, "");
    const double error = energy_error(op->mesh(), answer, exact);
    std::printf("[ figures  ] %s, %7zu triangles: error %.3e, bound %.3e, %.2f times\n", title,
                op->mesh().triangle_count(), error, *answer.error_bound,
                *answer.error_bound / error);
    EXPECT_GT(*answer.error_bound, error);
    EXPECT_LT(*answer.error_bound, 2 * error);
  }
}

TEST(Bracket, IsWithinTwiceTheErrorOfExactSolutions) {
  check_effectivity("open inclusion", mesh::Kind::delaminated, testing::open_inclusion(0.3));
  check_effectivity("open crack", mesh::Kind::crack, testing::open_crack(0.8));
}

TEST(Bracket, OfALinearSolutionIsRounding) {
  const auto op = factorise(diagonals());
  fem::Load load;
  load.boundary_value = testing::closed_crack(0.7, 0.3).boundary;
  const contact::Answer answer = solve_bounded(*op, load);
  ASSERT_EQ(answer.no_bracket, "");
  EXPECT_LT(*answer.energy_upper - *answer.energy_lower, 1e-11 * std::abs(answer.energy));
}

/// A membrane with laws of tension and a g_D that edges cannot follow, rotated by so many degrees.
contact::Answer rotated(double degrees) {
  mesh::Mesh mesh = mesh::grade(diagonals(), {0.2, 0.2, 0}, 2'000'000);
  const double c = std::cos(degrees * std::numbers::pi / 180),
               s = std::sin(degrees * std::numbers::pi / 180);
  for (std::size_t i = 0; i < mesh.xy.size(); i += 2) {
    const double x = mesh.xy[i], y = mesh.xy[i + 1];
    mesh.xy[i] = c * x - s * y;
    mesh.xy[i + 1] = s * x + c * y;
  }
  const std::string x = fmt::format("({:.17g}*x + {:.17g}*y)", c, s),
                    y = fmt::format("({:.17g}*y - {:.17g}*x)", c, s);
  mesh.tension_laws = {{"2 + " + x, "0.5", 20 + degrees}, {"1 + " + x + "*" + x, "", 0}};
  fem::Load load;
  load.force = fem::Expression{"3*sin(2*" + x + ") - 1"};
  load.boundary_value = x + "*" + x + "*" + y;
  return solve_bounded(*factorise(std::move(mesh)), load);
}

TEST(Bracket, OfARotatedMembraneWithLawsIsTheSame) {
  const contact::Answer one = rotated(0), other = rotated(40);
  ASSERT_EQ(one.no_bracket, "");
  const double gap = *one.energy_upper - *one.energy_lower;
  EXPECT_GT(gap, 1e-4);
  EXPECT_NEAR(*other.energy_lower, *one.energy_lower,
              0.15 * gap);  // laws are enclosed over boxes along the axes
  EXPECT_NEAR(*other.energy_upper, *one.energy_upper, 0.02 * gap);
  const contact::InclusionAnswer &of_one = one.inclusions[0], &of_other = other.inclusions[0];
  const double width = *of_one.displacement_upper - *of_one.displacement_lower;
  EXPECT_NEAR(of_other.displacement_mesh, of_one.displacement_mesh, 1e-9);
  EXPECT_NEAR(*of_other.displacement_lower, *of_one.displacement_lower, 0.15 * width);
  EXPECT_NEAR(*of_other.displacement_upper, *of_one.displacement_upper, 0.15 * width);
}

TEST(Bracket, IsNotGivenForBoundaryValuesOfInfiniteEnergy) {
  for (const char* jump : {"x > 0.3 ? 1 : 0", "x < -0.5 ? 0 : 1", "sqrt(abs(x))"}) {
    fem::Load load;
    load.boundary_value = jump;
    EXPECT_NE(solve_bounded(*factorise(diagonals()), load).no_bracket, "") << jump;
  }
  for (const char* smooth : {"abs(x - 0.3)", "sin(6*x)*y", "exp(x)", "x*x*x"}) {
    fem::Load load;
    load.boundary_value = smooth;
    EXPECT_EQ(solve_bounded(*factorise(diagonals()), load).no_bracket, "") << smooth;
  }
}

}  // namespace
}  // namespace anticrack::accuracy
