// SPDX-License-Identifier: GPL-3.0-or-later
//
// Errors against solutions in closed form, and the rates at which they vanish.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "accuracy/base_meshes.hpp"
#include "accuracy/error_norms.hpp"
#include "accuracy/sequence.hpp"
#include "mesh/refine.hpp"
#include "mesh/refine_uniform.hpp"
#include "support/multipliers.hpp"

namespace anticrack::accuracy {
namespace {

constexpr double shift = 0.3;
constexpr std::size_t limit = 2'000'000;

struct Errors {
  double h = 0;
  std::size_t triangles = 0;
  double a = 0;
  double energy = 0;
  JumpError jump;
  double contact_length = 0;
};

Errors measure(mesh::Mesh mesh, double h, const testing::ExactSolution& exact) {
  const auto op = factorise(std::move(mesh));
  const contact::Answer answer = solve(*op, 0.0, exact.boundary, true);
  Errors errors;
  errors.h = h;
  errors.triangles = op->mesh().triangle_count();
  if (!answer.inclusions.empty()) {
    errors.a = std::abs(answer.inclusions[0].displacement - exact.displacement);
  }
  errors.energy = energy_error(op->mesh(), answer, exact);
  errors.jump = jump_error(op->mesh(), answer, exact);
  errors.contact_length = answer.contact_length;
  return errors;
}

void print(const char* title, const std::vector<Errors>& sequence) {
  std::printf(
      "[ figures  ] %s\n[ figures  ]     h0 triangles    error of A rate   energy norm rate"
      "      jump, L2 rate     jump, max rate\n",
      title);
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const Errors& fine = sequence[i];
    const Errors& coarse = sequence[i > 0 ? i - 1 : 0];
    std::printf(
        "[ figures  ] %6.4f %9zu  %12.3e %4.2f  %12.3e %4.2f   %12.3e %4.2f   %12.3e %4.2f\n",
        fine.h, fine.triangles, fine.a, fine.a > 0 ? rate(coarse.a, fine.a) : 0, fine.energy,
        rate(coarse.energy, fine.energy), fine.jump.l2, rate(coarse.jump.l2, fine.jump.l2),
        fine.jump.largest, rate(coarse.jump.largest, fine.jump.largest));
  }
}

/// Five meshes, h0 = 0.8 to 0.05: four refinements.
std::vector<Errors> graded(const mesh::Mesh& base, double m, const testing::ExactSolution& exact) {
  std::vector<Errors> sequence;
  for (double h0 = 0.8; h0 > 0.04; h0 /= 2) {
    sequence.push_back(measure(mesh::grade(base, {h0, m, 0}, limit), h0, exact));
  }
  return sequence;
}

std::vector<Errors> uniform(mesh::Mesh mesh, const testing::ExactSolution& exact) {
  std::vector<Errors> sequence;
  for (double h = 0.25; h > 0.01; h /= 2) {
    sequence.push_back(measure(mesh, h, exact));
    mesh = mesh::refine_uniform(mesh);
  }
  return sequence;
}

/// What coordinates of 1e-13 leave of u ~ r^{1/4} in the tip's own triangles.
const double tip_floor = 0.5 * std::pow(1e-13, 0.25);

/// At the left tip the exact solution has no r^{1/4} part. A mesh's error has one of either sign,
/// so a few nodes close there.
TEST(OpenInclusion, StronglyGradedHasTheRatesOfSmoothSolutions) {
  constexpr double m = 0.1;
  const auto sequence = graded(diagonals(), m, testing::open_inclusion(shift));
  print("open inclusion, m = 0.1", sequence);
  for (std::size_t i = 3; i < sequence.size(); ++i) {
    EXPECT_GT(rate(sequence[i - 1].energy, sequence[i].energy), 0.9);
    EXPECT_GT(rate(sequence[i - 1].a, sequence[i].a), 1.8);
    EXPECT_GT(rate(sequence[i - 1].jump.l2, sequence[i].jump.l2), 1.8);
  }
  for (const Errors& errors : sequence) {
    EXPECT_LT(errors.jump.largest, 0.06 * errors.h * errors.h + tip_floor);
    EXPECT_LT(errors.contact_length, 2e-4 * errors.h * errors.h);
  }
}

/// With the default grading the same rates are reached once what is not saturated yet is divided
/// out, see `unsaturated`.
TEST(OpenInclusion, DefaultGradingIsOnItsWayToTheSameRates) {
  constexpr double m = 0.2;
  const auto sequence = graded(diagonals(), m, testing::open_inclusion(shift));
  print("open inclusion, m = 0.2", sequence);
  for (std::size_t i = 3; i < sequence.size(); ++i) {
    const Errors &coarse = sequence[i - 1], &fine = sequence[i];
    const double growth = rate(unsaturated(coarse.h, m), unsaturated(fine.h, m));
    std::printf("[ figures  ] h0 = %.2f to %.2f: without saturation A %.2f, energy norm %.2f\n",
                coarse.h, fine.h, rate(coarse.a, fine.a) - growth,
                rate(coarse.energy, fine.energy) - 0.5 * growth);
    EXPECT_GT(rate(coarse.a, fine.a), 1.6);
    EXPECT_GT(rate(coarse.energy, fine.energy), 0.82);
    EXPECT_GT(rate(coarse.a, fine.a) - growth, 1.9);
    EXPECT_GT(rate(coarse.energy, fine.energy) - 0.5 * growth, 0.95);
  }
}

TEST(OpenInclusion, UniformShowsTheExponentOfTheTip) {
  const auto sequence = uniform(diagonals(), testing::open_inclusion(shift));
  print("open inclusion, uniform", sequence);
  for (std::size_t i = 2; i < sequence.size(); ++i) {
    EXPECT_NEAR(rate(sequence[i - 1].energy, sequence[i].energy), 0.25, 0.05);
    EXPECT_NEAR(rate(sequence[i - 1].a, sequence[i].a), 0.5, 0.1);
  }
}

TEST(OpenCrack, GradedHasTheRatesOfSmoothSolutions) {
  const auto sequence = graded(diagonals(mesh::Kind::crack), 0.2, testing::open_crack(0.8));
  print("open crack, m = 0.2", sequence);
  for (std::size_t i = 3; i < sequence.size(); ++i) {
    EXPECT_GT(rate(sequence[i - 1].energy, sequence[i].energy), 0.9);
    EXPECT_GT(rate(sequence[i - 1].jump.l2, sequence[i].jump.l2), 1.8);
    EXPECT_GT(rate(sequence[i - 1].jump.largest, sequence[i].jump.largest), 1.7);
  }
}

TEST(OpenCrack, UniformShowsTheExponentOfTheTip) {
  const auto sequence = uniform(diagonals(mesh::Kind::crack), testing::open_crack(0.8));
  print("open crack, uniform", sequence);
  for (std::size_t i = 2; i < sequence.size(); ++i) {
    EXPECT_NEAR(rate(sequence[i - 1].energy, sequence[i].energy), 0.5, 0.05);
  }
}

class ClosedCrack : public ::testing::TestWithParam<mesh::Kind> {};

/// The pressure of a node is its force by its share of length, so its digits go with the size of
/// the edges: 1e-16 / 1e-13 at a tip. Forces have all of theirs.
TEST_P(ClosedCrack, IsExactOnEveryMesh) {
  constexpr double c = 0.7;
  const bool rigid = GetParam() == mesh::Kind::delaminated;
  const auto exact = testing::closed_crack(c, shift);
  for (const double h0 : {0.4, 0.2, 0.1}) {
    const auto op = factorise(mesh::grade(diagonals(GetParam()), {h0, 0.2, 0}, limit));
    const contact::Answer answer = solve(*op, 0.0, exact.boundary, true);
    const mesh::Mesh& mesh = op->mesh();
    double field = 0, force = 0, pressure = 0;
    for (const contact::Field& part : answer.fields) {
      for (std::size_t i = 0; i < part.nodes.size(); ++i) {
        const double y = mesh.xy[2 * static_cast<std::size_t>(part.nodes[i]) + 1];
        field = std::max(field, std::abs(part.u[i] - (shift - c * y)));
      }
    }
    const contact::Trace& trace = answer.traces.at(0);
    const contact::TraceGeometry& at = op->trace_geometry().at(0);
    const std::vector<double> mu = testing::multipliers(trace);
    std::size_t closed = 0, nodes = 0;
    for (std::size_t i = 1; i + 1 < at.x.size(); ++i) {
      const double share = 0.5 * (at.s[i + 1] - at.s[i - 1]);
      force = std::max(force, share * std::abs(mu[i] - c));
      if (share > 1e-3) {
        pressure = std::max(pressure, std::abs(mu[i] - c));
      }
      const bool inside = std::abs(at.x[i]) < testing::crack_end;
      nodes += inside ? 1 : 0;
      closed += inside && trace.contact[i] != 0 ? 1 : 0;
    }
    const double energy = std::abs(answer.energy - 2 * c * c);
    std::printf(
        "[ figures  ] closed %s, h0 = %.1f, %zu triangles: error of u %.1e, of nodal forces "
        "%.1e, of the pressure %.1e, of the energy %.1e; %zu of %zu nodes closed\n",
        rigid ? "inclusion" : "crack", h0, mesh.triangle_count(), field, force, pressure, energy,
        closed, nodes);
    EXPECT_LT(field, 1e-12);
    EXPECT_LT(force, 1e-12);
    EXPECT_LT(pressure, 1e-9);
    EXPECT_LT(energy, 1e-12);
    EXPECT_EQ(closed, nodes);
    if (rigid) {
      EXPECT_NEAR(answer.inclusions.at(0).displacement, shift, 1e-12);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ClosedCrack,
                         ::testing::Values(mesh::Kind::crack, mesh::Kind::delaminated),
                         [](const auto& named) {
                           return named.param == mesh::Kind::crack ? "Crack" : "Inclusion";
                         });

}  // namespace
}  // namespace anticrack::accuracy
