// SPDX-License-Identifier: GPL-3.0-or-later
//
// Section 6 of the paper alone: the membrane is the upper half, the inclusion lies on its boundary,
// the traction beside it is given. An interface needs two sides, so a box below the inclusion makes
// the second: held by the inclusion only and free of load, it is at A everywhere and adds nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "accuracy/error_norms.hpp"
#include "accuracy/sequence.hpp"
#include "mesh/refine.hpp"
#include "support/exact_solutions.hpp"

namespace anticrack::accuracy {
namespace {

constexpr double line_shift = 0.3;

/// (-1,1) x (0,1), u given on its sides and its top, and the box (-1/2,1/2) x (-1/4,0); squares of
/// side 1/4 with a diagonal.
mesh::Mesh half_plane() {
  mesh::Mesh mesh;
  mesh.subdomains = {"box", "upper"};
  mesh.inclusions = {"stiffener"};
  const auto node = [](int i, int j) { return j < 0 ? 45 + i - 2 : 9 * j + i; };
  for (int j = 0; j <= 4; ++j) {
    for (int i = 0; i <= 8; ++i) {
      mesh.xy.insert(mesh.xy.end(), {-1 + 0.25 * i, 0.25 * j});
    }
  }
  for (int i = 2; i <= 6; ++i) {
    mesh.xy.insert(mesh.xy.end(), {-1 + 0.25 * i, -0.25});
  }
  const auto square = [&](int i, int j) {
    const int a = node(i, j), b = node(i + 1, j), c = node(i + 1, j + 1), d = node(i, j + 1);
    mesh.triangles.insert(mesh.triangles.end(), {a, b, c, a, c, d});
    mesh.subdomain.insert(mesh.subdomain.end(), 2, j < 0 ? 0 : 1);
  };
  for (int i = 2; i < 6; ++i) {
    square(i, -1);
  }
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 8; ++i) {
      square(i, j);
    }
    mesh.dirichlet.push_back({node(0, j + 1), node(0, j)});
    mesh.dirichlet.push_back({node(8, j), node(8, j + 1)});
  }
  for (int i = 0; i < 8; ++i) {
    mesh.dirichlet.push_back({node(i + 1, 4), node(i, 4)});
  }
  mesh::Interface interface;
  interface.name = "sigma";
  for (int i = 2; i <= 6; ++i) {
    interface.nodes.push_back(node(i, 0));
  }
  interface.kind.assign(4, mesh::Kind::inclusion);
  interface.inclusion.assign(4, 0);
  mesh.interfaces.push_back(interface);
  mesh::validate(mesh);
  return mesh;
}

/// The inclusion ends on the boundary, where `tips` sees none: its nodes are named here.
mesh::Mesh graded_half_plane(double h0, double m) {
  const std::vector<std::int32_t> ends = {2, 6};
  return mesh::grade(half_plane(), ends, {h0, m, 0}, 1'000'000);
}

fem::Load half_load(const std::string& boundary, const std::string& traction, double force) {
  fem::Load load;
  load.name = "case";
  load.boundary_value = boundary;
  load.traction = "y < 0 ? 0 : (" + traction + ")";
  load.inclusion_forces = {{"stiffener", force}};
  return load;
}

/// u = line_shift - c y: traction c beside the inclusion, and c times its length pulls it.
TEST(HalfPlane, LinearSolutionIsExact) {
  constexpr double c = 0.7;
  const auto op = factorise(graded_half_plane(0.2, 0.2));
  const contact::Answer answer =
      solve_bounded(*op, half_load(testing::closed_crack(c, line_shift).boundary, "0.7", c));
  double worst = std::abs(answer.inclusions.at(0).displacement_mesh - line_shift);
  for (std::size_t s = 0; s < 2; ++s) {
    const contact::Field& field = answer.fields.at(s);
    for (std::size_t i = 0; i < field.nodes.size(); ++i) {
      const double y = op->mesh().xy[2 * static_cast<std::size_t>(field.nodes[i]) + 1];
      worst = std::max(worst, std::abs(field.u[i] - (s == 0 ? line_shift : line_shift - c * y)));
    }
  }
  std::printf("[ figures  ] half plane, linear: error of u %.1e\n", worst);
  EXPECT_LT(worst, 1e-12);
  EXPECT_NEAR(answer.inclusions[0].resultant, c, 1e-12);
  EXPECT_LT(*answer.energy_upper - *answer.energy_lower, 1e-11);
}

/// The open inclusion seen from above; its traction is infinite at the tips.
TEST(HalfPlane, OpenInclusionHasTheRatesOfSmoothSolutions) {
  constexpr double m = 0.1;
  testing::ExactSolution exact = testing::open_inclusion(line_shift);
  const auto upper = exact.derivative;
  exact.derivative = [upper](testing::Complex z) {
    return z.imag() > 0 ? upper(z) : testing::Complex(0);
  };
  double previous_a = 0, previous_energy = 0;
  for (double h0 = 0.4; h0 > 0.04; h0 /= 2) {
    const auto op = factorise(graded_half_plane(h0, m));
    const contact::Answer answer =
        solve(*op,
              half_load(exact.boundary,
                        "(x < 0 ? 1 : -1) * sqrt(0.5) * abs(x+0.5)^0.75 * abs(x-0.5)^0.25"
                        " * (0.75/(x+0.5) + 0.25/(x-0.5))",
                        0),
              true);
    const double a = std::abs(answer.inclusions.at(0).displacement - line_shift);
    const double energy = energy_error(op->mesh(), answer, exact);
    std::printf(
        "[ figures  ] half plane, h0 = %.3f, %zu triangles: error of A %.3e (%.2f), energy "
        "norm %.3e (%.2f)\n",
        h0, op->mesh().triangle_count(), a, previous_a > 0 ? rate(previous_a, a) : 0, energy,
        previous_energy > 0 ? rate(previous_energy, energy) : 0);
    if (h0 < 0.15) {
      EXPECT_GT(rate(previous_a, a), 1.8);
      EXPECT_GT(rate(previous_energy, energy), 0.9);
    }
    previous_a = a;
    previous_energy = energy;
  }
}

}  // namespace
}  // namespace anticrack::accuracy
