// SPDX-License-Identifier: GPL-3.0-or-later
//
// Forces on parts of the boundary against their balance and against linear solutions.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "contact/answer.hpp"
#include "operators/mesh_operator.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::operators {
namespace {

using contact::BoundaryAnswer;
using testing::StructuredOptions;

/// structured_mesh() with the names bottom, right, top and left.
mesh::Mesh named(const StructuredOptions& options) {
  mesh::Mesh mesh = testing::structured_mesh(options);
  for (auto& [a, b] : mesh.dirichlet) {  // the membrane on their left
    const mesh::Point from = mesh::position(mesh, a), to = mesh::position(mesh, b);
    if (from[0] * to[1] - from[1] * to[0] < 0) std::swap(a, b);
  }
  const int nx = options.columns, last = (nx + 1) * (2 * options.rows + 1) - 1;
  mesh.boundary_parts = {
      {"bottom", 0, nx}, {"right", nx, last}, {"top", last, last - nx}, {"left", last - nx, 0}};
  return mesh;
}

/// Lets part of the boundary be free.
template <class Where>
void release(mesh::Mesh& mesh, const Where& where) {
  std::erase_if(mesh.dirichlet, [&](const std::array<std::int32_t, 2>& edge) {
    const mesh::Point a = mesh::position(mesh, edge[0]), b = mesh::position(mesh, edge[1]);
    return where((a[0] + b[0]) / 2, (a[1] + b[1]) / 2);
  });
}

contact::Answer answer_of(const mesh::Mesh& mesh, const fem::Load& load,
                          std::size_t condensed_up_to = default_condensed_up_to) {
  const auto op =
      MeshOperator::factorise(std::make_shared<const mesh::Mesh>(mesh), 1, {}, condensed_up_to);
  const fem::Load* const one[] = {&load};
  const auto prepared = std::get<PreparedLoad>(std::move(op->prepare(one).front()));
  testing::Silent silent;
  contact::Answer answer = op->solve(prepared, contact::ActiveSetOptions{}, true, silent);
  EXPECT_EQ(answer.status, contact::Status::converged) << answer.reason;
  op->find_boundary(prepared, answer);
  return answer;
}

const BoundaryAnswer& part(const contact::Answer& answer, const std::string& name, bool free) {
  for (const BoundaryAnswer& one : answer.boundary)
    if (one.name == name && one.free == free) return one;
  throw std::runtime_error("no part " + name);
}

/// Expects that the forces balance `load` and that none of them is the only one.
void expect_balance(const contact::Answer& answer, double load) {
  double sum = load, size = std::abs(load);
  for (const BoundaryAnswer& one : answer.boundary) {
    sum += one.resultant;
    size += std::abs(one.resultant);
    EXPECT_GT(std::abs(one.resultant), 1e-3) << one.name;
  }
  for (const contact::InclusionAnswer& one : answer.inclusions) {
    sum += one.resultant;
    size += std::abs(one.resultant);
  }
  EXPECT_LT(std::abs(sum), 1e-10 * size);
}

fem::Load loaded() {
  fem::Load load;
  load.force = fem::Expression{"2 + x - 3*y"};  // 8 on the square
  load.boundary_value = "0.3*x - y*y";
  load.point_forces = {{0.3, -0.6, 1.5}};
  return load;
}
constexpr double applied = 8 + 1.5;

TEST(BoundaryForces, BalanceTheLoadWhateverTheInterfacesAre) {
  for (const mesh::Kind inside : {mesh::Kind::delaminated, mesh::Kind::crack, mesh::Kind::inclusion,
                                  mesh::Kind::free, mesh::Kind::glue}) {
    for (const std::size_t condensed_up_to : {default_condensed_up_to, std::size_t{0}}) {
      const bool rigid = inside == mesh::Kind::delaminated || inside == mesh::Kind::inclusion;
      mesh::Mesh mesh =
          named({.columns = 16,
                 .rows = 8,
                 .kind = [&](double x) { return std::abs(x) < 0.5 ? inside : mesh::Kind::glue; },
                 .inclusion = {},
                 .inclusions = {}});
      if (rigid) mesh.inclusions = {"fibre"};
      fem::Load load = loaded();
      if (rigid) load.inclusion_forces["fibre"] = -0.7;
      const contact::Answer answer = answer_of(mesh, load, condensed_up_to);
      ASSERT_EQ(answer.boundary.size(), 4U);
      expect_balance(answer, applied);
    }
  }
}

TEST(BoundaryForces, BalanceWhatHoldsAnInclusion) {
  mesh::Mesh mesh = named({.columns = 16, .rows = 8, .kind = {}, .inclusion = {}});
  mesh.motions = {{false, 0.5}};
  const contact::Answer answer = answer_of(mesh, loaded());
  ASSERT_EQ(answer.inclusions.size(), 1U);
  EXPECT_GT(std::abs(answer.inclusions[0].resultant), 0.1);
  expect_balance(answer, applied);
}

TEST(BoundaryForces, HaveTheMomentsOfTheLoad) {
  const mesh::Mesh mesh = named({.columns = 16,
                                 .rows = 8,
                                 .kind = [](double) { return mesh::Kind::glue; },
                                 .inclusion = {},
                                 .inclusions = {}});
  const contact::Answer answer = answer_of(mesh, loaded());
  double x = 0, y = 0;
  for (const BoundaryAnswer& one : answer.boundary) {
    x += one.moment_x + one.resultant * one.x;
    y += one.moment_y + one.resultant * one.y;
  }
  // int grad u = int g_D n is what tension adds.
  EXPECT_NEAR(x + 4.0 / 3 + 1.5 * 0.3, 1.2, 1e-10);
  EXPECT_NEAR(y - 4 - 1.5 * 0.6, 0, 1e-10);
}

TEST(BoundaryForces, ShareACornerByTheLengthsOfItsEdges) {
  mesh::Mesh mesh = named({.columns = 8,
                           .rows = 3,
                           .kind = [](double) { return mesh::Kind::glue; },
                           .inclusion = {},
                           .inclusions = {}});
  fem::Load load;
  load.point_forces = {{-1 + 1e-9, -1 + 1e-9, 7}};  // held by the corner alone
  const contact::Answer answer = answer_of(mesh, load);
  const double along_x = 2.0 / 8, along_y = 1.0 / 3;
  EXPECT_NEAR(part(answer, "bottom", false).resultant, -7 * along_x / (along_x + along_y), 1e-6);
  EXPECT_NEAR(part(answer, "left", false).resultant, -7 * along_y / (along_x + along_y), 1e-6);
}

TEST(BoundaryForces, BalanceTractionsTooAndUnderATensor) {
  mesh::Mesh mesh = named({.columns = 16, .rows = 8, .kind = {}, .inclusion = {}});
  mesh.tension_laws = {{"1 + x*x", "2", 30}, {"3", "", 0}};
  release(mesh, [](double x, double y) { return x == 1 || (y == 1 && x > 0); });
  fem::Load load = loaded();
  load.traction = "1 + y";
  const contact::Answer answer = answer_of(mesh, load);
  ASSERT_EQ(answer.boundary.size(), 5U);  // top is held and free
  expect_balance(answer, applied);
  EXPECT_NEAR(part(answer, "right", true).resultant, 2, 1e-12);
  EXPECT_NEAR(part(answer, "top", true).resultant, 2, 1e-12);
  EXPECT_NEAR(part(answer, "right", true).moment_y, 2.0 / 3, 1e-12);
}

TEST(BoundaryForces, AreThoseOfALinearSolution) {
  mesh::Mesh mesh = named({.columns = 8,
                           .rows = 3,
                           .kind = [](double) { return mesh::Kind::glue; },
                           .inclusion = {},
                           .inclusions = {}});
  mesh.tension = {2, 2};
  fem::Load load;
  load.boundary_value = "x + 3*y";
  const contact::Answer answer = answer_of(mesh, load);
  const double flux[] = {-6, 2, 6, -2};  // T du/dn
  for (std::size_t i = 0; i < 4; ++i) {
    const BoundaryAnswer& one = part(answer, mesh.boundary_parts[i].name, false);
    EXPECT_NEAR(one.resultant, 2 * flux[i], 1e-12) << one.name;
    EXPECT_NEAR(one.moment_x, 0, 1e-12) << one.name;
    EXPECT_NEAR(one.moment_y, 0, 1e-12) << one.name;
    EXPECT_EQ(std::abs(one.x) + std::abs(one.y), 1) << one.name;
  }
}

TEST(BoundaryForces, OfAMeshWithoutNamesAreOfWhatIsHeldAndWhatIsFree) {
  mesh::Mesh mesh = testing::structured_mesh({16, 8, {}, {}});
  release(mesh, [](double x, double) { return x == 1; });
  fem::Load load = loaded();
  load.traction = "1 - y";
  const contact::Answer answer = answer_of(mesh, load);
  ASSERT_EQ(answer.boundary.size(), 2U);
  EXPECT_NEAR(part(answer, "boundary", true).resultant, 2, 1e-12);
  part(answer, "boundary", false);
  expect_balance(answer, applied);
}

}  // namespace
}  // namespace anticrack::operators
