// SPDX-License-Identifier: GPL-3.0-or-later
//
// Smooth fields, limits and errors of integrate_load.
#include "fem/adaptive_load.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stop_token>

#include "errors/errors.hpp"
#include "support/errors.hpp"
#include "support/exact_loads.hpp"
#include "support/load_errors.hpp"

namespace anticrack::testing {
namespace {

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

TEST(BadField, EndsTheWorkWithWhatItThrows) {
  const PlaneMesh mesh = square_mesh(4, 0, 0);
  std::vector<double> load(mesh.node_count());
  const Field f = [](double x, double y) {
    if (x > 0.5 && y > 0) {
      throw errors::Error(errors::Reason::expression_invalid, "not finite");
    }
    return 1.0;
  };
  EXPECT_TRUE(throws([&] { fem::integrate_load(mesh.xy, mesh.triangles, f, load); },
                     errors::Reason::expression_invalid));
}

TEST(Limits, HoldForATriangleFullOfJumps) {
  const PlaneMesh mesh{{-1, -1, 1, -1, 0, 1}, {0, 1, 2}};
  const Field noise = [](double x, double y) {
    const double hash = std::sin(12.9898e3 * x + 78.233e3 * y) * 43758.5453;
    return hash - std::floor(hash);
  };
  std::vector<double> load(mesh.node_count());
  const fem::IntegrationLimits limits{.evaluations = 200'000};
  const auto report = fem::integrate_load(mesh.xy, mesh.triangles, noise, load, limits);
  EXPECT_GT(report.relative_error_estimate, 1e-3);
  EXPECT_LT(report.evaluations, 500'000U);
}

TEST(Stop, EndsTheWorkSoon) {
  const PlaneMesh mesh = square_mesh(10, 0, 0);
  std::vector<double> load(mesh.node_count());
  std::stop_source stop;
  std::size_t evaluations = 0;
  const Field f = [&](double x, double) {
    if (++evaluations == 10'000) {
      stop.request_stop();
    }
    return std::sqrt(std::abs(x - 0.03));
  };
  EXPECT_TRUE(
      throws([&] { fem::integrate_load(mesh.xy, mesh.triangles, f, load, {}, stop.get_token()); },
             errors::Reason::cancelled));
  EXPECT_LT(evaluations, 12'000U);
}

/// Bisection towards tips makes triangles that coordinates hardly resolve.
TEST(FlatTriangle, HasNoLoadAndDisturbsNoOther) {
  const PlaneMesh mesh{{0, 0, 1, 0, 0, 1, 0, 1}, {0, 1, 2, 1, 2, 3}};
  const Field f = [](double x, double y) { return x + y > 0.4 ? 3.0 : 0.0; };
  const PlaneMesh first{mesh.xy, {0, 1, 2}};
  const std::vector<double> exact = loads_cut_by_lines(first, {{1, 1, 0.4}}, f);
  std::vector<double> load(mesh.node_count());
  const auto report = fem::integrate_load(mesh.xy, mesh.triangles, f, load);
  EXPECT_LT(report.relative_error_estimate, 1e-10);
  for (std::size_t i = 0; i < load.size(); ++i) {
    EXPECT_NEAR(load[i], exact[i], 1e-11) << i;
  }
}

}  // namespace
}  // namespace anticrack::testing
