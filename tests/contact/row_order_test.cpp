// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/row_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd random_points(Index loads, Index rows) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(loads, rows, [&] { return normal(random); });
}

/// The largest component of the way from each direction to the next, in increasing order.
std::vector<double> ways(const MatrixXd& points) {
  const std::vector<std::size_t> order = row_order(points);
  std::vector<double> result;
  for (std::size_t k = 1; k < order.size(); ++k) {
    const auto a = points.col(static_cast<Index>(order[k - 1]));
    const auto b = points.col(static_cast<Index>(order[k]));
    result.push_back((a / a.lpNorm<Eigen::Infinity>() - b / b.lpNorm<Eigen::Infinity>())
                         .lpNorm<Eigen::Infinity>());
  }
  std::ranges::sort(result);
  return result;
}

/// A grid on one face is walked cell by cell: no order but that of the curve does so.
TEST(RowOrder, NeverLeavesAGridCellForOneThatDoesNotTouchIt) {
  for (const Index side : {2, 8, 32}) {
    MatrixXd grid(3, side * side);
    for (Index i = 0; i < grid.cols(); ++i) {
      const Index column = i % side, row = i / side;
      const auto x = static_cast<double>(2 * column + 1) / static_cast<double>(side) - 1;
      const auto y = static_cast<double>(2 * row + 1) / static_cast<double>(side) - 1;
      grid.col(i) << x, 1, y;
    }
    EXPECT_NEAR(ways(grid).back(), 2.0 / static_cast<double>(side), 1e-12) << side;
  }
}

TEST(RowOrder, BringsRandomDirectionsTogether) {
  // So many points on six faces of area 4 each: neighbours are about sqrt(24 / 4096) apart.
  const std::vector<double> all = ways(random_points(3, 4096));
  EXPECT_LT(all[all.size() / 2], 0.08);
  EXPECT_LT(all[all.size() * 9 / 10], 0.2);
}

TEST(RowOrder, HasEveryRowOnceWhateverTheNumberOfLoads) {
  for (const Index loads : {0, 1, 2, 3, 40}) {
    std::vector<std::size_t> order = row_order(random_points(loads, 100));
    std::ranges::sort(order);
    ASSERT_EQ(order.size(), 100U);
    for (std::size_t k = 0; k < order.size(); ++k) EXPECT_EQ(order[k], k);
  }
  EXPECT_TRUE(row_order(MatrixXd(3, 0)).empty());
}

TEST(RowOrder, IsThatOfDirectionsAndKeepsEqualOnes) {
  const MatrixXd points = random_points(3, 200);
  MatrixXd scaled = points;
  for (Index k = 0; k < scaled.cols(); ++k)
    scaled.col(k) *= std::ldexp(1.0, static_cast<int>(7 * (k % 200) - 700));
  EXPECT_EQ(row_order(points), row_order(scaled));
  const MatrixXd equal = MatrixXd::Constant(2, 5, -3.0);
  EXPECT_EQ(row_order(equal), (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(RowOrder, PutsRowsWithoutADirectionLast) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  MatrixXd points(2, 6);
  points << 0, 1, inf, -1, 4e-320, std::nan(""),  //
      -0.0, 0, 1, 0, 0, 1;
  EXPECT_EQ(row_order(points), (std::vector<std::size_t>{1, 4, 3, 0, 2, 5}));
}

}  // namespace
}  // namespace anticrack::contact
