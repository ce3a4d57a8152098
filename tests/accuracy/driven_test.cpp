// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whatever drives a membrane, alone, residuals are relative to it and there are bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "accuracy/base_meshes.hpp"
#include "accuracy/sequence.hpp"
#include "contact/sweep_columns.hpp"
#include "errors/errors.hpp"
#include "mesh/refine.hpp"
#include "support/paths.hpp"

namespace anticrack::accuracy {
namespace {

struct Driven {
  std::string what;
  fem::Load load;
  mesh::Motion motion{};
  bool without_dirichlet = false;
};

fem::Load loaded_by(const std::function<void(fem::Load&)>& set) {
  fem::Load load;
  load.name = "case";
  set(load);
  return load;
}

fem::Load no_load() {
  return loaded_by([](fem::Load&) {});
}
fem::Load by_force(const std::string& force) {
  return loaded_by([&](fem::Load& load) { load.force = fem::Expression{force}; });
}
fem::Load by_boundary(const std::string& value) {
  return loaded_by([&](fem::Load& load) { load.boundary_value = value; });
}

std::vector<Driven> driven_cases() {
  std::vector<Driven> cases{
      {"nothing", no_load()},
      {"a held value", no_load(), {false, 0.1}},
      {"a negative held value", no_load(), {false, -0.1}},
      {"a held value and nothing else", no_load(), {false, 0.1}, true},
      {"a tiny held value", no_load(), {false, 1e-30}},
      {"a large held value", no_load(), {false, 1e30}},
      {"a held value of 0", no_load(), {false, 0.0}},
      {"boundary values", by_boundary("0.3 - x + 2*y")},
      {"one boundary value", by_boundary("0.25")},
      {"the same boundary value as is held", by_boundary("0.1"), {false, 0.1}},
      {"opening boundary values", by_boundary("y")},
      {"closing boundary values", by_boundary("-y")},
      {"an opening load", by_force("y > 0 ? 1 : -1")},
      {"a closing load", by_force("y > 0 ? -1 : 1")},
      {"a load that cancels in all", by_force("sin(_pi*x)")},
      {"a load of 1e-100", by_force("1e-100*(1 + y)")},
      {"a load of 1e100", by_force("1e100*(1 + y)")},
      {"a force", loaded_by([](fem::Load& load) { load.inclusion_forces["rigid"] = 1; })},
      {"a moment",
       loaded_by([](fem::Load& load) {
         load.inclusion_moments["rigid"] = {1, 0};
       }),
       {true, {}}},
      {"forces that cancel", loaded_by([](fem::Load& load) {
         load.inclusion_forces["rigid"] = 1e8;
         load.force = fem::Expression{"1e-8"};
       })},
  };
  for (const char* f : {"1e-300", "1e-30", "1e-10", "1e-6", "1e-3"})
    cases.push_back({"a held value and f = " + std::string(f), by_force(f), {false, 0.1}});
  return cases;
}

mesh::Mesh driven_mesh(const Driven& driven) {
  mesh::Mesh mesh = mesh::grade(diagonals(), {0.2, 0.2, 0}, 2'000'000);
  for (std::string& name : mesh.inclusions) name = "rigid";
  mesh.motions.assign(mesh.inclusions.size(), driven.motion);
  if (driven.without_dirichlet) mesh.dirichlet.clear();
  return mesh;
}

void check_driven(const Driven& driven, std::size_t condensed_up_to) {
  SCOPED_TRACE(driven.what + (", " + std::string(testing::path_name(condensed_up_to))));
  const auto op = factorise(driven_mesh(driven), condensed_up_to);
  const contact::Answer answer = solve_bounded(*op, driven.load);
  ASSERT_EQ(answer.status, contact::Status::converged) << answer.reason;
  const contact::KktResiduals& kkt = answer.kkt_relative;
  for (const double one : {kkt.equilibrium, kkt.gap, kkt.sign, kkt.complementarity})
    EXPECT_LE(one, 1e-10);
  ASSERT_EQ(answer.no_bracket, "");
  EXPECT_LE(*answer.energy_lower, answer.energy_mesh);
  EXPECT_GE(*answer.energy_upper, answer.energy_mesh);
  const double size = std::abs(*answer.energy_upper) + std::abs(*answer.energy_lower);
  EXPECT_LE(*answer.energy_upper - *answer.energy_lower, 0.7 * size + 1e-12);
  ASSERT_TRUE(answer.inclusions[0].displacement_lower);
  EXPECT_LE(*answer.inclusions[0].displacement_lower, answer.inclusions[0].displacement_mesh);
  EXPECT_GE(*answer.inclusions[0].displacement_upper, answer.inclusions[0].displacement_mesh);
}

TEST(Driven, ByAnythingAloneItConvergesWithBounds) {
  for (const Driven& driven : driven_cases())
    for (const std::size_t condensed_up_to :
         {operators::default_condensed_up_to, std::size_t{0}, std::size_t{1}})
      check_driven(driven, condensed_up_to);
}

TEST(Driven, ByNothingItStaysAtZero) {
  for (const std::size_t condensed_up_to :
       {operators::default_condensed_up_to, std::size_t{0}, std::size_t{1}}) {
    const auto op = factorise(driven_mesh({"nothing", no_load()}), condensed_up_to);
    const contact::Answer answer = solve_bounded(*op, no_load());
    EXPECT_EQ(answer.energy, 0);
    EXPECT_EQ(*answer.energy_lower, 0);
    EXPECT_EQ(*answer.energy_upper, 0);
    EXPECT_EQ(*answer.inclusions[0].displacement_lower, 0);
    EXPECT_EQ(*answer.inclusions[0].displacement_upper, 0);
  }
}

TEST(Driven, ByWhatHasNoSquareItHasNoBounds) {
  for (const std::size_t condensed_up_to :
       {operators::default_condensed_up_to, std::size_t{0}, std::size_t{1}}) {
    const auto op = factorise(driven_mesh({"little", no_load()}), condensed_up_to);
    const contact::Answer answer = solve_bounded(*op, by_force("1e-300*(1 + y)"));
    EXPECT_EQ(answer.status, contact::Status::converged) << answer.reason;
    EXPECT_NE(answer.no_bracket.find("scale the load up"), std::string::npos) << answer.no_bracket;
    EXPECT_FALSE(answer.energy_lower);
    EXPECT_THROW(solve_bounded(*op, by_force("1e300*(1 + y)")), errors::Error);
  }
}

TEST(Driven, ByLoadsThatCancelRowsOfSweepsConverge) {
  for (const std::size_t condensed_up_to :
       {operators::default_condensed_up_to, std::size_t{0}, std::size_t{1}}) {
    const auto op = factorise(driven_mesh({"sums", no_load(), {false, 0.1}}), condensed_up_to);
    const fem::Load first = by_force("1 + x - y"), second = by_force("3*(1 + x - y)");
    const fem::Load* const loads[] = {&first, &second};
    const auto basis = op->basis(loads, {}, true);
    const double coefficients[] = {3, -1, 3e8, -1e8, 0, 0, 1e-300, 0, 1, 0};
    contact::SweepColumns rows(5, 1, op->contact_nodes().size(), false, true);
    std::vector<char> start;
    ASSERT_TRUE(op->sweep(*basis, coefficients, {}, rows, start));
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      EXPECT_EQ(rows.status[row], contact::Status::converged) << row;
      EXPECT_LT(rows.kkt[row], 1e-10) << row;
    }
    EXPECT_NEAR(rows.energy[2], rows.energy[0], 1e-9);
    EXPECT_NEAR(rows.energy[3], rows.energy[0], 1e-9);
  }
}

}  // namespace
}  // namespace anticrack::accuracy
