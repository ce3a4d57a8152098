// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/tension.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "fem/load_vector.hpp"
#include "fem/stiffness.hpp"
#include "stop/stop.hpp"
#include "support/crooked_square.hpp"
#include "support/errors.hpp"

namespace anticrack::fem {
namespace {

using Field = std::function<double(double, double)>;

template <class Call>
void expect_error(const Call& call, errors::Reason reason, const std::string& field,
                  const std::string& words) {
  EXPECT_TRUE(testing::throws(call, reason, field));
  EXPECT_THAT(testing::error_of(call)->what(), ::testing::HasSubstr(words));
}

double squared_diameter(const Triangulation& part, std::size_t t) {
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto p = 2 * static_cast<std::size_t>(part.triangles[3 * t + i]),
               q = 2 * static_cast<std::size_t>(part.triangles[3 * t + (i + 1) % 3]);
    most = std::max(
        most, std::pow(part.xy[p] - part.xy[q], 2) + std::pow(part.xy[p + 1] - part.xy[q + 1], 2));
  }
  return most;
}

/// The boundary's nodes last, as subdomains have them.
struct Numbered {
  Triangulation part;
  Eigen::Index free = 0;

  explicit Numbered(const Triangulation& given) : part(given) {
    std::vector<std::int32_t> number(given.node_count());
    std::vector<double> inner, outer;
    for (const bool inside : {true, false}) {
      for (std::size_t i = 0; i < number.size(); ++i) {
        const double x = given.xy[2 * i], y = given.xy[2 * i + 1];
        if ((x > 0 && x < 1 && y > 0 && y < 1) != inside) continue;
        std::vector<double>& to = inside ? inner : outer;
        number[i] = static_cast<std::int32_t>((inner.size() + outer.size()) / 2);
        to.insert(to.end(), {x, y});
      }
    }
    free = static_cast<Eigen::Index>(inner.size() / 2);
    part.xy = inner;
    part.xy.insert(part.xy.end(), outer.begin(), outer.end());
    for (std::int32_t& node : part.triangles) node = number[static_cast<std::size_t>(node)];
  }

  Eigen::VectorXd nodal(const Field& u) const {
    Eigen::VectorXd values(static_cast<Eigen::Index>(part.node_count()));
    for (Eigen::Index i = 0; i < values.size(); ++i)
      values[i] =
          u(part.xy[2 * static_cast<std::size_t>(i)], part.xy[2 * static_cast<std::size_t>(i) + 1]);
    return values;
  }

