// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/multifrontal.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <array>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <vector>

#include "ddm/blas.hpp"
#include "ddm/elimination_order.hpp"
#include "ddm/front_kernel.hpp"
#include "ddm/subdomain_factor.hpp"
#include "support/recovered.hpp"

namespace anticrack::ddm {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using Front = bool (*)(int columns, int height, double* panel, double* update, bool add);

MatrixXd random_positive(int size) {
  const MatrixXd a = MatrixXd::Random(size, size);
  return a * a.transpose() + MatrixXd::Identity(size, size);
}

void expect_eliminates(Front eliminate, int columns, int rest) {
  SCOPED_TRACE(std::to_string(columns) + " columns, " + std::to_string(rest) + " below");
  const int height = columns + rest;
  const MatrixXd front = random_positive(height);
  MatrixXd panel = front.leftCols(columns);
  // Written, not added to.
  MatrixXd update = MatrixXd::Constant(rest, rest, std::numeric_limits<double>::quiet_NaN());
  ASSERT_TRUE(eliminate(columns, height, panel.data(), update.data(), false));
  const MatrixXd l = front.topLeftCorner(columns, columns).llt().matrixL();
  const double scale = front.norm();
  const MatrixXd got = panel.topRows(columns).triangularView<Eigen::Lower>();
  EXPECT_LT((got - l).norm(), 1e-13 * scale);
  if (rest == 0) return;
  const MatrixXd b = front.bottomLeftCorner(rest, columns);
  const MatrixXd below = l.triangularView<Eigen::Lower>().solve(b.transpose()).transpose();
  EXPECT_LT((panel.bottomRows(rest) - below).norm(), 1e-13 * scale);
  const MatrixXd wanted = (-below * below.transpose()).triangularView<Eigen::Lower>();
  const MatrixXd left = update.triangularView<Eigen::Lower>();
  EXPECT_LT((left - wanted).norm(), 1e-13 * scale);

  panel = front.leftCols(columns);
  ASSERT_TRUE(eliminate(columns, height, panel.data(), update.data(), true));
  const MatrixXd twice = update.triangularView<Eigen::Lower>();
  EXPECT_LT((twice - 2 * wanted).norm(), 1e-13 * scale);
}

TEST(Front, IsEliminatedByEachKernelAndByBlas) {
  require_threadsafe_blas();  // one thread, as wherever fronts are eliminated
  std::srand(5);
  std::vector<Front> kernels = {eliminate_front};
  for (const auto instructions :
       {Instructions::baseline, Instructions::avx2, Instructions::avx512}) {
    if (const FrontKernel kernel = front_kernel(instructions)) kernels.push_back(kernel);
  }
  constexpr std::array<std::array<int, 2>, 9> sizes = {
      {{1, 0}, {1, 1}, {3, 7}, {4, 8}, {5, 0}, {13, 29}, {32, 40}, {60, 0}, {70, 133}}};
  for (const Front kernel : kernels) {
    for (const auto& [columns, rest] : sizes) expect_eliminates(kernel, columns, rest);
  }
}

TEST(Front, ThatIsNotPositiveDefiniteIsRefused) {
  require_threadsafe_blas();
  for (const int columns : {3, 70}) {
    for (const double wrong : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
      MatrixXd panel = random_positive(columns);
      panel(columns - 1, columns - 1) = wrong;
      MatrixXd update;
      EXPECT_FALSE(eliminate_front(columns, columns, panel.data(), update.data()))
          << columns << ' ' << wrong;
    }
  }
}

/// A grid of triangles, its last row of nodes the interface: fronts of all sizes.
TEST(Multifrontal, FactorIsThatOfASparseSolver) {
  constexpr int nx = 131, ny = 97, n = nx * ny, interior = n - nx;
  std::vector<Eigen::Triplet<double>> entries;
  const auto couple = [&entries](int a, int b, double weight) {
    entries.emplace_back(a, a, weight);
    entries.emplace_back(b, b, weight);
    entries.emplace_back(std::max(a, b), std::min(a, b), -weight);
  };
  std::vector<double> xy;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int a = j * nx + i;
      xy.insert(xy.end(), {double(i), double(j)});
      if (i + 1 < nx) couple(a, a + 1, 1 + 0.1 * (i % 7));
      if (j + 1 < ny) couple(a, a + nx, 1 + 0.1 * (j % 5));
      if (i + 1 < nx && j + 1 < ny) couple(a, a + nx + 1, 0.3);
      entries.emplace_back(a, a, 1e-3);
    }
  }
  Eigen::SparseMatrix<double> lower(n, n);
  lower.setFromTriplets(entries.begin(), entries.end());
  const SubdomainFactor factor(lower, interior, elimination_order(lower, interior, xy));

  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> plain(lower);
  std::srand(1);
  const VectorXd f = VectorXd::Random(n), u = plain.solve(f);
  const auto [z, g] = factor.forward(f).front();
  const VectorXd trace = factor.schur().llt().solve(g);
  EXPECT_LT((trace - u.tail(nx)).norm(), 1e-11 * u.norm());
  EXPECT_LT((anticrack::testing::recovered(factor, z, trace) - u).norm(), 1e-11 * u.norm());
  EXPECT_EQ(factor.schur(), factor.schur().transpose());
  for (const int threads : {1, 2, 3, 8}) {
    const SubdomainFactor again(lower, interior, elimination_order(lower, interior, xy), threads);
    EXPECT_EQ(again.schur(), factor.schur()) << threads;
    EXPECT_EQ(again.forward(f).front().z_interior, z) << threads;
  }
}

}  // namespace
}  // namespace anticrack::ddm
