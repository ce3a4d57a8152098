// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/open_responses.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index size = 24, columns = 3;

/// Contacts 0 and 1 hold each other: S is singular where both are open.
struct Problem {
  MatrixXd s = MatrixXd::Identity(size, size), r = MatrixXd::Random(size, columns);
  VectorXd scale = VectorXd::LinSpaced(size, 0.5, 2);
  OpenFactor work;
  Problem() {
    const MatrixXd half = MatrixXd::Random(size - 2, size - 2);
    MatrixXd rest = half * half.transpose() + MatrixXd::Identity(size - 2, size - 2);
    const VectorXd unit = rest.diagonal().cwiseSqrt().cwiseInverse();
    s.bottomRightCorner(size - 2, size - 2) = unit.asDiagonal() * rest * unit.asDiagonal();
    s(0, 1) = s(1, 0) = -1;
  }
  static std::vector<char> set(unsigned bits) {
    std::vector<char> closed(size, 1);
    for (Index i = 0; i < size; ++i) closed[static_cast<std::size_t>(i)] = bits >> i & 1U;
    return closed;
  }
};

TEST(OpenResponses, SolveForEachSet) {
  Problem of;
  OpenResponses responses(of.r);
  ASSERT_TRUE(responses.pay());
  const MatrixXd scaled = of.scale.asDiagonal() * of.r;
  for (const unsigned bits : {0xffffffU, 0xffffffU, 0x1U, 0xaaaaaaU, 0x0ff0f2U}) {
    const std::vector<char> closed = Problem::set(bits);
    const auto found = responses.of(closed, of.s, of.scale, of.work);
    ASSERT_TRUE(found->regular);
    EXPECT_LT((of.s * found->d - scaled - found->force).norm(), 1e-12 * scaled.norm());
    for (Index i = 0; i < size; ++i) {
      const bool shut = closed[static_cast<std::size_t>(i)] != 0;
      EXPECT_LT((shut ? found->d : found->force).row(i).norm(), 1e-12 * scaled.norm()) << i;
    }
    EXPECT_EQ(responses.of(closed, of.s, of.scale, of.work), found);  // not made twice
  }
  EXPECT_FALSE(responses.of(Problem::set(0xfffff0U), of.s, of.scale, of.work)->regular);
}

TEST(OpenResponses, KeepNoMoreThanTheySay) {
  Problem of;
  OpenResponses responses(of.r);
  const auto first = responses.of(Problem::set(1), of.s, of.scale, of.work);
  const std::size_t most = responses.bytes() / (2 * sizeof(double) * size * columns);
  for (unsigned bits = 2; bits < 2 + most; ++bits)
    responses.of(Problem::set(bits << 2U | 1U), of.s, of.scale, of.work);
  const auto again = responses.of(Problem::set(1), of.s, of.scale, of.work);
  EXPECT_NE(again, first);        // it had been forgotten,
  EXPECT_EQ(again->d, first->d);  // and has the same bits
  EXPECT_EQ(OpenResponses(MatrixXd::Random(size, size)).bytes(), 0U);
}

}  // namespace
}  // namespace anticrack::contact