  /// Largest nodal error of -div(T grad u) = f with u on the boundary.
  double error(const mesh::TensionLaw& law, const std::string& f, const Field& u) const {
    const Stiffness k = stiffness(part, tension(part, law, "all"), free);
    const Eigen::VectorXd exact = nodal(u);
    Eigen::VectorXd load = load_vector(part, Expression{f}, "all").head(free);
    load -= k.free_dirichlet * exact.tail(exact.size() - free);
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor(k.free);
    return (factor.solve(load) - exact.head(free)).lpNorm<Eigen::Infinity>();
  }
};

TEST(Tension, LinearFieldsSolveAnOrthotropicMembraneAtAnAngle) {
  const Numbered square(testing::crooked_square(7));
  const mesh::TensionLaw law{"3", "0.5", 30};
  EXPECT_LT(square.error(law, "0", [](double x, double y) { return 1 + 2 * x - 3 * y; }), 1e-13);
  // and x^2 in the limit: -div(T grad x^2) = -2 Txx
  const Field u = [](double x, double) { return x * x; };
  const double coarse = Numbered(testing::crooked_square(8)).error(law, "-4.75", u),
               fine = Numbered(testing::crooked_square(32)).error(law, "-4.75", u);
  EXPECT_LT(fine, coarse / 8);
}

TEST(Tension, VaryingLawsConvergeAtRateTwo) {
  struct Case {
    mesh::TensionLaw law;
    const char* f;
    Field u;
  };
  for (const Case& one : {// u = x^2 + y^2: f = -(2 T + x dT/dx) - ...
                          Case{{"1 + x^2 + 0.5*y", "", 0},
                               "-(4*(1 + x^2 + 0.5*y) + 4*x^2 + y)",
                               [](double x, double y) { return x * x + y * y; }},
                          Case{{"exp(x)", "1 + y", 0},
                               "-(2*exp(x)*(1 + x) + 2 + 4*y)",
                               [](double x, double y) { return x * x + y * y; }},
                          // a kink along x = 0.4, where no edge lies: T u' = x
                          Case{{"x > 0.4 ? 2 : 1", "", 0}, "-1", [](double x, double) {
                                 return x > 0.4 ? 0.08 + (x * x - 0.16) / 4 : x * x / 2;
                               }}}) {
    const double coarse = Numbered(testing::crooked_square(10)).error(one.law, one.f, one.u),
                 fine = Numbered(testing::crooked_square(40)).error(one.law, one.f, one.u);
    const bool jumps = one.law.along.find('?') != std::string::npos;
    EXPECT_LT(fine, coarse / (jumps ? 2 : 8)) << one.law.along;
    EXPECT_GT(coarse, 1e-7);
  }
}

TEST(Tension, HasTheMeansOfItsLawAndTheirMatrix) {
  const Triangulation part = testing::crooked_square(5);
  const Tension found = tension(part, {"1 + x", "2", 90}, "all");
  double mean = 0;
  for (std::size_t t = 0; t < part.triangle_count(); ++t) {
    double x = 0;
    for (std::size_t i = 0; i < 3; ++i)
      x += part.xy[2 * static_cast<std::size_t>(part.triangles[3 * t + i])] / 3;
    const auto [xx, xy, yy] = found.of_triangle[t];
    EXPECT_NEAR(xx, 2, 1e-14);  // the law turned by 90 degrees
    EXPECT_NEAR(xy, 0, 1e-14);
    EXPECT_NEAR(yy, 1 + x, 1e-14);
    mean = std::max(mean, std::abs(yy));
    const Isotropic map = found.isotropic(t);
    EXPECT_NEAR(map.tension * map.tension, xx * yy - xy * xy, 1e-13);
    EXPECT_NEAR(map.xx * map.yy - map.xy * map.xy, 1, 1e-13);  // keeps areas
    const Variation& of = found.variation[t];
    const double reach = std::sqrt(squared_diameter(part, t));
    EXPECT_GT(of.most(), 0);
    EXPECT_LT(of.most(), reach);
    EXPECT_LE(of.spread, of.most());
  }
  EXPECT_NEAR(found.mean, 1.75, 1e-12);
  EXPECT_TRUE(tension(part, {"3", "2", 17}, "all").variation.empty());
}

TEST(Tension, VariesByAJumpOnlyWhereItJumps) {
  const Triangulation part = testing::crooked_square(8);
  const Tension found = tension(part, {"y > 0.99*x + 0.3 ? 4 : 1", "", 0}, "all");
  std::size_t varied = 0;
  for (std::size_t t = 0; t < part.triangle_count(); ++t) {
    const double mean = found.of_triangle[t][0];
    const bool mixed = mean > 1 + 1e-9 && mean < 4 - 1e-9;
    varied += mixed ? 1 : 0;
    EXPECT_EQ(found.variation[t].most() > 1e-6, mixed) << t;
    // What is left of the law when its mean is taken: (4 - T)(T - 1) / (4 T).
    const double least = mixed ? std::sqrt((4 - mean) * (mean - 1) / (4 * mean)) * (1 - 1e-9) : 0;
    EXPECT_GE(found.variation[t].spread, least);
  }
  EXPECT_GT(varied, 5U);
}

TEST(Tension, IsRefusedWithThePointWhereItIsNotAboveZero) {
  const Triangulation part = testing::crooked_square(4);
  expect_error(
      [&] {
        tension(part, {"1", "0.5 - x", 0}, "top");
      },
      errors::Reason::expression_invalid, "across", "the tension across of \"top\" is -");
  expect_error(
      [&] {
        tension(part, {"1/(x > 0.5 ? 0 : 1)", "", 0}, "top");
      },
      errors::Reason::expression_invalid, "along", "must be finite");
  expect_error(
      [&] {
        check({"0", "", 0}, 100);
      },
      errors::Reason::expression_invalid, "along", "is 0");
  expect_error(
      [&] {
        check({"1", "x +", 0}, 100);
      },
      errors::Reason::expression_invalid, "across", "");
  expect_error(
      [&] {
        check({"1 + x + y", "", 0}, 8);
      },
      errors::Reason::expression_invalid, "along", "9 bytes");
  const std::array<double, 2> point{-2, 0};
  EXPECT_NO_THROW(check({"1 + x", "", 0}, 100));
  expect_error(
      [&] {
        check({"1 + x", "", 0}, 100, &point);
      },
      errors::Reason::expression_invalid, "along", "at (x, y) = (-2, 0)");
  std::stop_source stop;
  stop.request_stop();
  const stop::Scope scope(stop.get_token());
  expect_error([&] { tension(part, {"1 + x", "", 0}, "top"); }, errors::Reason::cancelled, "", "");
}

}  // namespace
}  // namespace anticrack::fem
