// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/nested_start.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numeric>

#include "contact/dense_lcp.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The square root of the Laplacian of a line, as a Schur complement nearly is.
MatrixXd crack(Index n) {
  return MatrixXd::NullaryExpr(n, n, [](Index i, Index j) {
    const auto distance = static_cast<double>(i - j);
    return i == j ? std::acos(-1.0) * std::acos(-1.0) / 3 : -1 / (distance * distance);
  });
}

VectorXd wave(Index n, double waves, double bias) {
  return VectorXd::NullaryExpr(n, [=](Index i) {
    return std::sin(waves * static_cast<double>(i) / static_cast<double>(n)) - bias;
  });
}

/// Two cracks, one with an odd number of contacts.
std::vector<std::vector<std::int32_t>> two_chains(Index n) {
  std::vector<std::vector<std::int32_t>> chains(2);
  for (std::int32_t i = 0; i < n; ++i) {
    chains[i < n / 2 ? 0 : 1].push_back(i);
  }
  return chains;
}

LcpAnswer solve_from(const DenseLcp& lcp, const VectorXd& r, const std::vector<char>& start = {}) {
  return lcp.solve(r, r.cwiseAbs(), {}, start);
}

constexpr Index contacts = 401;

TEST(NestedStart, SavesStepsAndChangesNoBit) {
  const MatrixXd s = crack(contacts);
  const DenseLcp lcp(s);
  const NestedStart nested(s, two_chains(contacts));
  int from_there = 0, from_closed = 0;
  for (int k = 0; k < 20; ++k) {
    const VectorXd r = wave(contacts, 2.0 + k, 0.1 * (k % 4));
    const std::vector<char> start = nested.closed(r, r.cwiseAbs());
    ASSERT_EQ(start.size(), static_cast<std::size_t>(contacts));
    EXPECT_EQ(nested.closed(r, r.cwiseAbs()), start);
    const LcpAnswer cold = solve_from(lcp, r), warm = solve_from(lcp, r, start);
    ASSERT_EQ(cold.status, LcpStatus::solved);
    ASSERT_EQ(warm.status, LcpStatus::solved);
    EXPECT_EQ(warm.closed, cold.closed);
    EXPECT_EQ(warm.d, cold.d);
    EXPECT_EQ(warm.lambda, cold.lambda);
    from_there += warm.steps;
    from_closed += cold.steps;
  }
  std::printf("[ figures  ] %d steps, from all closed %d\n", from_there, from_closed);
  EXPECT_LT(2 * from_there, from_closed);
}

TEST(NestedStart, IsAllOpenWhereEverythingOpensAndAllClosedWhereItIsPressed) {
  const NestedStart nested(crack(contacts), two_chains(contacts));
  const VectorXd pull = VectorXd::Ones(contacts);
  EXPECT_EQ(nested.closed(pull, pull), std::vector<char>(contacts, 0));
  EXPECT_EQ(nested.closed(-pull, pull), std::vector<char>(contacts, 1));
}

TEST(NestedStart, HasNothingToSayOfFewContactsOrOfOnesWithoutNeighbours) {
  const VectorXd few = wave(20, 3, 0), many = wave(contacts, 3, 0);
  std::vector<std::int32_t> all(20);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_TRUE(NestedStart(crack(20), {all}).closed(few, few.cwiseAbs()).empty());
  std::vector<std::vector<std::int32_t>> alone;
  for (std::int32_t i = 0; i < contacts; ++i) {
    alone.push_back({i});
  }
  EXPECT_TRUE(NestedStart(crack(contacts), alone).closed(many, many.cwiseAbs()).empty());
}

TEST(NestedStart, IsWhereALoadFarFromTheLastStarts) {
  const MatrixXd s = crack(contacts);
  const DenseLcp lcp(s);
  const NestedStart nested(s, two_chains(contacts));
  LcpSequence with(lcp, {}, {}, &nested), without(lcp, {}, {});
  int steps = 0, plain = 0;
  for (int k = 0; k < 20; ++k) {
    const VectorXd r = wave(contacts, 2.0 + 5 * (k % 4), 0.1 * (k % 3));
    const LcpAnswer &a = with.solve(r, r.cwiseAbs()), &b = without.solve(r, r.cwiseAbs());
    ASSERT_EQ(a.status, LcpStatus::solved);
    ASSERT_EQ(b.status, LcpStatus::solved);
    EXPECT_EQ(a.closed, b.closed);
    EXPECT_EQ(a.d, b.d);
    EXPECT_EQ(a.lambda, b.lambda);
    steps += a.steps;
    plain += b.steps;
  }
  std::printf("[ figures  ] %d steps, from the set before %d\n", steps, plain);
  EXPECT_LT(steps, plain);
}

}  // namespace
}  // namespace anticrack::contact
