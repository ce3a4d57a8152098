// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of the energy against what finer and finer meshes lead to.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "accuracy/base_meshes.hpp"
#include "accuracy/error_norms.hpp"
#include "accuracy/paper_limits.hpp"
#include "accuracy/sequence.hpp"
#include "mesh/refine.hpp"
#include "support/silent_observer.hpp"

namespace anticrack::accuracy {
namespace {

struct Bounded {
  contact::Answer answer;
  std::vector<double> indicator;
};

Bounded solve_bounded(const operators::MeshOperator& op, const fem::Load& load) {
  const fem::Load* const one[] = {&load};
  const auto prepared = std::get<operators::PreparedLoad>(std::move(op.prepare(one).front()));
  testing::Silent silent;
  Bounded result{op.solve(prepared, {}, true, silent), {}};
  result.indicator = op.estimate(prepared, result.answer);
  return result;
}

TEST(Bracket, ContainsTheEnergyOfThePaperExamples) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (double h0 = 0.4; h0 > 0.02; h0 /= 2) {
      const auto op = factorise(mesh::grade(diagonals(), {h0, 0.2, 0}, 2'000'000));
      fem::Load load;
      load.force = fem::Expression{paper_forces[i]};
      const Bounded found = solve_bounded(*op, load);
      const contact::Answer& answer = found.answer;
      ASSERT_EQ(answer.no_bracket, "");
      const double limit = energy_limits[i];
      std::printf(
          "[ figures  ] example %zu, %7zu triangles: [%.7f, %.7f], limit %.6f; gap over error "
          "%.2f, error %.4f\n",
          i + 1, op->mesh().triangle_count(), *answer.energy_lower, *answer.energy_upper, limit,
          (*answer.energy_upper - *answer.energy_lower) / (*answer.energy_upper - limit),
          *answer.error_bound_relative);
      EXPECT_LT(*answer.energy_lower, limit);
      EXPECT_GT(*answer.energy_upper, limit);
      const contact::InclusionAnswer& inclusion = answer.inclusions.front();
      ASSERT_TRUE(inclusion.displacement_lower && inclusion.displacement_upper);
      std::printf("[ figures  ] A %.7f in [%.7f, %.7f], limit %.7f; half over error %.2f, estimate over error %.2f\n",
                  inclusion.displacement, *inclusion.displacement_lower,
                  *inclusion.displacement_upper, a_limits[i],
                  (*inclusion.displacement_upper - *inclusion.displacement_lower) / 2 /
                      std::abs(inclusion.displacement - a_limits[i]),
                  inclusion.displacement_estimated_error.value_or(NAN) /
                      (a_limits[i] - inclusion.displacement));
      EXPECT_LT(*inclusion.displacement_lower, a_limits[i]);
      EXPECT_GT(*inclusion.displacement_upper, a_limits[i]);
    }
  }
}

/// Bounds over true errors in the energy norm.
void check_effectivity(const char* title, mesh::Kind kind, const testing::ExactSolution& exact) {
  for (double h0 = 0.4; h0 > 0.02; h0 /= 2) {
    const auto op = factorise(mesh::grade(diagonals(kind), {h0, 0.2, 0}, 2'000'000));
    fem::Load load;
    load.boundary_value = exact.boundary;
    const Bounded found = solve_bounded(*op, load);
    const contact::Answer& answer = found.answer;
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
  const Bounded found = solve_bounded(*op, load);
  ASSERT_EQ(found.answer.no_bracket, "");
  EXPECT_LT(*found.answer.energy_upper - *found.answer.energy_lower,
            1e-11 * std::abs(found.answer.energy));
}

}  // namespace
}  // namespace anticrack::accuracy
