// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of combinations of loads against those of the same loads given as they are.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "operators/sweep_support.hpp"
#include "support/errors.hpp"

namespace anticrack::operators {
namespace {

using anticrack::testing::throws;
using errors::Reason;

std::shared_ptr<const LoadBasis> bounded_basis(const MeshOperator& op,
                                               const std::vector<fem::Load>& loads) {
  std::vector<const fem::Load*> pointers;
  for (const fem::Load& load : loads) pointers.push_back(&load);
  return op.basis(pointers, {}, true);
}

contact::Answer bounded_answer(const MeshOperator& op, const PreparedLoad& load) {
  Silent silent;
  contact::Answer answer = op.solve(load, {}, false, silent);
  op.estimate(load, answer);
  return answer;
}

contact::Answer of_load(const MeshOperator& op, const fem::Load& load) {
  const fem::Load* const one[] = {&load};
  return bounded_answer(op, std::get<PreparedLoad>(std::move(op.prepare(one).front())));
}

contact::Answer of_row(const MeshOperator& op, const LoadBasis& basis,
                       const std::vector<double>& c) {
  return bounded_answer(op, op.combine(basis, c));
}

void expect_near(double a, double b, double size) { EXPECT_NEAR(a, b, 1e-9 * size); }

/// Whether bounds of one contain those of the other, to rounding.
void expect_inside(const contact::Answer& narrow, const contact::Answer& wide) {
  const double rounding = 1e-9 * std::abs(narrow.energy);
  ASSERT_TRUE(narrow.energy_lower && wide.energy_lower) << narrow.no_bracket << wide.no_bracket;
  EXPECT_LE(*wide.energy_lower, *narrow.energy_lower + rounding);
  EXPECT_GE(*wide.energy_upper, *narrow.energy_upper - rounding);
  const contact::InclusionAnswer &a = narrow.inclusions[0], &b = wide.inclusions[0];
  ASSERT_TRUE(a.displacement_lower && b.displacement_lower);
  EXPECT_LE(*b.displacement_lower, *a.displacement_upper);
  EXPECT_GE(*b.displacement_upper, *a.displacement_lower);
  EXPECT_LE(*b.displacement_lower, b.displacement_mesh);
  EXPECT_GE(*b.displacement_upper, b.displacement_mesh);
}

void expect_same(const contact::Answer& a, const contact::Answer& b) {
  ASSERT_TRUE(a.energy_lower && b.energy_lower) << a.no_bracket << b.no_bracket;
  const double size = std::abs(a.energy) + *a.energy_upper - *a.energy_lower;
  expect_near(*a.energy_lower, *b.energy_lower, size);
  expect_near(*a.energy_upper, *b.energy_upper, size);
  const contact::InclusionAnswer &i = a.inclusions[0], &j = b.inclusions[0];
  ASSERT_TRUE(i.displacement_lower && j.displacement_lower);
  expect_near(*i.displacement_lower, *j.displacement_lower, 1);
  expect_near(*i.displacement_upper, *j.displacement_upper, 1);
}

/// Loads that are linear on triangles; boundary values that are not, and linear ones beside them.
std::vector<fem::Load> lifted_loads() {
  std::vector<fem::Load> loads = three_loads();
  loads[1].force = fem::Expression{"2 - y"};
  loads[1].boundary_value = "x^2 + x*y";
  loads[2].boundary_value = "0.5 + y";
  return loads;
}

TEST(SweepBounds, AreThoseOfTheSameLoads) {
  const auto mesh = std::make_shared<const mesh::Mesh>(
      anticrack::testing::structured_mesh({32, 8, {}, {}, {"bar"}}));
  for (const std::size_t condensed_up_to :
       {default_condensed_up_to, std::size_t{0}, std::size_t{1}}) {  // condensed, and joined
    const Operator op = MeshOperator::factorise(mesh, 1, {}, condensed_up_to);
    const auto basis = bounded_basis(*op, lifted_loads());
    for (const std::vector<double>& c : std::vector<std::vector<double>>{
             {1, 0, 0}, {0, 1, 0}, {-1, 0.5, 2}, {2, -0.25, 0}, {0.3, 0, -1}, {0, 1, -1}}) {
      const auto number = [&](std::size_t j) { return "(" + std::to_string(c[j]) + ")"; };
      fem::Load same;
      same.force = fem::Expression{number(0) + " + " + number(1) + "*(2 - y) + " + number(2) +
                                   "*(x - 0.3*y)"};
      same.boundary_value = number(1) + "*(x^2 + x*y) + " + number(2) + "*(0.5 + y)";
      same.inclusion_forces["bar"] = 0.4 * c[2];
      SCOPED_TRACE(same.boundary_value);
      expect_same(of_row(*op, *basis, c), of_load(*op, same));
    }
    EXPECT_EQ(*of_row(*op, *basis, {0, 0, 0}).energy_upper, 0);
  }
}

/// Where T varies, a g_D that bends allows wide bounds of A only; one with a coefficient of 0 is no
/// such.
TEST(SweepBounds, AreNotWidenedByALoadThatIsLeftOut) {
  mesh::Mesh mesh = anticrack::testing::structured_mesh({32, 8, {}, {}, {"bar"}});
  mesh.tension_laws.assign(2, {"1 + 0.5*x^2", "", 0});
  const Operator op =
      MeshOperator::factorise(std::make_shared<const mesh::Mesh>(std::move(mesh)), 1, {});
  const std::vector<fem::Load> loads = lifted_loads();
  const auto basis = bounded_basis(*op, loads);
  for (const std::size_t own : {0, 2}) {
    std::vector<double> c(3, 0);
    c[own] = 1;
    expect_same(of_row(*op, *basis, c), of_load(*op, loads[own]));
  }
}

TEST(SweepBounds, OfLoadsThatAreNotLinearAreTheirOwnOrWider) {
  mesh::Mesh mesh = anticrack::testing::structured_mesh({32, 8, {}, {}, {"bar"}});
  std::erase_if(mesh.dirichlet, [&](const auto& edge) {
    return mesh.xy[2 * static_cast<std::size_t>(edge[0])] == 1 &&
           mesh.xy[2 * static_cast<std::size_t>(edge[1])] == 1;
  });
  const Operator op =
      MeshOperator::factorise(std::make_shared<const mesh::Mesh>(std::move(mesh)), 1, {});
  std::vector<fem::Load> loads(2);
  loads[0].force = fem::Expression{"sin(9*x)*y"};
  loads[0].traction = "1 + y";
  loads[1].force = fem::Expression{"exp(x + 2*y)"};
  const auto basis = bounded_basis(*op, loads);
  expect_same(of_row(*op, *basis, {1, 0}), of_load(*op, loads[0]));
  expect_same(of_row(*op, *basis, {0, 1}), of_load(*op, loads[1]));
  fem::Load sum;
  sum.traction = "-2*(1 + y)";
  sum.force = fem::Expression{"-2*sin(9*x)*y + 0.5*exp(x + 2*y)"};
  expect_inside(of_load(*op, sum), of_row(*op, *basis, {-2, 0.5}));
  // Equal loads that nearly cancel: what is not balanced is not known to.
  loads[1] = loads[0];
  const auto twice = bounded_basis(*op, loads);
  fem::Load tenth;
  tenth.force = fem::Expression{"0.1*sin(9*x)*y"};
  tenth.traction = "0.1*(1 + y)";
  const contact::Answer narrow = of_load(*op, tenth), wide = of_row(*op, *twice, {1, -0.9});
  expect_inside(narrow, wide);
  EXPECT_LT(*wide.energy_lower, *narrow.energy_lower);
  // No number is left of these but rounding.
  const contact::Answer none = of_row(*op, *twice, {1, -1 + 1e-9});
  EXPECT_FALSE(none.energy_lower);
  EXPECT_NE(none.no_bracket.find("cancel"), std::string::npos);
}

TEST(SweepBounds, AreNoneWithALoadThatHasNone) {
  const Operator op = factorised();
  std::vector<fem::Load> loads(3);
  loads[0].force = 1.0;
  loads[0].boundary_value = "100*x^2";
  loads[1].point_forces = {{0.1, 0.4, 1}};
  loads[2].boundary_value = "x > 0.11 ? 1 : 0";
  const auto basis = bounded_basis(*op, loads);
  EXPECT_TRUE(of_row(*op, *basis, {1, 0, 0}).energy_lower);
  const contact::Answer pushed = of_row(*op, *basis, {1, 1e-9, 0});
  EXPECT_FALSE(pushed.energy_lower);
  EXPECT_NE(pushed.no_bracket.find("point force"), std::string::npos);
  // A jump so small beside the other's curve that the sum looks smooth.
  const contact::Answer jumping = of_row(*op, *basis, {1, 0, 1e-6});
  EXPECT_FALSE(jumping.energy_lower);
  EXPECT_NE(jumping.no_bracket.find("boundary_value jumps"), std::string::npos);
  loads[2].boundary_value = "1 - 1/(1 + sqrt(abs(x - 0.11) - 0.01))";  // finite in nodes
  EXPECT_TRUE(throws([&] { bounded_basis(*op, loads); }, Reason::expression_invalid,
                     "load_cases[2].boundary_value"));
}

TEST(SweepBounds, NeedABasisThatWasMadeForThem) {
  const Operator op = factorised();
  const auto plain = basis_of(*op, three_loads());
  EXPECT_TRUE(throws([&] { of_row(*op, *plain, {1, 1, 1}); }, Reason::internal));
  const auto with = bounded_basis(*op, three_loads());
  EXPECT_TRUE(of_row(*op, *with, {1, 1, 1}).energy_lower);
  EXPECT_GT(with->bytes(), plain->bytes() + 3 * 3 * sizeof(double) * op->mesh().triangle_count());
  EXPECT_EQ(basis_of(*op, three_loads())->bytes(), plain->bytes());
  // Rows are the same with either.
  contact::SweepColumns rows = columns(*op, 1), others = rows;
  std::vector<char> start;
  const std::vector<double> c{1, -2, 0.5};
  ASSERT_TRUE(op->sweep(*plain, c, {}, rows, start));
  ASSERT_TRUE(op->sweep(*with, c, {}, others, start));
  EXPECT_EQ(rows.energy, others.energy);
  EXPECT_EQ(rows.displacement, others.displacement);
}

/// Also where no cache keeps the basis: an array without a hash cannot be looked up.
TEST(SweepBounds, CountInTheMemoryOfTheMeshWhileAJobHasThem) {
  const Operator op = factorised();
  fem::Load load;
  load.force = fem::Array{
      "", true, std::make_shared<const std::vector<double>>(op->mesh().triangle_count(), 1.0)};
  const fem::Load* const one[] = {&load};
  constexpr std::uint64_t many = 1'000'000;
  ASSERT_TRUE(op->shares_bounds(1, many));
  op->basis(one, {}, true, many);  // whatever the mesh keeps for all bounds
  const std::size_t before = op->bytes();
  auto own = op->basis(one, {}, true), shared = op->basis(one, {}, true, many);
  EXPECT_EQ(op->bytes(), before + own->bytes() + shared->bytes());
  const std::size_t n = op->contact_nodes().size();
  EXPECT_GT(shared->bytes(), own->bytes() + 3 * sizeof(double) * n * n);
  own.reset();
  shared.reset();
  EXPECT_EQ(op->bytes(), before);
}

TEST(SweepBounds, CountTowardsTheMemoryOfABasis) {
  const Operator op = factorised();
  const fem::Load load;
  const std::size_t numbers = op->mesh().node_count() + 4 * op->mesh().triangle_count();
  const std::vector<const fem::Load*> loads(max_basis_bytes / sizeof(double) / numbers + 1, &load);
  EXPECT_TRUE(throws([&] { op->basis(loads, {}, true); }, Reason::limit_exceeded));
}

}  // namespace
}  // namespace anticrack::operators
