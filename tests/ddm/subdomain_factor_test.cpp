// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/subdomain_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <random>

#include "errors/errors.hpp"
#include "support/recovered.hpp"

namespace anticrack::ddm {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Shifted Laplacian of a graph: symmetric positive definite.
Sparse laplacian(Eigen::Index n, const std::vector<std::pair<int, int>>& edges) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 0.01 * static_cast<double>(i + 1));
  }
  double weight = 1;
  for (const auto& [a, b] : edges) {
    weight = weight < 3 ? weight + 0.37 : weight - 2.1;
    entries.emplace_back(a, a, weight);
    entries.emplace_back(b, b, weight);
    entries.emplace_back(a, b, -weight);
    entries.emplace_back(b, a, -weight);
  }
  Sparse matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// A grid of `nx` by `ny` nodes numbered row by row: the last row is the interface.
Sparse grid(int nx, int ny) {
  std::vector<std::pair<int, int>> edges;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int a = j * nx + i;
      if (i + 1 < nx) edges.emplace_back(a, a + 1);
      if (j + 1 < ny) edges.emplace_back(a, a + nx);
      if (i + 1 < nx && j + 1 < ny) edges.emplace_back(a, a + nx + 1);
    }
  }
  return laplacian(static_cast<Eigen::Index>(nx) * ny, edges);
}

Eigen::VectorXd random_vector(Eigen::Index n) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Eigen::VectorXd::NullaryExpr(n, [&] { return uniform(generator); });
}

Eigen::MatrixXd dense_schur(const Sparse& matrix, Eigen::Index interior) {
  const Eigen::MatrixXd k = matrix;
  const Eigen::Index trace = k.rows() - interior;
  const Eigen::MatrixXd eliminated =
      k.topLeftCorner(interior, interior).llt().solve(k.topRightCorner(interior, trace));
  return k.bottomRightCorner(trace, trace) - k.bottomLeftCorner(trace, interior) * eliminated;
}

SubdomainFactor factorised(const Sparse& matrix, Eigen::Index interior) {
  std::vector<std::int32_t> order(static_cast<std::size_t>(interior));
  std::iota(order.begin(), order.end(), 0);
  return {matrix, interior, order};
}

void expect_exact(const Sparse& matrix, Eigen::Index interior, const SubdomainFactor& factor) {
  const Eigen::Index n = matrix.rows(), trace = n - interior;
  ASSERT_EQ(factor.trace(), trace);
  const Eigen::MatrixXd schur = dense_schur(matrix, interior);
  EXPECT_LT((factor.schur() - schur).norm(), 1e-13 * schur.norm());
  const Eigen::VectorXd t = random_vector(trace);
  EXPECT_LT((factor.apply_schur(t) - schur * t).norm(), 1e-13 * schur.norm());

  // A column of S^-1 is the trace of a solve with a unit force on the interface.
  const Eigen::LLT<Eigen::MatrixXd> whole{Eigen::MatrixXd(matrix)};
  const Eigen::MatrixXd inverse = schur.inverse();
  for (Eigen::Index j = 0; j < trace; ++j) {
    const Eigen::VectorXd solved = whole.solve(Eigen::VectorXd::Unit(n, interior + j)).tail(trace);
    EXPECT_LT((inverse.col(j) - solved).norm(), 1e-12 * solved.norm());
  }

  // Condensed load, energy identity and the field behind a trace.
  const Eigen::VectorXd f = random_vector(n), u = whole.solve(f);
  const auto [z, g] = factor.forward(f).front();
  EXPECT_LT((schur * u.tail(trace) - g).norm(), 1e-12 * g.norm());
  EXPECT_LT((anticrack::testing::recovered(factor, z, u.tail(trace)) - u).norm(), 1e-12 * u.norm());
  const Eigen::VectorXd v = anticrack::testing::recovered(factor, z, t);
  EXPECT_LT((v.tail(trace) - t).norm(), 1e-13 * t.norm());
  const double energy = v.dot(matrix * v) / 2 - f.dot(v);
  EXPECT_NEAR(-z.squaredNorm() / 2 + t.dot(schur * t) / 2 - g.dot(t), energy,
              1e-12 * std::abs(energy));
  EXPECT_NEAR(t.dot(schur * t) + z.squaredNorm(), v.dot(matrix * v), 1e-12 * v.dot(matrix * v));
}

void expect_exact(const Sparse& matrix, Eigen::Index interior) {
  expect_exact(matrix, interior, factorised(matrix, interior));
}

TEST(SubdomainFactor, IsTheSchurComplementOfAGrid) { expect_exact(grid(23, 17), 23 * 16); }

TEST(SubdomainFactor, IsTheSameInAnyOrderAndReadsTheLowerTriangle) {
  const Sparse matrix = grid(23, 17), lower = matrix.triangularView<Eigen::Lower>();
  std::vector<std::int32_t> order(23 * 16);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  expect_exact(matrix, 23 * 16, SubdomainFactor(lower, 23 * 16, order));
}

TEST(SubdomainFactor, OfAGridWithoutInteriorIsItsCholeskyFactor) { expect_exact(grid(9, 1), 0); }

