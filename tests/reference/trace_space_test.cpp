// SPDX-License-Identifier: GPL-3.0-or-later
//
// The iterates in trace space against the full-field twin, on the paper's mesh and examples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "contact/uzawa.hpp"
#include "reference/full_field_uzawa.hpp"
#include "support/paper_mesh.hpp"
#include "support/recovered.hpp"
#include "support/trace_space.hpp"

namespace anticrack::reference {
namespace {

using contact::Mass;

/// Largest difference of a subdomain's field from the twin's, over the twin's largest value.
double field_difference(const ddm::Subdomain& subdomain, const Eigen::VectorXd& u,
                        const Vector& twin) {
  Real difference = 0, scale = 0;
  for (std::size_t i = 0; i < subdomain.node.size(); ++i) {
    const Real expected = twin[subdomain.node[i]];
    difference = std::max(difference, std::abs(u[static_cast<Eigen::Index>(i)] - expected));
    scale = std::max(scale, std::abs(expected));
  }
  return static_cast<double>(difference / scale);
}

double multiplier_difference(const ddm::Decomposition& decomposition, const Eigen::VectorXd& mu,
                             const Vector& twin) {
  Real difference = 0;
  for (std::size_t i = 0; i < decomposition.pairs.size(); ++i) {
    difference = std::max(
        difference, std::abs(mu[static_cast<Eigen::Index>(i)] - twin[decomposition.pairs[i].node]));
  }
  const Real scale = twin.lpNorm<Eigen::Infinity>();
  return static_cast<double>(scale == 0 ? difference : difference / scale);
}

double relative(double value, Real expected) {
  return static_cast<double>(std::abs(value / expected - 1));
}

struct Difference {
  double u1 = 0, u2 = 0, a = 0, mu = 0, energy = 0, criterion = 0;
};

struct Case {
  int example;
  Mass mass;
  bool to_the_end;  ///< compares the stop as well
};

class Iterates : public ::testing::TestWithParam<Case> {};

/// Relative differences over the first 200 iterations, everything to 1e-10. The criterion is the
/// one that comes near: it is a quotient of squared norms of increments, 7e-6 of u where it is
/// 5e-11, so rounding of 1e-15 in u is 3e-10 of an increment before the solves smooth it.
TEST_P(Iterates, AgreeWithTheFullFieldAndStopAtTheSameIteration) {
  constexpr int compared = 200, limit = 2000;
  constexpr double epsilon = 1e-12, tolerance = 1e-10;
  const auto [example, mass, to_the_end] = GetParam();
  const mesh::Mesh& mesh = *testing::paper_mesh();
  const fem::Force force = fem::Expression{testing::paper_forces[example - 1]};

  FullFieldUzawa twin(mesh, force, {2.0, 1e5, mass == Mass::lumped});
  const testing::TraceSpace space(mesh);
  const contact::TraceProblem problem(space.decomposition, space.operators);
  const std::vector<ddm::CondensedLoad> loads = space.condense(force);
  contact::Uzawa uzawa(problem, mass, 1);
  uzawa.start(0, loads, 2.0, 1e5);

  Difference worst;
  int stop = 0, twin_stop = 0;
  for (int k = 1; k <= compared || (to_the_end && k <= limit && (stop == 0 || twin_stop == 0));
       ++k) {
    twin.step();
    uzawa.step(1);
    const contact::Iterate& iterate = uzawa.iterate(0);
    ASSERT_EQ(iterate.number, k);
    stop = stop == 0 && iterate.criterion < epsilon ? k : stop;
    twin_stop = twin_stop == 0 && twin.criterion() < epsilon ? k : twin_stop;
    if (k > compared) {
      continue;
    }
    const auto recovered = [&](std::size_t s) {
      return anticrack::testing::recovered(space.operators[s], loads[s], uzawa.trace(0, s));
    };
    const auto& subdomains = space.decomposition.subdomains;
    worst.u1 = std::max(worst.u1, field_difference(subdomains[0], recovered(0), twin.u1()));
    worst.u2 = std::max(worst.u2, field_difference(subdomains[1], recovered(1), twin.u2()));
    worst.a = std::max(worst.a, relative(uzawa.displacement(0, 0), twin.a()));
    worst.mu =
        std::max(worst.mu, multiplier_difference(space.decomposition, uzawa.mu(0), twin.mu()));
    worst.energy = std::max(worst.energy, relative(iterate.energy, twin.energy()));
    worst.criterion = std::max(worst.criterion, relative(iterate.criterion, twin.criterion()));
  }
  std::printf(
      "[ figures  ] example %d, %s: stop %d / %d; worst relative difference in %d iterations: "
      "u1 %.1e u2 %.1e A %.1e mu %.1e energy %.1e criterion %.1e\n",
      example, mass == Mass::lumped ? "lumped" : "consistent", stop, twin_stop, compared, worst.u1,
      worst.u2, worst.a, worst.mu, worst.energy, worst.criterion);
  EXPECT_EQ(stop > compared, to_the_end);
  EXPECT_EQ(stop, twin_stop);
  EXPECT_LT(worst.u1, tolerance);
  EXPECT_LT(worst.u2, tolerance);
  EXPECT_LT(worst.a, tolerance);
  EXPECT_LT(worst.mu, tolerance);
  EXPECT_LT(worst.energy, tolerance);
  EXPECT_LT(worst.criterion, tolerance);
}

INSTANTIATE_TEST_SUITE_P(Paper, Iterates,
                         ::testing::Values(Case{1, Mass::lumped, true}, Case{2, Mass::lumped, true},
                                           Case{3, Mass::lumped, true}, Case{4, Mass::lumped, true},
                                           Case{3, Mass::consistent, false}),
                         [](const auto& named) {
                           return "Example" + std::to_string(named.param.example) +
                                  (named.param.mass == Mass::lumped ? "Lumped" : "Consistent");
                         });

}  // namespace
}  // namespace anticrack::reference
