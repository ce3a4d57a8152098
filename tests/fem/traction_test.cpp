// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/traction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>
#include <string>

#include "support/errors.hpp"

namespace anticrack::fem {
namespace {

using anticrack::testing::throws;
using errors::Reason;

/// The segment from (0, 2) to (3, 2) in `n` edges, uneven; it needs no triangles.
struct Segment {
  explicit Segment(int n) {
    for (int i = 0; i <= n; ++i) {
      const double part = static_cast<double>(i) / n;
      part_of_plane.xy.push_back(3 * part * part);
      part_of_plane.xy.push_back(2);
      if (i > 0) {
        edges.push_back({i - 1, i});
      }
    }
  }
  Eigen::VectorXd load(const std::string& traction) const {
    Eigen::VectorXd result =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(part_of_plane.node_count()));
    error = add_traction(part_of_plane, edges, traction, result).relative_error_estimate;
    return result;
  }
  double moment(const Eigen::VectorXd& load) const {
    double sum = 0;
    for (Eigen::Index i = 0; i < load.size(); ++i) {
      sum += load[i] * part_of_plane.xy[2 * static_cast<std::size_t>(i)];
    }
    return sum;
  }

  Triangulation part_of_plane;
  std::vector<std::array<std::int32_t, 2>> edges;
  mutable double error = 0;
};

TEST(Traction, OfAConstantIsHalfTheLengthPerEnd) {
  const Triangulation part{{0, 0, 3, 4}, {}};
  const std::vector<std::array<std::int32_t, 2>> edges{{1, 0}};
  Eigen::VectorXd load = Eigen::Vector2d(1, 0);
  EXPECT_LT(add_traction(part, edges, "2", load).relative_error_estimate, 1e-14);
  EXPECT_NEAR((load - Eigen::Vector2d(6, 5)).norm(), 0, 1e-14);
}

TEST(Traction, IsExactForSmoothFunctions) {
  const Segment segment(7);
  const Eigen::VectorXd load = segment.load("exp(x)*y");
  EXPECT_NEAR(load.sum(), 2 * (std::exp(3) - 1), 1e-9);
  EXPECT_NEAR(segment.moment(load), 2 * (2 * std::exp(3) + 1), 1e-9);  // int x e^x
  EXPECT_LT(segment.error, 1e-10);
}

TEST(Traction, FindsJumpsWhereverTheyAre) {
  const unsigned seed = 99;
  std::cout << "seed " << seed << "\n";
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anywhere(0.1, 2.9);
  for (const int n : {1, 4, 50}) {
    const Segment segment(n);
    for (int i = 0; i < 20; ++i) {
      const double at = anywhere(random);
      const std::string text = std::to_string(at);
      const double jump = std::stod(text);
      const Eigen::VectorXd load = segment.load("x > " + text + " ? 5 : -1");
      EXPECT_NEAR(load.sum(), 5 * (3 - jump) - jump, 1e-10) << n << " " << text;
      EXPECT_NEAR(segment.moment(load), 2.5 * (9 - jump * jump) - 0.5 * jump * jump, 1e-10);
      EXPECT_LT(segment.error, 1e-10);
    }
  }
}

TEST(Traction, JumpsInANodeAsItWouldBetweenTwo) {
  const Segment segment(2);  // 0, 0.75, 3
  const Eigen::VectorXd load = segment.load("x > 0.75 ? 1 : 0");
  EXPECT_NEAR(load[0], 0, 1e-12);
  EXPECT_NEAR(load[1], 1.125, 1e-12);
  EXPECT_NEAR(load[2], 1.125, 1e-12);
}

TEST(Traction, OfZeroOrOnNoEdgeIsZero) {
  Segment segment(3);
  EXPECT_EQ(segment.load("0").norm(), 0.0);
  EXPECT_EQ(segment.error, 0);
  segment.edges.clear();
  EXPECT_EQ(segment.load("1").norm(), 0.0);
  EXPECT_EQ(segment.error, 0);
}

TEST(Traction, TellsHowWrongItIs) {
  const Segment segment(20);
  for (const char* text : {"rint(1e9*x) - 1e9*x", "sin(1e7*x) > 0", "sin(1e6*x)"}) {
    segment.load(text);
    EXPECT_GT(segment.error, 1e-6) << text;
  }
  EXPECT_NEAR(segment.load("abs(x - 0.75)^-0.5").sum(), 2 * (std::sqrt(0.75) + 1.5), 1e-4);
  EXPECT_LT(segment.error, 1e-3);
  for (const char* text : {"1/abs(x - 0.75)", "1/(x - 0.1)^2", "1/x"}) {
    segment.load(text);
    EXPECT_TRUE(std::isinf(segment.error)) << text << " " << segment.error;
  }
  // A peak between any two points.
  EXPECT_NEAR(segment.load("1e5*exp(-1e10*(x - 1.2345)^2)").sum(), std::sqrt(3.14159265358979324),
              1e-9);
  EXPECT_LT(segment.error, 1e-10);
}

TEST(Traction, NamesItsFieldWhereItIsNotFinite) {
  const Segment segment(3);
  EXPECT_TRUE(throws([&] { segment.load("sqrt(x - 1)"); }, Reason::expression_invalid, "traction"));
}

}  // namespace
}  // namespace anticrack::fem
