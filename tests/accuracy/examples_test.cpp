// SPDX-License-Identifier: GPL-3.0-or-later
//
// Examples 1 to 4 of the paper on meshes graded towards the tips.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "accuracy/base_meshes.hpp"
#include "accuracy/paper_limits.hpp"
#include "accuracy/sequence.hpp"
#include "mesh/refine.hpp"

namespace anticrack::accuracy {
namespace {

constexpr double m = 0.2;  // the default

struct Row {
  double h0 = 0;
  std::size_t triangles = 0;
  std::array<double, 4> a{}, energy{}, contact{};
};

Row solve_examples(mesh::Mesh mesh, double h0) {
  const auto op = factorise(std::move(mesh));
  Row row;
  row.h0 = h0;
  row.triangles = op->mesh().triangle_count();
  for (std::size_t i = 0; i < 4; ++i) {
    const contact::Answer answer = solve(*op, fem::Expression{paper_forces[i]});
    row.a[i] = answer.inclusions.at(0).displacement;
    row.energy[i] = answer.energy;
    row.contact[i] = answer.contact_length;
  }
  return row;
}

/// Where the last two values lead, their errors in the ratio of h0^2 `unsaturated`.
double extrapolated(const std::vector<Row>& rows, double coarse, double fine) {
  const double h = rows.back().h0;
  const double ratio = 4 * unsaturated(2 * h, m) / unsaturated(h, m);
  return fine + (fine - coarse) / (ratio - 1);
}

const std::vector<Row>& rows() {
  static const auto made = [] {
    std::vector<Row> sequence;
    for (double h0 = 0.2; h0 > 0.02; h0 /= 2) {
      sequence.push_back(solve_examples(mesh::grade(diagonals(), {h0, m, 0}, 2'000'000), h0));
    }
    return sequence;
  }();
  return made;
}

double off(double value, double limit) { return std::abs(value - limit) / std::abs(limit); }

/// Saturation alone (see `unsaturated`) makes the mean rate of A 1.8 here. In Examples 2 and 4 the
/// end of the contact moves from node to node besides, which A feels to the same order with either
/// sign.
TEST(PaperExamples, ConvergeToValuesThatDoNotDependOnTheMesh) {
  for (std::size_t i = 0; i < 4; ++i) {
    std::printf(
        "[ figures  ] example %zu, f = %s\n"
        "[ figures  ]   h0   triangles          A  off by    energy      off by  contact\n",
        i + 1, paper_forces[i]);
    for (const Row& row : rows()) {
      std::printf("[ figures  ] %6.4f %9zu  %.8f %.1e  %.8f %.1e  %.6f\n", row.h0, row.triangles,
                  row.a[i], off(row.a[i], a_limits[i]), row.energy[i],
                  off(row.energy[i], energy_limits[i]), row.contact[i]);
    }
    const Row &coarse = rows()[rows().size() - 2], &fine = rows().back();
    const double a = extrapolated(rows(), coarse.a[i], fine.a[i]);
    const double energy = extrapolated(rows(), coarse.energy[i], fine.energy[i]);
    std::printf("[ figures  ] extrapolated     %.8f %.1e  %.8f %.1e\n", a, off(a, a_limits[i]),
                energy, off(energy, energy_limits[i]));
    EXPECT_LT(off(a, a_limits[i]), 2e-4);
    EXPECT_LT(off(energy, energy_limits[i]), 1e-4);
    const double halvings = static_cast<double>(rows().size() - 1);
    const double rate_of_a = rate(rows()[0].a[i] - a_limits[i], fine.a[i] - a_limits[i]) / halvings;
    const double rate_of_energy =
        rate(rows()[0].energy[i] - energy_limits[i], fine.energy[i] - energy_limits[i]) / halvings;
    std::printf("[ figures  ] mean rate of A %.2f, of the energy %.2f\n", rate_of_a,
                rate_of_energy);
    EXPECT_GT(rate_of_a, 1.5);
    EXPECT_GT(rate_of_energy, 1.75);
    EXPECT_LT(off(fine.a[i], a_limits[i]), 4e-4);
  }
}

/// With a node near the end of the contact and the mesh graded towards it as well, the rates of A
/// are those of saturation from one mesh to the next: 1.69 and 1.82.
TEST(PaperExamples, SecondAndFourthHaveSteadyRatesWhereTheEndOfContactIsResolved) {
  mesh::Mesh base = diagonals();
  std::vector<std::int32_t> centres = mesh::tips(base);
  for (const std::int32_t node : base.interfaces[0].nodes) {
    double& x = base.xy[2 * static_cast<std::size_t>(node)];
    if (x == -0.25) {
      x = -0.171875;
      centres.push_back(node);
    }
  }
  std::vector<Row> sequence;
  for (double h0 = 0.2; h0 > 0.04; h0 /= 2) {
    sequence.push_back(solve_examples(mesh::grade(base, centres, {h0, m, 0}, 2'000'000), h0));
    for (const std::size_t i : {1U, 3U}) {
      const Row& fine = sequence.back();
      const Row& coarse = sequence[sequence.size() > 1 ? sequence.size() - 2 : 0];
      const double found = rate(coarse.a[i] - a_limits[i], fine.a[i] - a_limits[i]);
      std::printf(
          "[ figures  ] end of contact resolved, h0 = %.2f, %zu triangles, example %zu: A "
          "%.8f (%.1e), rate %.2f\n",
          h0, fine.triangles, i + 1, fine.a[i], off(fine.a[i], a_limits[i]), found);
      if (sequence.size() > 1) {
        EXPECT_GT(found, 1.6);
        EXPECT_LT(found, 2.0);
      }
    }
  }
}

/// The figures this is held to.
TEST(PaperExamples, ThirdIsRightToHalfAPercentAtTheCostOfThePapersMesh) {
  for (const Row& row : rows()) {
    if (row.triangles <= 20'000 && row.h0 < 0.15) {
      EXPECT_LT(off(row.a[2], 0.10383), 4e-3);
      EXPECT_LT(off(row.energy[2], -0.170034), 4e-3);
    } else if (row.h0 < 0.15) {
      EXPECT_LT(off(row.a[2], 0.10383), 1e-3);
      EXPECT_LT(off(row.energy[2], -0.170034), 1e-3);
    }
  }
  EXPECT_LE(rows().at(1).triangles, 20'000U);
  EXPECT_LE(rows().at(2).triangles, 80'000U);
  EXPECT_EQ(rows().at(2).contact[2], 0);
}

/// The mesher's own meshes, as a user gets them.
TEST(PaperExamples, ThirdIsAsGoodOnTheMeshesOfTheService) {
  struct Aim {
    double h0;
    std::size_t triangles;
    double tolerance;
  };
  constexpr double chosen = 0;  // what a case gets that says nothing
  for (const Aim& aim :
       {Aim{chosen, 12'000, 5e-3}, Aim{0.105, 20'000, 4e-3}, Aim{0.05, 80'000, 1e-3}}) {
    const Row row = solve_examples(generated(aim.h0), aim.h0);
    std::printf("[ figures  ] generated, h0 = %.3f, %zu triangles:", row.h0, row.triangles);
    for (std::size_t i = 0; i < 4; ++i) {
      std::printf(" A%zu %.8f (%.1e)", i + 1, row.a[i], off(row.a[i], a_limits[i]));
    }
    std::printf("; energy of 3 %.8f\n", row.energy[2]);
    EXPECT_LE(row.triangles, aim.triangles);
    EXPECT_LT(off(row.a[2], 0.10383), aim.tolerance);
    EXPECT_LT(off(row.energy[2], -0.170034), aim.tolerance);
  }
}

}  // namespace
}  // namespace anticrack::accuracy
