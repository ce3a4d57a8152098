// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of forces on the boundary against a closed form; tests/estimate/bounds_test has them on
// random membranes.
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "contact/answer.hpp"
#include "growth/crack_in_square.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"

namespace anticrack::operators {
namespace {

using contact::BoundaryAnswer;
using mesh::Kind;

/// The square with a crack |x| < 1/2, u = y on its boundary but for the free sides x = +-1.
contact::Answer cracked(int n, bool free_sides, const std::string& boundary = "y") {
  mesh::Mesh mesh = testing::square(testing::within(0.5, Kind::crack, Kind::glue), n);
  if (free_sides) mesh = testing::with_free_sides(std::move(mesh));
  for (auto& [a, b] : mesh.dirichlet) {  // the membrane on their left
    const mesh::Point from = mesh::position(mesh, a), to = mesh::position(mesh, b);
    if (from[0] * to[1] - from[1] * to[0] < 0) std::swap(a, b);
  }
  const auto last = static_cast<std::int32_t>(mesh.node_count()) - 1;
  mesh.boundary_parts = {{"top", last, last - 2 * n}};
  const testing::OnMesh on = testing::prepared(std::move(mesh), testing::load_of(boundary));
  testing::Silent silent;
  contact::Answer answer =
      testing::solve(*on.op, on.load, contact::ActiveSetOptions{}, true, silent);
  on.op->find_boundary(on.load, answer);
  on.op->estimate(on.load, answer);
  return answer;
}

const BoundaryAnswer& top(const contact::Answer& answer) {
  for (const BoundaryAnswer& one : answer.boundary)
    if (one.name == "top") return one;
  throw std::runtime_error("no part top");
}

/// |u|^2 = int u T du/dn is twice the force at the top.
TEST(BoundsOfForces, HoldTheExactForceOnACrackedSquare) {
  double before = 1e9;
  for (const int n : {8, 16, 32}) {
    const contact::Answer answer = cracked(n, true);
    const BoundaryAnswer& row = top(answer);
    ASSERT_EQ(row.no_bounds, "");
    const double exact = testing::exact_energy(0.5),
                 width = *row.resultant_upper - *row.resultant_lower;
    std::printf("[ figures  ] n = %d: force %.5f of %.5f, bounds %.5f to %.5f\n", n, row.resultant,
                exact, *row.resultant_lower, *row.resultant_upper);
    EXPECT_LT(*row.resultant_lower, exact);
    EXPECT_GT(*row.resultant_upper, exact);
    EXPECT_GT(row.resultant, exact);  // of the mesh, which is stiffer
    EXPECT_LT(width, 0.7 * before);
    before = width;
  }
}

/// A force that the boundary cuts off in a corner is infinite, or depends on the mesh.
TEST(BoundsOfForces, AreRefusedInWords) {
  const contact::Answer held = cracked(8, false);
  EXPECT_NE(top(held).no_bounds.find("meets another part"), std::string::npos);
  EXPECT_FALSE(top(held).resultant_lower);
  const contact::Answer answer = cracked(8, true);
  for (const BoundaryAnswer& one : answer.boundary)
    if (one.free) {
      EXPECT_NE(one.no_bounds, "");
    }
}

}  // namespace
}  // namespace anticrack::operators
