// SPDX-License-Identifier: GPL-3.0-or-later
//
// Answers do not depend on which mesh of which kind, on left and right, or on whether the mesh
// follows the jumps of the load.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "accuracy/base_meshes.hpp"
#include "accuracy/paper_limits.hpp"
#include "accuracy/sequence.hpp"
#include "mesh/refine.hpp"

namespace anticrack::accuracy {
namespace {

mesh::Mesh graded_like_default(const mesh::Mesh& base) {
  return mesh::grade(base, {0.1, 0.2, 0}, 200'000);  // h0, m
}

/// f(-x, y) or f(x, -y).
std::string reflected(std::string text, Mirror mirror) {
  const char variable = mirror == Mirror::x ? 'x' : 'y';
  for (std::size_t i = text.find(variable); i != std::string::npos;
       i = text.find(variable, i + 4)) {
    text.replace(i, 1, std::string("(-") + variable + ")");
  }
  return text;
}

double largest(const std::vector<double>& values) {
  double result = 0;
  for (const double value : values) {
    result = std::max(result, std::abs(value));
  }
  return result;
}

/// Largest difference of the traces, the second walked backwards.
double difference(const contact::Trace& a, const contact::Trace& b) {
  double result = 0;
  for (std::size_t i = 0, j = a.jump.size() - 1; i < a.jump.size(); ++i, --j) {
    result = std::max(
        {result, std::abs(a.u_plus[i] - b.u_plus[j]), std::abs(a.u_minus[i] - b.u_minus[j])});
  }
  return result;
}

class Example : public ::testing::TestWithParam<std::size_t> {
 protected:
  const char* force() const { return paper_forces[GetParam()]; }
};

/// Half a percent of the largest deflection is what h0 = 0.1 leaves of A; see examples_test.
TEST_P(Example, IsTheSameOnOtherBaseMeshes) {
  const double scale = 0.2;
  double lowest = 1, highest = -1;
  const auto look = [&](const char* name, const mesh::Mesh& mesh) {
    const contact::Answer answer = solve(*factorise(mesh), fem::Expression{force()});
    const double a = answer.inclusions.at(0).displacement;
    std::printf("[ figures  ] example %zu, %s, %zu triangles: A %.8f, energy %.8f\n",
                GetParam() + 1, name, mesh.triangle_count(), a, answer.energy);
    EXPECT_NEAR(a, a_limits[GetParam()], 5e-3 * scale);
    EXPECT_NEAR(answer.energy, energy_limits[GetParam()], 8e-3 * std::abs(answer.energy));
    lowest = std::min(lowest, a);
    highest = std::max(highest, a);
  };
  look("diagonals", graded_like_default(diagonals()));
  look("rectangles", graded_like_default(rectangles()));
  look("shaken", graded_like_default(shaken(7)));
  look("generated", generated(0.1));
  EXPECT_LT(highest - lowest, 3e-3 * scale);
}

void expect_mirrored(const mesh::Mesh& mesh, std::size_t example, Mirror mirror, char axis) {
  const char* force = paper_forces[example];
  const contact::Answer original = solve(*factorise(mesh), fem::Expression{force});
  const contact::Answer image =
      solve(*factorise(mirrored(mesh, mirror)), fem::Expression{reflected(force, mirror)});
  const double worst = difference(original.traces.at(0), image.traces.at(0));
  std::printf("[ figures  ] example %zu, %c -> -%c: traces differ by %.1e\n", example + 1, axis,
              axis, worst);
  EXPECT_LT(worst, 1e-10);
  EXPECT_NEAR(original.energy, image.energy, 1e-11);
  EXPECT_NEAR(original.contact_length, image.contact_length, 1e-9);
}

TEST_P(Example, MirrorsLeftAndRight) {
  expect_mirrored(graded_like_default(shaken(11)), GetParam(), Mirror::x, 'x');
}

/// The plus side, Omega_2, is then the lower half.
TEST_P(Example, MirrorsUpAndDown) {
  expect_mirrored(graded_like_default(shaken(12)), GetParam(), Mirror::y, 'y');
}

/// A crack without inclusion does not know its plus side: u -> -u exchanges them.
TEST_P(Example, OfACrackMirrorsUpsideDown) {
  mesh::Mesh mesh = graded_like_default(diagonals(mesh::Kind::crack));
  const contact::Answer original = solve(*factorise(mesh), fem::Expression{force()});
  const contact::Answer image = solve(*factorise(turned(mirrored(mesh, Mirror::y))),
                                      fem::Expression{"-(" + reflected(force(), Mirror::y) + ")"});
  double worst = 0;
  for (std::size_t i = 0; i < original.traces.at(0).jump.size(); ++i) {
    const contact::Trace &a = original.traces[0], &b = image.traces.at(0);
    worst = std::max(
        {worst, std::abs(a.u_plus[i] + b.u_minus[i]), std::abs(a.u_minus[i] + b.u_plus[i])});
  }
  std::printf(
      "[ figures  ] example %zu without inclusion, u -> -u: traces differ by %.1e, largest "
      "jump %.3e\n",
      GetParam() + 1, worst, largest(original.traces[0].jump));
  EXPECT_LT(worst, 1e-10);
  EXPECT_NEAR(original.energy, image.energy, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Paper, Example, ::testing::Range<std::size_t>(0, 4),
                         [](const auto& named) { return std::to_string(named.param + 1); });

/// The value in the middle of each triangle as a constant on it: what not finding the jump costs.
fem::Force middles(const mesh::Mesh& mesh, std::size_t example) {
  const auto at = [&](std::size_t t, std::size_t axis) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      sum += mesh.xy[2 * static_cast<std::size_t>(mesh.triangles[3 * t + k]) + axis];
    }
    return sum / 3;
  };
  auto values = std::make_shared<std::vector<double>>(mesh.triangle_count());
  for (std::size_t t = 0; t < values->size(); ++t) {
    (*values)[t] = at(t, 0) * (example == 1 ? at(t, 1) : -1) < 0 ? -1 : 1;
  }
  fem::Array array;
  array.per_triangle = true;
  array.values = values;
  return array;
}

/// Examples 2 and 4 jump on x = 0. Where edges follow that line the loads are those of constants;
/// where they cross it, the integral has to find it. What is left is the error of the mesh, 6e-5.
TEST(JumpingLoad, NeedsNoMeshThatFollowsIt) {
  for (const std::size_t example : {1U, 3U}) {
    const fem::Force force = fem::Expression{paper_forces[example]};
    const double following =
        solve(*factorise(graded_like_default(diagonals())), force).inclusions.at(0).displacement;
    double moved = 0, moved_carelessly = 0;
    for (const unsigned seed : {1U, 2U, 3U}) {
      const auto op = factorise(graded_like_default(shaken(seed)));
      const double a = solve(*op, force).inclusions.at(0).displacement;
      const double careless =
          solve(*op, middles(op->mesh(), example)).inclusions.at(0).displacement;
      std::printf(
          "[ figures  ] example %zu: A %.8f on a mesh that follows the jump, %.8f on one "
          "that does not (seed %u), there %.8f with the values in the middles\n",
          example + 1, following, a, seed, careless);
      EXPECT_NEAR(a, following, 6e-5);
      moved += std::abs(a - following);
      moved_carelessly += std::abs(careless - following);
    }
    EXPECT_GT(moved_carelessly, 5 * moved);  // else this test could not tell
  }
}

}  // namespace
}  // namespace anticrack::accuracy
