// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <stop_token>
#include <vector>

#include "fem/adaptive_load.hpp"
#include "fem/load_vector.hpp"
#include "fem/stiffness.hpp"
#include "stop/stop.hpp"
#include "support/crooked_square.hpp"
#include "support/errors.hpp"
#include "support/plain_stiffness.hpp"

namespace anticrack::fem {
namespace {

using testing::crooked_square;

Eigen::VectorXd nodal(const Triangulation& part, double (*f)(double, double)) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(part.node_count()));
  for (std::size_t i = 0; i < part.node_count(); ++i) {
    values[static_cast<Eigen::Index>(i)] = f(part.xy[2 * i], part.xy[2 * i + 1]);
  }
  return values;
}

/// The blocks put together.
Eigen::SparseMatrix<double> whole(const Stiffness& blocks) {
  const Eigen::Index free = blocks.free.rows(), n = free + blocks.dirichlet.rows();
  Eigen::MatrixXd result(n, n);
  result.topLeftCorner(free, free) = Eigen::MatrixXd(blocks.free).selfadjointView<Eigen::Lower>();
  result.topRightCorner(free, n - free) = Eigen::MatrixXd(blocks.free_dirichlet);
  result.bottomLeftCorner(n - free, free) = Eigen::MatrixXd(blocks.free_dirichlet).transpose();
  result.bottomRightCorner(n - free, n - free) = Eigen::MatrixXd(blocks.dirichlet);
  return result.sparseView();
}

TEST(Stiffness, MatchesTheReferenceTriangle) {
  const Triangulation part{{0, 0, 1, 0, 0, 1}, {0, 1, 2}};
  Eigen::Matrix3d expected;
  expected << 1, -0.5, -0.5, -0.5, 0.5, 0, -0.5, 0, 0.5;
  EXPECT_NEAR((Eigen::Matrix3d(whole(stiffness(part, 1, 3))) - expected).norm(), 0, 1e-15);
}

TEST(Stiffness, GivesTheEnergyOfALinearFunctionExactly) {
  const Triangulation part = crooked_square(6);
  const Eigen::SparseMatrix<double> k = whole(stiffness(part, 2, 30));
  const Eigen::VectorXd u = nodal(part, [](double x, double y) { return 2 * x - 3 * y + 7; });
  EXPECT_NEAR(u.dot(k * u), 26.0, 1e-12);
  EXPECT_NEAR((k * Eigen::VectorXd::Ones(u.size())).norm(), 0, 1e-13);
}

/// Node i becomes 19 i mod n, so that neighbours are far apart and free and fixed nodes mixed.
Triangulation shuffled(const Triangulation& part) {
  const std::size_t n = part.node_count();
  Triangulation result = part;
  for (std::size_t i = 0; i < n; ++i) {
    result.xy[2 * (19 * i % n)] = part.xy[2 * i];
    result.xy[2 * (19 * i % n) + 1] = part.xy[2 * i + 1];
  }
  for (std::int32_t& node : result.triangles) {
    node = static_cast<std::int32_t>(19 * static_cast<std::size_t>(node) % n);
  }
  return result;
}

/// Towards the corner at the origin, down to elements of 1e-13.
Triangulation graded(Triangulation part) {
  for (double& x : part.xy) {
    x = std::pow(x, 16);
  }
  return part;
}

TEST(Stiffness, IsThatOfThePlainAssembly) {
  for (const Triangulation& part :
       {shuffled(crooked_square(6)), graded(shuffled(crooked_square(6)))}) {
    const Eigen::SparseMatrix<double> plain = anticrack::testing::plain_stiffness(part, 3);
    for (const Eigen::Index free : {0, 1, 25, 48, 49}) {
      const Stiffness blocks = stiffness(part, 3, free);
      ASSERT_EQ(blocks.free.rows(), free);
      ASSERT_EQ(blocks.free_dirichlet.cols(), 49 - free);
      const Eigen::SparseMatrix<double> k = whole(blocks);
      for (Eigen::Index j = 0; j < 49; ++j) {
        for (Eigen::SparseMatrix<double>::InnerIterator entry(plain, j); entry; ++entry) {
          const double scale =
              std::sqrt(std::abs(plain.coeff(j, j) * plain.coeff(entry.row(), entry.row())));
          EXPECT_NEAR(k.coeff(entry.row(), j), entry.value(), 1e-15 * scale);
        }
      }
      EXPECT_LE(k.nonZeros(), plain.nonZeros());
    }
  }
}

/// What CHOLMOD wants.
TEST(Stiffness, OfTheFreeNodesIsALowerTriangleWithItsRowsInOrder) {
  const Eigen::SparseMatrix<double> k = stiffness(shuffled(crooked_square(6)), 1, 30).free;
  EXPECT_TRUE(k.isCompressed());
  EXPECT_LT(k.nonZeros(), 30 * 7);
  for (Eigen::Index j = 0; j < 30; ++j) {
    Eigen::Index row = j - 1;
    for (Eigen::SparseMatrix<double>::InnerIterator entry(k, j); entry; ++entry) {
      EXPECT_GT(entry.row(), row);
      EXPECT_EQ(row == j - 1, entry.row() == j);  // the diagonal first
      row = entry.row();
    }
  }
}

TEST(LoadVector, OfAConstantIsAThirdOfTheAreaPerCorner) {
  const Triangulation part = crooked_square(5);
  EXPECT_NEAR(load_vector(part, 3.0, "a").sum(), 3.0, 1e-14);
  EXPECT_NEAR((load_vector(part, 3.0, "a") - load_vector(part, Expression{"3"}, "a")).norm(), 0,
              1e-15);
}

