// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/dense_lcp.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>
#include <utility>

#include "base/at_once.hpp"
#include "contact/dense.hpp"
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

LcpAnswer solve(const MatrixXd& s, const VectorXd& r, bool monotone_only = false,
                const std::vector<char>& start = {}) {
  LcpOptions options;
  options.monotone_only = monotone_only;
  return DenseLcp(s).solve(r, {}, options, start);
}

TEST(Dense, PartsDoNotDependOnTheNumberOfThreads) {
  const Index n = 300;  // in four parts
  std::mt19937 random(testing::random_seed());
  const MatrixXd h = random_spd(random, n, 1), b = MatrixXd::Random(n, n);
  const auto work = [&](int threads) {
    const base::Threads allowed(threads);
    MatrixXd factor = h, x = b, s = h;
    EXPECT_TRUE(cholesky(factor));
    solve_lower(factor, x);
    subtract_square(x, s);
    solve_lower_transposed(factor, x);
    return std::pair(x, MatrixXd(s.triangularView<Eigen::Lower>()));
  };
  const auto [x, s] = work(1);
  EXPECT_LT((h * x - b).norm(), 1e-10 * h.norm() * x.norm());
  EXPECT_LT((s - MatrixXd((h - b.transpose() * x).triangularView<Eigen::Lower>())).norm(),
            1e-10 * (h.norm() + b.norm() * x.norm()));
  EXPECT_EQ(work(3), std::pair(x, s));
}

/// The conditions themselves, relative to unit diagonal and unit load.
void expect_solution(const MatrixXd& s, const VectorXd& r, const LcpAnswer& answer,
                     double tolerance = 1e-10) {
  ASSERT_EQ(answer.status, LcpStatus::solved);
  const VectorXd lambda = s * answer.d - r;
  const VectorXd root = s.diagonal().cwiseSqrt();
  const double unit = std::max(r.cwiseQuotient(root).lpNorm<Eigen::Infinity>(), 1e-300);
  for (Index i = 0; i < r.size(); ++i) {
    EXPECT_GE(answer.d[i], 0);
    EXPECT_GE(answer.lambda[i], 0);
    EXPECT_TRUE(answer.d[i] == 0 || answer.lambda[i] == 0) << i;
    EXPECT_EQ(answer.closed[static_cast<std::size_t>(i)] != 0, answer.d[i] == 0) << i;
    EXPECT_NEAR(lambda[i] / root[i] / unit, answer.lambda[i] / root[i] / unit, tolerance) << i;
  }
}

TEST(DenseLcp, SolvesRandomProblemsBothWaysFromAnyStartToTheSameBits) {
  const unsigned seed = testing::random_seed();
  std::printf("[ seed     ] %u\n", seed);
  std::mt19937 random(seed);
  int fell_back = 0;
  for (int k = 0; k < 300; ++k) {
    const Index n = 1 + k % 25;
    // A small ridge makes it ill-conditioned, and far from the M-matrices of contact.
    const MatrixXd s = random_spd(random, n, k % 3 == 0 ? 1e-3 : 1.0);
    const VectorXd r = random_vector(random, n);
    const LcpAnswer answer = solve(s, r);
    expect_solution(s, r, answer);
    fell_back += answer.fell_back ? 1 : 0;
    expect_solution(s, r, solve(s, r, true));
    std::vector<char> start(static_cast<std::size_t>(n));
    for (char& closed : start) {
      closed = static_cast<char>(random() % 2);
    }
    for (const bool monotone : {false, true}) {
      const LcpAnswer other = solve(s, r, monotone, start);
      EXPECT_EQ(answer.closed, other.closed);
      EXPECT_TRUE(same_bits(answer.d, other.d));
      EXPECT_TRUE(same_bits(answer.lambda, other.lambda));
    }
  }
  std::printf("[ figures  ] %d of 300 fell back\n", fell_back);
}

