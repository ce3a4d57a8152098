// SPDX-License-Identifier: GPL-3.0-or-later
//
// Smooth fields, limits and errors of integrate_load.
#include "fem/adaptive_load.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "errors/errors.hpp"
#include "support/exact_loads.hpp"
#include "support/load_errors.hpp"

namespace anticrack::testing {
namespace {

using ::testing::HasSubstr;

TEST(SmoothLoad, PolynomialsOfDegreeFiveAreExact) {
  const PlaneMesh mesh = square_mesh(4, 0.2, 2);
  for (int degree = 0; degree <= 5; ++degree) {
    for (int power = 0; power <= degree; ++power) {
      const Field f = [=](double x, double y) {
        return 3 * std::pow(x - 0.2, power) * std::pow(y + 0.1, degree - power);
      };
      std::vector<double> load(mesh.node_count());
      // The tolerance asks for no more than the first rule.
      fem::integrate_load(mesh.xy, mesh.triangles, f, load, {.relative_tolerance = 1e300});
      const std::vector<double> exact = loads_cut_by_lines(mesh, {}, f);
      for (std::size_t i = 0; i < load.size(); ++i) {
        EXPECT_NEAR(load[i], exact[i], 3e-14) << "x^" << power << " y^" << degree - power;
      }
    }
  }
}

TEST(SmoothLoad, DegreeSixIsNot) {
  const PlaneMesh mesh{{0, 0, 1, 0, 0, 1}, {0, 1, 2}};
  const Field f = [](double x, double) { return std::pow(x, 6); };
  std::vector<double> load(3);
  fem::integrate_load(mesh.xy, mesh.triangles, f, load, {.relative_tolerance = 1e300});
  const double exact = 1.0 / 72;  // int x^7 over the triangle
  EXPECT_GT(std::abs(load[1] - exact), 1e-6);
  fem::integrate_load(mesh.xy, mesh.triangles, f, load);
  EXPECT_NEAR(load[1], exact, 1e-12);
}

TEST(SmoothLoad, CostsTheFirstSamplesOnly) {
  const PlaneMesh mesh = square_mesh(75, 0.2, 2);
  const Field f = [](double x, double y) { return 2 + std::sin(2 * x) * std::cos(3 * y); };
  std::vector<double> load(mesh.node_count());
  const auto report = fem::integrate_load(mesh.xy, mesh.triangles, f, load);
  double sum = 0;
  for (const double part : load) {
    sum += part;
  }
  EXPECT_NEAR(sum, 8, 1e-12);
  EXPECT_EQ(report.evaluations, 15 * mesh.triangle_count());
  EXPECT_EQ(report.cut_triangles, 0U);
  EXPECT_LT(report.relative_error_estimate, 1e-10);
}

TEST(SmoothLoad, SteepIsQuarteredNotSwept) {
  const PlaneMesh mesh = square_mesh(40, 0.2, 2);
  std::vector<double> load(mesh.node_count());
  for (const double steep : {10.0, 20.0, 30.0}) {
    const Field f = [steep](double x, double y) {
      return 1 + std::sin(steep * x) * std::cos(steep * y) + std::exp(-steep * (x * x + y * y));
    };
    const auto report = fem::integrate_load(mesh.xy, mesh.triangles, f, load);
    double sum = 0;
    for (const double part : load) {
      sum += part;
    }
    const double root = std::erf(std::sqrt(steep));
    const double exact = 4 + 3.14159265358979323846 / steep * root * root;
    EXPECT_NEAR(sum, exact, 1e-10);
    EXPECT_LT(report.relative_error_estimate, 1e-10);
    EXPECT_LT(report.evaluations, 600 * mesh.triangle_count()) << steep;
    EXPECT_EQ(report.cut_triangles, 0U);
  }
}

TEST(SmoothLoad, ZeroIsZero) {
  const PlaneMesh mesh = square_mesh(3, 0, 0);
  std::vector<double> load(mesh.node_count(), 7);
  const auto report = fem::integrate_load(
      mesh.xy, mesh.triangles, [](double, double) { return 0.0; }, load);
  for (const double part : load) {
    EXPECT_EQ(part, 0.0);
  }
  EXPECT_EQ(report.relative_error_estimate, 0);
}

TEST(Limits, AreKeptAndTold) {
  const PlaneMesh mesh = square_mesh(10, 0.2, 2);
  const Field noise = [](double x, double y) {
    const double hash = std::sin(12.9898e3 * x + 78.233e3 * y) * 43758.5453;
    return hash - std::floor(hash);
  };
  std::vector<double> load(mesh.node_count());
  const fem::IntegrationLimits limits{.evaluations_per_triangle = 500, .evaluations = 20'000};
  const auto report = fem::integrate_load(mesh.xy, mesh.triangles, noise, load, limits);
  EXPECT_GT(report.relative_error_estimate, 1e-3);
  EXPECT_LT(report.evaluations, 15 * mesh.triangle_count() + 30'000);
  double sum = 0;
  for (const double part : load) {
    sum += part;
  }
  EXPECT_NEAR(sum, 2, 2 * report.relative_error_estimate);
}

TEST(Limits, TheRestGoesToTheWorst) {
  const PlaneMesh mesh{{-1, -1, 1, -1, 0, 1}, {0, 1, 2}};
  const Field f = [](double x, double y) { return std::hypot(x, y + 0.3) < 0.4 ? 1.0 : 0.0; };
  const std::vector<double> exact = loads_of_disc(mesh, {0, -0.3}, 0.4);
  fem::IntegrationLimits limits{.evaluations_per_triangle = 1000, .evaluations = 1000};
  EXPECT_GT(compare("starved", mesh, f, exact, limits).report.relative_error_estimate, 1e-10);
  limits.evaluations = 20'000'000;
  const LoadErrors fed = compare("fed", mesh, f, exact, limits);
  EXPECT_LT(fed.report.relative_error_estimate, 1e-10);
  EXPECT_LT(fed.whole, 1e-11);
}

TEST(Repeat, GivesTheSameBits) {
  const PlaneMesh mesh = square_mesh(20, 0.2, 2);
  const Field f = [](double x, double y) { return x * y + x > 0.1 ? std::exp(x) : -1.0; };
  std::vector<double> first(mesh.node_count()), second(mesh.node_count());
  fem::integrate_load(mesh.xy, mesh.triangles, f, first);
  fem::integrate_load(mesh.xy, mesh.triangles, f, second);
  EXPECT_EQ(first, second);
}

TEST(BadField, NamesThePointAndTheValue) {
  const PlaneMesh mesh = square_mesh(4, 0, 0);
  std::vector<double> load(mesh.node_count());
  for (const auto& [bad, shown] : {std::pair{std::numeric_limits<double>::infinity(), "inf"},
                                   std::pair{std::numeric_limits<double>::quiet_NaN(), "nan"}}) {
    const Field f = [bad = bad](double x, double y) { return x > 0.5 && y > 0 ? bad : 1; };
    try {
      fem::integrate_load(mesh.xy, mesh.triangles, f, load);
      ADD_FAILURE() << "accepted " << shown;
    } catch (const errors::Error& error) {
      EXPECT_EQ(error.reason(), errors::Reason::expression_invalid);
      EXPECT_THAT(error.what(), HasSubstr(shown));
      EXPECT_THAT(error.what(), HasSubstr("(x, y) = (0."));
      ASSERT_EQ(error.fields().size(), 1U);
      EXPECT_EQ(error.fields()[0].field, "force.expression");
    }
  }
}

TEST(BadMesh, ClockwiseAndFlatTrianglesAreRefused) {
  std::vector<double> load(3);
  const Field f = [](double, double) { return 1.0; };
  const std::vector<std::int32_t> clockwise{0, 2, 1}, flat{0, 1, 1};
  const std::vector<double> xy{0, 0, 1, 0, 0, 1};
  for (const auto& triangles : {clockwise, flat}) {
    try {
      fem::integrate_load(xy, triangles, f, load);
      ADD_FAILURE() << "accepted";
    } catch (const errors::Error& error) {
      EXPECT_EQ(error.reason(), errors::Reason::mesh_invalid);
      EXPECT_THAT(error.what(), HasSubstr("triangle 0"));
    }
  }
}

}  // namespace
}  // namespace anticrack::testing