TEST(LoadVector, IntegratesAPolynomialOfDegreeFourAgainstEveryHat) {
  const Triangulation part = crooked_square(5);
  const Eigen::VectorXd load = load_vector(part, Expression{"x^3*y + 2*x*y^2"}, "a");
  // Tested with v = x, itself in the space: int x^4 y + 2 x^2 y^2 = 1/10 + 2/9.
  const Eigen::VectorXd x = nodal(part, [](double px, double) { return px; });
  EXPECT_NEAR(load.dot(x), 0.1 + 2.0 / 9, 1e-15);
}

TEST(LoadVector, OfRegionsTakesTheRegionOfTheSubdomain) {
  const Triangulation part = crooked_square(2);
  const PerRegion force{{{"a", 2.0}, {"b", 5.0}}};
  EXPECT_NEAR(load_vector(part, force, "b").sum(), 5.0, 1e-14);
  EXPECT_EQ(load_vector(part, force, "c").norm(), 0.0);
}

TEST(LoadVector, OfAJumpAlongEdgesIsExact) {
  const Triangulation part{{0, 0, 1, 0, 1, 1, 0, 1}, {0, 1, 2, 0, 2, 3}};  // jumps on y = x
  EXPECT_NEAR(load_vector(part, Expression{"y > x ? 4 : 1"}, "a").sum(), 2.5, 1e-15);
}

TEST(LoadVector, OfAnArrayOnNodesIsThatOfItsInterpolant) {
  const Triangulation part = crooked_square(5);
  // The subdomain's nodes are some of the mesh's, in another order.
  std::vector<std::int32_t> node(part.node_count());
  auto values = std::make_shared<std::vector<double>>(2 * node.size(), 1e300);
  for (std::size_t i = 0; i < node.size(); ++i) {
    node[i] = static_cast<std::int32_t>(2 * (node.size() - i) - 1);
    (*values)[static_cast<std::size_t>(node[i])] = 2 * part.xy[2 * i] - 3 * part.xy[2 * i + 1];
  }
  const Eigen::VectorXd load = load_vector(part, Array{"sha", false, values}, "a", {.node = node});
  EXPECT_NEAR((load - load_vector(part, Expression{"2*x - 3*y"}, "a")).norm(), 0, 1e-15);
}

TEST(LoadVector, OfArraysTogetherHasTheBitsThatEachHasAlone) {
  const Triangulation part = crooked_square(7);
  std::vector<std::int32_t> node(part.node_count());
  for (std::size_t i = 0; i < node.size(); ++i) {
    node[i] = static_cast<std::int32_t>(node.size() - i);
  }
  std::vector<std::vector<double>> values(13);  // a full block, a part of one
  std::vector<const double*> arrays;
  for (std::size_t j = 0; j < values.size(); ++j) {
    for (std::size_t i = 0; i <= node.size(); ++i) {
      values[j].push_back(std::sin(static_cast<double>(3 * i + 7 * j)));
    }
    arrays.push_back(values[j].data());
  }
  for (const std::size_t count : {0U, 1U, 2U, 3U, 8U, 10U, 13U}) {
    const Eigen::MatrixXd loads = load_vectors(part, node, std::span(arrays).first(count));
    ASSERT_EQ(loads.cols(), static_cast<Eigen::Index>(count));
    for (std::size_t j = 0; j < count; ++j) {
      const auto alone = std::make_shared<const std::vector<double>>(values[j]);
      const Eigen::VectorXd load =
          load_vector(part, Array{"sha", false, alone}, "a", {.node = node});
      EXPECT_EQ(loads.col(static_cast<Eigen::Index>(j)), load) << count << " arrays, number " << j;
    }
  }
}

TEST(LoadVector, OfAnArrayOnTrianglesIsConstantOnEach) {
  const Triangulation part{{0, 0, 1, 0, 1, 1, 0, 1}, {0, 1, 2, 0, 2, 3}};
  const std::vector<std::int32_t> triangle{3, 1};
  const auto values = std::make_shared<const std::vector<double>>(std::vector<double>{9, 1, 9, 4});
  const Eigen::VectorXd load =
      load_vector(part, Array{"sha", true, values}, "a", {.triangle = triangle});
  EXPECT_NEAR((load - Eigen::Vector4d(2.5, 2, 2.5, 0.5) / 3).norm(), 0, 1e-15);
}

TEST(LoadVector, TellsHowWrongItIsAndStopsWhenAsked) {
  const Triangulation part = crooked_square(5);
  IntegrationReport report{};
  load_vector(part, Expression{"x > 0.3 ? 1 : 2"}, "a", {.report = &report});
  EXPECT_GE(report.relative_error_estimate, 0);
  EXPECT_LE(report.relative_error_estimate, 1e-10);
  std::stop_source stop;
  stop.request_stop();
  const stop::Scope scope(stop.get_token());
  EXPECT_TRUE(anticrack::testing::throws(
      [&] { load_vector(crooked_square(20), Expression{"x"}, "a"); }, errors::Reason::cancelled));
}

TEST(BoundaryValues, AreThoseOfTheNodesAskedFor) {
  const Triangulation part = crooked_square(1);
  const Eigen::VectorXd values = boundary_values(part, "10*x + y", 1, 2);
  ASSERT_EQ(values.size(), 2);
  EXPECT_EQ(values[0], 10.0);
  EXPECT_EQ(values[1], 1.0);
  EXPECT_EQ(boundary_values(part, "", 0, 4).norm(), 0.0);
}

}  // namespace
}  // namespace anticrack::fem
