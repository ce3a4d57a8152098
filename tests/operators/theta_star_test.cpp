// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "operators/answer_difference.hpp"
#include "operators/sweep_support.hpp"

namespace anticrack::operators {
namespace {

using contact::ActiveSetOptions;

TEST(ThetaStar, IsComputedWhenItIsAskedForAndCountsFromThen) {
  const Operator op = factorised();
  const std::size_t before = op->bytes();
  Silent silent;
  const contact::Answer exact =
      testing::solve(*op, three_loads()[0], ActiveSetOptions{}, false, silent);
  EXPECT_EQ(exact.theta_star, 0);
  EXPECT_EQ(op->bytes(), before);
  const double theta_star = op->theta_star();
  EXPECT_GT(theta_star, 0);
  EXPECT_GT(op->bytes(), before);
  EXPECT_LE(op->bytes(), estimate_bytes(op->mesh()));
  const contact::Answer after =
      testing::solve(*op, three_loads()[0], ActiveSetOptions{}, false, silent);
  EXPECT_EQ(after.theta_star, 0);
  EXPECT_EQ(difference(after, exact), 0);

  const Operator other = factorised();
  contact::UzawaOptions uzawa;
  uzawa.theta.reset();
  EXPECT_EQ(testing::solve(*other, three_loads()[0], uzawa, false, silent).theta_star, theta_star);
}

}  // namespace
}  // namespace anticrack::operators
