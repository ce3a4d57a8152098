// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/warm_lcp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

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

constexpr int many = 1000;

LcpAnswer plain(const DenseLcp& lcp, const VectorXd& r) {
  return lcp.solve(r, r.cwiseAbs(), {}, {}, [](const LcpStep&) { return true; });
}

void expect_same(const WarmLcp& warm, const LcpAnswer& wanted) {
  ASSERT_EQ(wanted.status, LcpStatus::solved);
  EXPECT_EQ(warm.closed(), wanted.closed);
  EXPECT_LE((warm.d() - wanted.d).norm(), 1e-10 * wanted.d.norm());
  EXPECT_LE((warm.lambda() - wanted.lambda).norm(), 1e-10 * wanted.lambda.norm());
  for (Index i = 0; i < warm.d().size(); ++i) {
    EXPECT_GE(warm.d()[i], 0);
    EXPECT_GE(warm.lambda()[i], 0);
    EXPECT_TRUE(warm.d()[i] == 0 || warm.lambda()[i] == 0);
  }
  EXPECT_LT(warm.residual(), 1e-10);
}

/// A walk through loads near each other and far apart, with zero and repeated ones.
TEST(WarmLcp, IsThePlainAnswerWhateverCameBefore) {
  const unsigned seed = testing::random_seed();
  std::printf("[ seed     ] %u\n", seed);
  std::mt19937 random(seed);
  long steps = 0, cold = 0;
  for (int k = 0; k < 40; ++k) {
    const Index n = 1 + k % 25;
    const DenseLcp lcp(random_spd(random, n, 1.0));
    WarmLcp warm(lcp, many, {});
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
      ASSERT_EQ(warm.solve(r, r.cwiseAbs()), LcpStatus::solved);
      const LcpAnswer wanted = plain(lcp, r);
      expect_same(warm, wanted);
      steps += warm.steps();
      cold += wanted.steps;
      if (row % 5 == 1) {
        EXPECT_EQ(warm.steps(), 1);
      }
    }
  }
  std::printf("[ figures  ] %ld steps, from all closed %ld\n", steps, cold);
  EXPECT_LT(steps, cold);
}

TEST(WarmLcp, StartsChangeNoBit) {
  const unsigned seed = testing::random_seed();
  std::printf("[ seed     ] %u\n", seed);
  std::mt19937 random(seed);
  for (int k = 0; k < 200; ++k) {
    const Index n = 1 + k % 30;
    const DenseLcp lcp(random_spd(random, n, k % 3 == 0 ? 1e-3 : 1.0));
    const VectorXd r = random_vector(random, n);
    WarmLcp closed(lcp, many, {});
    ASSERT_EQ(closed.solve(r, r.cwiseAbs()), LcpStatus::solved);
    for (int other = 0; other < 4; ++other) {
      std::vector<char> start(static_cast<std::size_t>(n));
      for (char& node : start) {
        node = static_cast<char>(random() % 2);
      }
      WarmLcp warm(lcp, many, start);
      if (other == 3) {
        const VectorXd before = random_vector(random, n);
        ASSERT_EQ(warm.solve(before, before.cwiseAbs()), LcpStatus::solved);
      }
      ASSERT_EQ(warm.solve(r, r.cwiseAbs()), LcpStatus::solved);
      EXPECT_EQ(warm.closed(), closed.closed());
      EXPECT_TRUE(same_bits(warm.d(), closed.d()));
      EXPECT_TRUE(same_bits(warm.lambda(), closed.lambda()));
      EXPECT_EQ(warm.residual(), closed.residual());
    }
  }
}

/// Curtis, Han and Robinson (2015): the plain primal-dual method goes round for ever.
TEST(WarmLcp, LeavesACircleFromAnyStart) {
  MatrixXd s(3, 3);
  s << 4, 5, -5, 5, 9, -5, -5, -5, 7;
  const DenseLcp lcp(s);
  int round = 0;
  for (int k = 0; k < 343; ++k) {
    const VectorXd r = Eigen::Vector3i(k % 7 - 3, k / 7 % 7 - 3, k / 49 - 3).cast<double>();
    const LcpAnswer wanted = plain(lcp, r);
    round += wanted.fell_back ? 1 : 0;
    for (int start = 0; start < 8; ++start) {
      const char closed[] = {static_cast<char>(start & 1), static_cast<char>(start >> 1 & 1),
                             static_cast<char>(start >> 2)};
      WarmLcp warm(lcp, many, closed);
      ASSERT_EQ(warm.solve(r, r.cwiseAbs()), LcpStatus::solved);
      expect_same(warm, wanted);
    }
  }
  EXPECT_GT(round, 0);
}

/// Three parts held by each other's contact alone: S is singular on all nodes together.
TEST(WarmLcp, SaysWhatSlidesOffAndGoesOn) {
  MatrixXd s(3, 3);
  s << 2, -1, -1, -1, 2, -1, -1, -1, 2;
  const DenseLcp lcp(s);
  const VectorXd pulled = Eigen::Vector3d(1, 1, 1), held = Eigen::Vector3d(1, -0.5, -2);
  const std::vector<char> open(3, 0);
  for (const std::vector<char>& start : {std::vector<char>(), open}) {
    WarmLcp warm(lcp, many, start);
    EXPECT_EQ(warm.solve(pulled, pulled), LcpStatus::unbounded);
    ASSERT_EQ(warm.solve(held, held.cwiseAbs()), LcpStatus::solved);
    expect_same(warm, plain(lcp, held));
    EXPECT_EQ(warm.solve(pulled, pulled), LcpStatus::unbounded);
  }
}

TEST(WarmLcp, EndsAtItsLimitOfSteps) {
  std::mt19937 random(11);
  const DenseLcp lcp(random_spd(random, 20, 1));
  const VectorXd r = random_vector(random, 20);
  WarmLcp warm(lcp, 1, {});
  EXPECT_EQ(warm.solve(r, r.cwiseAbs()), LcpStatus::step_limit);
  EXPECT_EQ(warm.steps(), 1);
  // As an answer to another load it starts from what it came to.
  const VectorXd pressed = -VectorXd::Ones(20);
  WarmLcp closed(lcp, 1, {});
  EXPECT_EQ(closed.solve(pressed, -pressed), LcpStatus::solved);
}

TEST(WarmLcp, NoContactsAreSolved) {
  const DenseLcp lcp(MatrixXd(0, 0));
  WarmLcp warm(lcp, 1, {});
  EXPECT_EQ(warm.solve(VectorXd(0), VectorXd(0)), LcpStatus::solved);
  EXPECT_EQ(warm.residual(), 0);
}

}  // namespace
}  // namespace anticrack::contact