/// What is tied has d = 0 and no lambda, and the others are solved as if it were not there.
TEST(DenseLcp, TiedNodesAreAsIfTheyWereNotThere) {
  const unsigned seed = testing::random_seed();
  std::printf("[ seed     ] %u\n", seed);
  std::mt19937 random(seed);
  int pulled = 0;
  for (int k = 0; k < 200; ++k) {
    const Index n = 2 + k % 25;
    const MatrixXd s = random_spd(random, n, 1.0);
    const VectorXd r = random_vector(random, n);
    std::vector<char> tied(static_cast<std::size_t>(n));
    std::vector<Index> loose;
    for (Index i = 0; i < n; ++i) {
      tied[static_cast<std::size_t>(i)] = random() % 2 == 0 ? 1 : 0;
      if (tied[static_cast<std::size_t>(i)] == 0) loose.push_back(i);
    }
    for (const bool monotone : {false, true}) {
      LcpOptions options;
      options.monotone_only = monotone;
      options.tied = tied;
      const std::vector<char> open(static_cast<std::size_t>(n), 0);
      const LcpAnswer answer = DenseLcp(s).solve(r, {}, options, open);
      const LcpAnswer rest = solve(s(loose, loose), r(loose));
      ASSERT_EQ(answer.status, LcpStatus::solved);
      EXPECT_LT(answer.residual, 1e-12);
      for (Index i = 0; i < n; ++i) {
        if (tied[static_cast<std::size_t>(i)] == 0) continue;
        EXPECT_EQ(answer.d[i], 0);
        EXPECT_EQ(answer.lambda[i], 0);
        pulled += (s * answer.d - r)[i] < 0 ? 1 : 0;
      }
      const double size = r.lpNorm<Eigen::Infinity>();
      for (std::size_t i = 0; i < loose.size(); ++i) {
        EXPECT_NEAR(answer.d[loose[i]], rest.d[static_cast<Index>(i)], 1e-10 * size);
        EXPECT_NEAR(answer.lambda[loose[i]], rest.lambda[static_cast<Index>(i)], 1e-10 * size);
      }
    }
  }
  EXPECT_GT(pulled, 100);
}

