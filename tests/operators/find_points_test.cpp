// SPDX-License-Identifier: GPL-3.0-or-later
//
// u at points against the function that it is, and against the traces.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "contact/answer.hpp"
#include "mesh/refine.hpp"
#include "operators/find_points.hpp"
#include "operators/mesh_operator.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::operators {
namespace {

using Operator = std::shared_ptr<const MeshOperator>;
using mesh::Point;

Operator factorised(const testing::StructuredOptions& options) {
  return MeshOperator::factorise(
      std::make_shared<const mesh::Mesh>(testing::structured_mesh(options)), 1, {});
}

contact::Answer solved(const Operator& op, const fem::Load& load) {
  testing::Silent silent;
  return testing::solve(*op, load, contact::ActiveSetOptions{}, true, silent);
}

TEST(FindPoints, UIsLinearBetweenNodes) {
  const Operator op = factorised({.columns = 8,
                                  .rows = 3,
                                  .kind = [](double) { return mesh::Kind::glue; },
                                  .inclusion = {},
                                  .inclusions = {}});
  fem::Load load;
  load.boundary_value = "1 + 2*x - 3*y";
  const contact::Answer answer = solved(op, load);
  const std::vector<Point> points{{0.123, 0.456}, {-0.987, -0.3},  {0.21, 0},     {1, 0.37},
                                  {-1, -1},       {0.25, 1.0 / 3}, {1 + 1e-12, 0}};
  const std::vector<PointPlace> places = op->find_points(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [minus, plus] = op->u_at(places[i], points[i], answer);
    const double exact = 1 + 2 * points[i][0] - 3 * points[i][1];
    EXPECT_NEAR(minus, exact, 1e-11) << i;
    EXPECT_NEAR(plus, exact, 1e-11) << i;
  }
}

TEST(FindPoints, AnOpenInterfaceHasTwoValues) {
  const Operator op = factorised({.columns = 16, .rows = 8, .kind = {}, .inclusion = {}});
  fem::Load load;
  load.force = fem::Expression{"y > 0 ? 1 : -1"};
  load.inclusion_forces["stiffener"] = 0.3;
  const contact::Answer answer = solved(op, load);
  const contact::Trace& trace = answer.traces[0];
  const contact::TraceGeometry& line = op->trace_geometry()[0];
  std::size_t open = 0;
  for (std::size_t i = 0; i + 1 < trace.jump.size(); ++i) {
    const Point middle{0.5 * (line.x[i] + line.x[i + 1]), 1e-12};
    const auto [minus, plus] = op->u_at(op->find_points(std::vector{middle})[0], middle, answer);
    EXPECT_NEAR(minus, 0.5 * (trace.u_minus[i] + trace.u_minus[i + 1]), 1e-10);
    EXPECT_NEAR(plus, 0.5 * (trace.u_plus[i] + trace.u_plus[i + 1]), 1e-10);
    // A little beside it are the values of its sides.
    const Point above{middle[0], 1e-6}, below{middle[0], -1e-6};
    const auto places = op->find_points(std::vector{above, below});
    EXPECT_EQ(places[0].interface, -1);
    EXPECT_NEAR(op->u_at(places[0], above, answer).first, plus, 1e-4);
    EXPECT_NEAR(op->u_at(places[1], below, answer).first, minus, 1e-4);
    if (plus - minus > 1e-3) ++open;
  }
  EXPECT_GE(open, 6U);
}

TEST(FindPoints, ATipHasOneValueHoweverShortItsEdges) {
  mesh::Mesh mesh =
      mesh::grade(testing::structured_mesh({16, 8, {}, {}}), {0.1, 0.2, 1e-12}, 100'000);
  const auto op =
      MeshOperator::factorise(std::make_shared<const mesh::Mesh>(std::move(mesh)), 1, {});
  fem::Load load;
  load.force = fem::Expression{"y > 0 ? 1 : -1"};
  load.inclusion_forces["stiffener"] = 0.3;
  const contact::Answer answer = solved(op, load);
  for (const double x : {-0.5, 0.5}) {
    const Point tip{x, 0};
    const auto [minus, plus] = op->u_at(op->find_points(std::vector{tip})[0], tip, answer);
    EXPECT_NEAR(minus, answer.inclusions[0].displacement_mesh, 1e-14);
    EXPECT_NEAR(plus, answer.inclusions[0].displacement_mesh, 1e-14);
  }
}

TEST(FindPoints, OutsideIsNowhere) {
  const Operator op = factorised({.columns = 8, .rows = 3, .kind = {}, .inclusion = {}});
  for (const Point& point : {Point{1 + 1e-6, 0}, Point{0, -2}})
    EXPECT_LT(op->find_points(std::vector{point})[0].location.triangle, 0);
}

}  // namespace
}  // namespace anticrack::operators
