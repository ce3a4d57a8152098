// SPDX-License-Identifier: GPL-3.0-or-later
//
// One r after another: what came before changes the steps, and no bit of an answer.
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "contact/dense_lcp.hpp"
#include "contact/random_problems.hpp"
#include "support/random_seed.hpp"

namespace anticrack::contact {
namespace {

using anticrack::testing::random_spd;
using anticrack::testing::random_vector;
using anticrack::testing::same_bits;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void expect_same(const LcpAnswer& answer, const LcpAnswer& wanted) {
  ASSERT_EQ(answer.status, LcpStatus::solved);
  ASSERT_EQ(wanted.status, LcpStatus::solved);
  EXPECT_EQ(answer.closed, wanted.closed);
  EXPECT_EQ(answer.pressed, wanted.pressed);
  EXPECT_TRUE(same_bits(answer.d, wanted.d));
  EXPECT_TRUE(same_bits(answer.lambda, wanted.lambda));
  EXPECT_EQ(answer.residual, wanted.residual);
  EXPECT_LT(answer.residual, 1e-10);
}

/// A walk through loads near each other and far apart, with zero and repeated ones; without and
/// with a row of G.
TEST(LcpSequence, HasTheAnswersOfEachAloneWhateverCameBefore) {
  const unsigned seed = testing::random_seed();
  std::printf("[ seed     ] %u\n", seed);
  std::mt19937 random(seed);
  long steps = 0, cold = 0;
  for (int k = 0; k < 60; ++k) {
    const Index n = 2 + k % 25;
    std::vector<ddm::Terms> rows;
    if (k % 3 == 0) rows.push_back({{0, 1.0}, {static_cast<std::int32_t>(n) - 1, -0.5}});
    const DenseLcp lcp(random_spd(random, n, 1.0), rows);
    LcpSequence sequence(lcp, {}, {});
    VectorXd r = random_vector(random, n);
    for (int row = 0; row < 30; ++row) {
      switch (row % 5) {
        case 0:
          r = random_vector(random, n);
          break;
        case 1:
          break;
        case 2:
          r = row == 12 ? VectorXd::Zero(n) : VectorXd(-r);
          break;
        default:
          r += 0.05 * random_vector(random, n);
      }
      const LcpAnswer& answer = sequence.solve(r, {});
      const LcpAnswer alone = lcp.solve(r, {}, {}, {});
      expect_same(answer, alone);
      steps += answer.steps;
      cold += alone.steps;
      if (row % 5 == 1 && rows.empty()) {
        EXPECT_EQ(answer.steps, 1);
      }
    }
  }
  std::printf("[ figures  ] %ld steps, from all closed %ld\n", steps, cold);
  EXPECT_LT(steps, cold);
}

/// Three parts held by each other's contact alone: S is singular on all nodes together.
TEST(LcpSequence, SaysWhatSlidesOffAndGoesOn) {
  MatrixXd s(3, 3);
  s << 2, -1, -1, -1, 2, -1, -1, -1, 2;
  const DenseLcp lcp(s);
  const VectorXd pulled = Eigen::Vector3d(1, 1, 1), held = Eigen::Vector3d(1, -0.5, -2);
  const std::vector<char> open(3, 0);
  for (const std::vector<char>& start : {std::vector<char>(), open}) {
    LcpSequence sequence(lcp, {}, start);
    EXPECT_EQ(sequence.solve(pulled, pulled).status, LcpStatus::unbounded);
    expect_same(sequence.solve(held, {}), lcp.solve(held, {}, {}, {}));
    EXPECT_EQ(sequence.solve(pulled, pulled).status, LcpStatus::unbounded);
  }
}

TEST(LcpSequence, EndsAtItsLimitOfStepsAndGoesOn) {
  std::mt19937 random(11);
  const DenseLcp lcp(random_spd(random, 20, 1));
  const VectorXd r = random_vector(random, 20), pressed = -VectorXd::Ones(20);
  LcpOptions options;
  options.max_steps = 1;
  LcpSequence sequence(lcp, options, {});
  EXPECT_EQ(sequence.solve(r, {}).status, LcpStatus::step_limit);
  EXPECT_EQ(sequence.answer().steps, 1);
  expect_same(sequence.solve(pressed, {}), lcp.solve(pressed, {}, {}, {}));
}

}  // namespace
}  // namespace anticrack::contact