TEST(DenseLcp, IsNotMisledByScale) {
  const unsigned seed = testing::random_seed();
  std::printf("[ seed     ] %u\n", seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> exponent(-6, 6);
  for (int k = 0; k < 100; ++k) {
    const Index n = 1 + k % 20;
    const VectorXd scale =
        VectorXd::NullaryExpr(n, [&] { return std::pow(10.0, exponent(random)); });
    const MatrixXd s = scale.asDiagonal() * random_spd(random, n, 1) * scale.asDiagonal();
    const VectorXd r = scale.cwiseProduct(random_vector(random, n));
    expect_solution(s, r, solve(s, r));
  }
}

TEST(DenseLcp, LoadsOfAnySizeGiveTheSameSet) {
  std::mt19937 random(7);
  const MatrixXd s = random_spd(random, 12, 1);
  const VectorXd r = random_vector(random, 12);
  const LcpAnswer one = solve(s, r);
  for (const double factor : {std::ldexp(1.0, -660), std::ldexp(1.0, 660)}) {
    const LcpAnswer answer = solve(s, VectorXd(factor * r));
    EXPECT_EQ(answer.status, LcpStatus::solved);
    EXPECT_EQ(answer.closed, one.closed);
    EXPECT_TRUE(same_bits(answer.d, VectorXd(factor * one.d)));
  }
}

/// Curtis, Han and Robinson (2015): the plain primal-dual method goes round for ever.
TEST(DenseLcp, LeavesACycleFromAnyStart) {
  MatrixXd s(3, 3);
  s << 4, 5, -5, 5, 9, -5, -5, -5, 7;
  int fell_back = 0;
  for (int k = 0; k < 343; ++k) {
    const VectorXd r = Eigen::Vector3i(k % 7 - 3, k / 7 % 7 - 3, k / 49 - 3).cast<double>();
    const LcpAnswer answer = solve(s, r);
    expect_solution(s, r, answer);
    fell_back += answer.fell_back ? 1 : 0;
    for (int start = 0; start < 8; ++start) {
      const std::vector<char> closed = {static_cast<char>(start & 1),
                                        static_cast<char>(start >> 1 & 1),
                                        static_cast<char>(start >> 2)};
      EXPECT_TRUE(same_bits(solve(s, r, false, closed).d, answer.d));
    }
  }
  std::printf("[ figures  ] %d of 343 loads go round\n", fell_back);
  EXPECT_GT(fell_back, 0);
}

TEST(DenseLcp, ZeroLoadIsClosedAndWeaklyActiveEverywhere) {
  std::mt19937 random(3);
  const LcpAnswer answer = solve(random_spd(random, 5, 1), VectorXd::Zero(5));
  EXPECT_EQ(answer.status, LcpStatus::solved);
  EXPECT_EQ(answer.steps, 1);
  EXPECT_EQ(answer.weakly_active, 5);
  EXPECT_EQ(answer.d.norm() + answer.lambda.norm(), 0);
}

/// r is the rounding of a sum of terms of size 1: it says nothing.
TEST(DenseLcp, RoundingDoesNotOpenANode) {
  std::mt19937 random(3);
  const MatrixXd s = random_spd(random, 6, 1);
  const VectorXd r = 1e-16 * random_vector(random, 6);
  const VectorXd terms = s.diagonal().cwiseSqrt();
  const LcpAnswer answer = DenseLcp(s).solve(r, terms, {}, {});
  EXPECT_EQ(answer.weakly_active, 6);
  EXPECT_EQ(answer.closed, std::vector<char>(6, 1));
}

TEST(DenseLcp, WeaklyActiveNodesAreCountedAndClosed) {
  std::mt19937 random(11);
  const Index n = 9;
  const MatrixXd s = random_spd(random, n, 1);
  VectorXd d = VectorXd::Zero(n), lambda = VectorXd::Zero(n);
  for (Index i = 0; i < n; ++i) {
    (i % 3 == 0 ? d : lambda)[i] = i % 3 == 2 ? 0 : 1;  // every third has neither
  }
  const VectorXd r = s * d - lambda;
  const LcpAnswer answer = solve(s, r);
  expect_solution(s, r, answer);
  EXPECT_EQ(answer.weakly_active, 3);
  const LcpAnswer other = solve(s, r, false, std::vector<char>(static_cast<std::size_t>(n), 0));
  EXPECT_TRUE(same_bits(answer.d, other.d));
}

/// Two parts that hold each other by contact only: S has a null vector of one sign.
TEST(DenseLcp, SemidefiniteIsSolvedWhenPressedTogetherAndUnboundedWhenPulledApart) {
  const unsigned seed = testing::random_seed();
  std::printf("[ seed     ] %u\n", seed);
  std::mt19937 random(seed);
  for (int k = 0; k < 50; ++k) {
    const Index n = 2 + k % 10;
    MatrixXd s = random_spd(random, n, 1);
    const VectorXd one = VectorXd::Ones(n);
    const VectorXd s_one = s * one;
    s -= s_one * s_one.transpose() / one.dot(s_one);  // s one = 0
    s = (s + s.transpose()).eval() / 2;
    VectorXd r = random_vector(random, n);
    r -= one * ((r.sum() + 0.5) / static_cast<double>(n));  // r'one = -0.5
    for (const bool monotone : {false, true}) {
      const LcpAnswer pressed = solve(s, r, monotone);
      expect_solution(s, r, pressed, 1e-9);
      EXPECT_EQ(solve(s, VectorXd(r + one), monotone).status, LcpStatus::unbounded);
    }
  }
}

TEST(DenseLcp, StopsAtTheLimitAndWhenTold) {
  std::mt19937 random(5);
  const MatrixXd s = random_spd(random, 20, 1e-3);
  const VectorXd r = random_vector(random, 20);
  LcpOptions options;
  options.max_steps = 1;
  EXPECT_EQ(DenseLcp(s).solve(r, {}, options, {}).status, LcpStatus::step_limit);
  options.max_steps = 1000;
  const LcpAnswer told =
      DenseLcp(s).solve(r, {}, options, {}, [](const LcpStep& step) { return step.number < 2; });
  EXPECT_EQ(told.status, LcpStatus::stopped);
  EXPECT_EQ(told.steps, 2);
}

TEST(DenseLcp, EmptyProblemIsSolved) {
  const LcpAnswer answer = solve(MatrixXd(0, 0), VectorXd(0));
  EXPECT_EQ(answer.status, LcpStatus::solved);
  EXPECT_EQ(answer.steps, 1);
}

/// The square root of the Laplacian of a line, as a Schur complement nearly is: a handful of steps
/// whatever the size.
TEST(DenseLcp, TakesAHandfulOfStepsForACrack) {
  for (const Index n : {10, 100, 400}) {
    const MatrixXd s = MatrixXd::NullaryExpr(n, n, [](Index i, Index j) {
      const auto distance = static_cast<double>(i - j);
      return i == j ? std::acos(-1.0) * std::acos(-1.0) / 3 : -1 / (distance * distance);
    });
    VectorXd r(n);
    for (Index i = 0; i < n; ++i) {
      r[i] = std::sin(9.0 * static_cast<double>(i) / static_cast<double>(n)) - 0.2;
    }
    const LcpAnswer answer = solve(s, r);
    std::printf("[ figures  ] %d nodes: %d steps\n", static_cast<int>(n), answer.steps);
    ASSERT_EQ(answer.status, LcpStatus::solved);
    EXPECT_FALSE(answer.fell_back);
    EXPECT_LE(answer.steps, 25);
  }
}

}  // namespace
}  // namespace anticrack::contact
