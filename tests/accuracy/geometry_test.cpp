// SPDX-License-Identifier: GPL-3.0-or-later
//
// Membranes given without a mesh: a ring by its sides and its hole, and the side of a line that
// comes off.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "accuracy/base_meshes.hpp"
#include "accuracy/sequence.hpp"

namespace anticrack::accuracy {
namespace {

using mesh::LineSide;
using mesh::LineSpec;
using mesh::Shape;

constexpr double inner = 0.25;

/// The largest error in a node of u = log r between two circles.
double ring_error(double size) {
  mesh::Geometry ring;
  ring.sides = {{"lower", {Shape::arc, {{-1, 0}, {0, -1}, {1, 0}}}},
                {"upper", {Shape::arc, {{1, 0}, {0, 1}, {-1, 0}}}}};
  ring.holes = {{"window", {Shape::circle, {{0, 0}}, inner}}};
  const auto op = factorise(generated(ring, {mesh::Preset::uniform, size}));
  const contact::Answer answer = solve(*op, 0.0, "log(sqrt(x^2 + y^2))", true);
  double error = 0;
  for (const contact::Field& field : answer.fields) {
    for (std::size_t i = 0; i < field.u.size(); ++i) {
      const auto [x, y] = mesh::position(op->mesh(), field.nodes[i]);
      error = std::max(error, std::abs(field.u[i] - std::log(std::hypot(x, y))));
    }
  }
  std::printf("[ figures  ] ring, h = %.3f, %zu triangles: largest error of u %.2e\n", size,
              op->mesh().triangle_count(), error);
  // log r is given in the ends of chords, which lie beyond the circles.
  EXPECT_NEAR(answer.energy, -std::numbers::pi * std::log(inner), 4 * size * size);
  return error;
}

TEST(Ring, ConvergesLikeTheSquareOfTheEdges) {
  const double coarse = ring_error(0.04), fine = ring_error(0.02);
  EXPECT_LT(coarse, 1.5e-3);
  EXPECT_LT(fine, coarse / 3);
}

contact::Answer stiffened(const LineSpec& line, LineSide side) {
  mesh::Geometry geometry;
  geometry.boundary = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  mesh::InclusionSpec bar{"bar", {}, {}};
  bar.line = line;
  bar.stretches = {{0.25, 0.75}};
  bar.delaminated_side = side;
  geometry.inclusions = {bar};
  // a disc that the bar passes through is one subdomain
  geometry.regions = {{"disc", {}, 1, mesh::OutlineSpec{Shape::circle, {{0.1, 0.2}}, 0.3}}};
  return solve(*factorise(generated(geometry, {mesh::Preset::uniform, 0.05})),
               fem::Expression{"1 + x - 3*y"});
}

TEST(OwnLine, ComesOffOnTheSideThatIsAskedFor) {
  const LineSpec forth{Shape::segment, {{0.1, 0.2}}, 20, 0.8};
  const LineSpec back{Shape::segment, {{0.1, 0.2}}, 200, 0.8};
  const contact::Answer left = stiffened(forth, LineSide::left);
  const contact::Answer same = stiffened(back, LineSide::right);
  const contact::Answer right = stiffened(forth, LineSide::right);
  std::printf("[ figures  ] energy %.7f left, %.7f the same, %.7f right\n", left.energy,
              same.energy, right.energy);
  // but for the meshes, which differ
  EXPECT_NEAR(left.energy, same.energy, 1e-5);
  EXPECT_NEAR(left.inclusions.at(0).displacement, same.inclusions.at(0).displacement, 2e-5);
  EXPECT_GT(std::abs(left.energy - right.energy), 1e-3);
  EXPECT_EQ(stiffened(forth, LineSide::unspecified).energy, right.energy);
  // the side that stays moves with the bar
  for (const contact::Answer* answer : {&left, &right}) {
    const double a = answer->inclusions.at(0).displacement;
    for (const double u : answer->traces.at(0).u_plus) EXPECT_NEAR(u, a, 1e-12);
  }
  EXPECT_GT(std::ranges::max(left.traces.at(0).jump), 1e-2);
  EXPECT_LT(std::ranges::max(right.traces.at(0).jump), 1e-9);  // pushed onto the bar
}

}  // namespace
}  // namespace anticrack::accuracy