TEST(SubdomainFactor, OfASubdomainWithoutInterfaceHasAnEmptyTrace) {
  const Sparse matrix = grid(7, 6);
  const SubdomainFactor factor = factorised(matrix, matrix.rows());
  EXPECT_EQ(factor.trace(), 0);
  const Eigen::VectorXd f = random_vector(matrix.rows());
  const Eigen::VectorXd u = anticrack::testing::recovered(
      factor, factor.forward(f).front().z_interior, Eigen::VectorXd(0));
  EXPECT_LT((matrix * u - f).norm(), 1e-12 * f.norm());
}

/// More columns than are solved at once.
TEST(SubdomainFactor, SolvesColumnsTogetherAsItSolvesEachAlone) {
  const Sparse matrix = grid(23, 17);
  const SubdomainFactor factor = factorised(matrix, 23 * 16);
  const Eigen::Index n = matrix.rows(), columns = columns_at_once(n) + 7;
  const Eigen::MatrixXd f = random_vector(n * columns).reshaped(n, columns);
  const std::vector<SubdomainFactor::Forward> together = factor.forward(f);
  ASSERT_EQ(together.size(), static_cast<std::size_t>(columns));
  Eigen::MatrixXd solved(factor.interior(), columns);
  factor.solve(f.topRows(factor.interior()), solved);
  const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(factor.trace());
  for (Eigen::Index j = 0; j < columns; ++j) {
    const SubdomainFactor::Forward alone = factor.forward(f.col(j)).front();
    EXPECT_EQ(together[static_cast<std::size_t>(j)].z_interior, alone.z_interior);
    EXPECT_EQ(together[static_cast<std::size_t>(j)].g, alone.g);
    EXPECT_EQ(
        solved.col(j),
        anticrack::testing::recovered(factor, alone.z_interior, at_rest).head(factor.interior()));
  }
  EXPECT_TRUE(factor.forward(f.leftCols(0)).empty());
}

TEST(SubdomainFactor, SolvesFewerColumnsAtOnceTheLongerTheyAre) {
  EXPECT_EQ(columns_at_once(0), 32);
  EXPECT_EQ(columns_at_once(1000), 32);
  EXPECT_EQ(columns_at_once(1'000'000), 8);
  EXPECT_EQ(columns_at_once(1'000'000'000), 1);
}

/// Two grids that share nothing: the elimination tree has two roots, and a postordering would put
/// the interface nodes of the first before the interior of the second.
TEST(SubdomainFactor, KeepsTheInterfaceLastWhenTheSubdomainFallsApart) {
  std::vector<std::pair<int, int>> edges;
  const auto chain = [&edges](std::vector<int> nodes) {
    for (std::size_t i = 1; i < nodes.size(); ++i) edges.emplace_back(nodes[i - 1], nodes[i]);
  };
  chain({0, 1, 2, 3, 10, 11});  // interior 0-3, trace 10, 11
  chain({4, 5, 6, 7, 12, 13});  // interior 4-7, trace 12, 13
  chain({8, 9, 14});            // interior 8, 9, trace 14
  expect_exact(laplacian(15, edges), 10);
}

/// Two chains without a diagonal shift: constants on each are in the kernel.
TEST(SubdomainFactor, OfPartsThatFloatIsExact) {
  const std::vector<std::pair<int, int>> edges = {{0, 1}, {1, 2}, {2, 5}, {5, 6},
                                                  {3, 4}, {4, 7}, {7, 8}, {8, 3}};
  Sparse matrix = laplacian(9, edges);
  for (int i = 0; i < 9; ++i) {
    matrix.coeffRef(i, i) -= 0.01 * (i + 1);
  }
  const Eigen::MatrixXd schur = dense_schur(matrix, 5);
  const SubdomainFactor factor = factorised(matrix, 5);
  EXPECT_LT((factor.schur() - schur).norm(), 1e-14 * schur.norm());
  EXPECT_LT(factor.schur().rowwise().sum().norm(), 1e-14 * schur.norm());
  const Eigen::VectorXd t = random_vector(4), f = random_vector(9);
  EXPECT_LT((factor.apply_schur(t) - schur * t).norm(), 1e-14 * schur.norm());
  const auto [z, g] = factor.forward(f).front();
  const Eigen::VectorXd u = anticrack::testing::recovered(factor, z, t);
  EXPECT_LT((u.tail(4) - t).norm(), 1e-14);
  EXPECT_LT((matrix * u - f).head(5).norm(), 1e-13);
  EXPECT_LT(((matrix * u - f).tail(4) - (schur * t - g)).norm(), 1e-13);
}

TEST(SubdomainFactor, RefusesAnIndefiniteMatrix) {
  Sparse matrix = grid(5, 4);
  matrix.coeffRef(3, 3) = -1;
  try {
    const SubdomainFactor factor = factorised(matrix, 15);
    FAIL() << "factorised";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), errors::Reason::numerical);
  }
  // The thread's CHOLMOD context must have recovered.
  expect_exact(grid(5, 4), 15);
}

}  // namespace
}  // namespace anticrack::ddm
