// SPDX-License-Identifier: GPL-3.0-or-later
//
// Smooth fields, singularities, limits and errors of integrate_load.
#include "fem/adaptive_load.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stop_token>
#include <thread>

#include "errors/errors.hpp"
#include "fem/load_vector.hpp"
#include "stop/stop.hpp"
#include "support/errors.hpp"
#include "support/exact_loads.hpp"
#include "support/load_errors.hpp"

namespace anticrack::testing {
namespace {

double sum(const std::vector<double>& load) {
  return std::accumulate(load.begin(), load.end(), 0.0);
}

TEST(SmoothLoad, PolynomialsOfDegreeFourAreExact) {
  const PlaneMesh mesh = square_mesh(4, 0.2, 2);
  for (int degree = 0; degree <= 4; ++degree) {
    for (int power = 0; power <= degree; ++power) {
      const std::string f =
          "3*(x - 0.2)^" + std::to_string(power) + "*(y + 0.1)^" + std::to_string(degree - power);
      std::vector<double> load;
      const auto report = integrate(mesh, f, load);
      const std::vector<double> exact = loads_cut_by_lines(mesh, {}, field(f));
      for (std::size_t i = 0; i < load.size(); ++i) {
        EXPECT_NEAR(load[i], exact[i], 3e-14) << f;
      }
      EXPECT_EQ(report.evaluations, 7 * 32U);  // samples go in blocks of 32 triangles
    }
  }
}

TEST(SmoothLoad, OfHigherDegreeIsRightWhereItIsAskedFor) {
  const PlaneMesh mesh{{0, 0, 1, 0, 0, 1}, {0, 1, 2}};
  std::vector<double> load;
  integrate(mesh, "x^6", load, {.relative_tolerance = 1e300});
  const double exact = 1.0 / 72;  // int x^7 over the triangle
  EXPECT_GT(std::abs(load[1] - exact), 1e-6);
  integrate(mesh, "x^6", load);
  EXPECT_NEAR(load[1], exact, 1e-12);
}

TEST(SmoothLoad, CostsTheFirstSamplesOnly) {
  const PlaneMesh mesh = square_mesh(80, 0.2, 2);
  std::vector<double> load;
  const auto report = integrate(mesh, "2 + sin(2*x)*cos(3*y)", load, {.relative_tolerance = 1e-6});
  EXPECT_NEAR(sum(load), 8, 1e-9);
  EXPECT_EQ(report.evaluations, mesh.node_count() + 7 * mesh.triangle_count());
  EXPECT_EQ(report.cut_triangles, 0U);
  EXPECT_LT(report.relative_error_estimate, 1e-8);
}

TEST(SmoothLoad, SteepIsRefined) {
  const PlaneMesh mesh = square_mesh(40, 0.2, 2);
  for (const double steep : {10.0, 20.0, 30.0}) {
    const std::string k = text(steep);
    std::vector<double> load;
    const auto report = integrate(
        mesh, "1 + sin(" + k + "*x)*cos(" + k + "*y) + exp(-" + k + "*(x^2 + y^2))", load);
    const double root = std::erf(std::sqrt(steep));
    const double exact = 4 + std::numbers::pi / steep * root * root;
    EXPECT_NEAR(sum(load), exact, 1e-10);
    EXPECT_LT(report.relative_error_estimate, 1e-10);
    EXPECT_LT(report.evaluations, 100 * mesh.triangle_count()) << steep;
    EXPECT_EQ(report.cut_triangles, 0U);
  }
}

TEST(SmoothLoad, ZeroIsZero) {
  const PlaneMesh mesh = square_mesh(3, 0, 0);
  for (const char* zero : {"0", "x - x", "sin(0*x)"}) {
    std::vector<double> load;
    const auto report = integrate(mesh, zero, load);
    for (const double part : load) {
      EXPECT_EQ(part, 0.0);
    }
    EXPECT_EQ(report.relative_error_estimate, 0);
  }
}

/// The estimate may be too careful, but never by far too small.
void expect_honest(const PlaneMesh& mesh, const std::string& f, double exact,
                   const fem::IntegrationLimits& limits = {.relative_tolerance = 1e-6,
                                                           .work = 5e7}) {
  std::vector<double> load;
  const auto report = integrate(mesh, f, load, limits);
  const double error = std::abs(sum(load) - exact) / std::abs(exact);
  EXPECT_LE(error, 10 * std::max(report.relative_error_estimate, 1e-13)) << f;
}

TEST(NarrowPeak, IsFoundHoweverNarrow) {
  const PlaneMesh mesh = square_mesh(20, 0.2, 3);
  for (const double width : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6}) {
    const std::string r = "((x - 0.123)^2 + (y - 0.234)^2)";
    const double k = 1 / (width * width);
    expect_honest(mesh, "exp(-" + text(k) + "*" + r + ")", std::numbers::pi / k);
    expect_honest(mesh, "1 + " + text(k) + "*exp(-" + text(k) + "*" + r + ")",
                  4 + std::numbers::pi);
    std::vector<double> load;
    const auto report =
        integrate(mesh, "exp(-" + text(k) + "*" + r + ")", load, {.relative_tolerance = 1e-6});
    EXPECT_LT(report.relative_error_estimate, 1e-6) << width;
    EXPECT_NEAR(sum(load) * k, std::numbers::pi, width > 0.05 ? 1e-4 : 1e-5) << width;
  }
}

TEST(NarrowStrip, IsFoundHoweverNarrow) {
  const PlaneMesh mesh = square_mesh(20, 0.2, 3);
  for (const double width : {1e-1, 1e-3, 1e-5, 1e-8}) {
    const std::string u = "(x + 0.3*y - 0.1234)";
    std::vector<double> load;
    integrate(mesh, u + " > 0 && " + u + " < " + text(width), load);
    EXPECT_NEAR(sum(load), 2 * width, 2e-10) << width;
  }
}

TEST(Singularity, AtANodeIsToldAsItIs) {
  const PlaneMesh mesh = square_mesh(20, 0, 0);  // (0, 0) is a node
  // int of r^(-2 a) over the square, from the triangle between the axis and the diagonal.
  const auto exact = [](double a) {
    double whole = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double angle = 0.25 * std::numbers::pi * (i + 0.5) / n;
      whole += std::pow(1 / std::cos(angle), 2 - 2 * a) / (2 - 2 * a);
    }
    return 8 * 0.25 * std::numbers::pi / n * whole;
  };
  for (const double a : {0.25, 0.6, 0.75, 0.9}) {
    expect_honest(mesh, "(x^2 + y^2)^(-" + text(a) + ")", exact(a));
  }
  for (const double a : {0.25, 0.6}) {
    std::vector<double> load;
    integrate(mesh, "(x^2 + y^2)^(-" + text(a) + ")", load, {.relative_tolerance = 1e-6});
    EXPECT_NEAR(sum(load) / exact(a), 1, 1e-6);
  }
}

TEST(Singularity, AlongALineIsToldAsItIs) {
  for (const double shake : {0.0, 0.2}) {
    const PlaneMesh mesh = square_mesh(20, shake, 4);
    expect_honest(mesh, "abs(x)^-0.5", 8);
    expect_honest(mesh, "abs(x - 0.0123)^-0.5",
                  4 * (std::sqrt(1 - 0.0123) + std::sqrt(1 + 0.0123)));
    expect_honest(mesh, "log(abs(x))", -4);
    // int |x + y/5|^(1/2)
    expect_honest(mesh, "sqrt(abs(x + 0.2*y))",
                  2 * 4.0 / 15 / 0.2 * (std::pow(1.2, 2.5) - std::pow(0.8, 2.5)));
  }
}

TEST(Singularity, WithoutAnIntegralHasNoEstimate) {
  const PlaneMesh mesh = square_mesh(10, 0, 0);
  for (const char* f : {"1/(x^2 + y^2)", "1/abs(x)", "(x^2 + y^2)^-1.5", "1/(x - 0.0123)^2"}) {
    std::vector<double> load;
    EXPECT_TRUE(std::isinf(integrate(mesh, f, load, {.work = 5e7}).relative_error_estimate)) << f;
  }
}

constexpr const char* noise =
    "sin(12989.8*x + 78233*y)*43758.5453 - floor(sin(12989.8*x + 78233*y)*43758.5453)";

TEST(Limits, AreKeptAndTold) {
  const PlaneMesh mesh = square_mesh(10, 0.2, 2);
  std::vector<double> load;
  const auto report = integrate(mesh, noise, load, {.work = 2e6});
  EXPECT_GT(report.relative_error_estimate, 1e-3);
  EXPECT_LT(report.evaluations, 400'000U);
  EXPECT_NEAR(sum(load), 2, 2 * report.relative_error_estimate);
}

TEST(Limits, TheRestGoesToTheWorst) {
  const PlaneMesh mesh{{-1, -1, 1, -1, 0, 1}, {0, 1, 2}};
  const std::string f = inside({0, -0.3}, 0.4);
  const std::vector<double> exact = loads_of_disc(mesh, {0, -0.3}, 0.4);
  EXPECT_GT(compare("starved", mesh, f, exact, {.work = 1000}).report.relative_error_estimate,
            1e-10);
  const LoadErrors fed = compare("fed", mesh, f, exact);
  EXPECT_LT(fed.report.relative_error_estimate, 1e-10);
  EXPECT_LT(fed.whole, 1e-11);
}

TEST(Limits, HoldForATriangleFullOfJumps) {
  const PlaneMesh mesh{{-1, -1, 1, -1, 0, 1}, {0, 1, 2}};
  std::vector<double> load;
  const auto report = integrate(mesh, noise, load, {.work = 2e6});
  EXPECT_GT(report.relative_error_estimate, 1e-3);
  EXPECT_LT(report.evaluations, 500'000U);
}

TEST(Repeat, GivesTheSameBits) {
  const PlaneMesh mesh = square_mesh(20, 0.2, 2);
  std::vector<double> first, second;
  for (const char* f : {"x*y + x > 0.1 ? exp(x) : -1", noise}) {
    integrate(mesh, f, first, {.work = 1e6});
    integrate(mesh, f, second, {.work = 1e6});
    EXPECT_EQ(first, second);
  }
}

TEST(BadField, EndsTheWork) {
  const PlaneMesh mesh = square_mesh(4, 0, 0);
  std::vector<double> load;
  EXPECT_TRUE(throws([&] { integrate(mesh, "x > 0.5 && y > 0 ? sqrt(-1 - x) : 1", load); },
                     errors::Reason::expression_invalid));
}

TEST(Stop, EndsTheWorkSoon) {
  const PlaneMesh mesh = square_mesh(100, 0, 0);
  std::vector<double> load;
  for (const char* f : {noise, "sqrt(abs(sin(1000*x*y)))", "sin(1e5*x*y) > 0 ? 1 : -1"}) {
    std::stop_source stop;
    const std::jthread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      stop.request_stop();
    });
    const stop::Scope scope(stop.get_token());
    EXPECT_TRUE(
        throws([&] { integrate(mesh, f, load, {.work = 1e14}); }, errors::Reason::cancelled))
        << f;
  }
}

TEST(Constant, AsTextHasTheBitsOfTheConstant) {
  const PlaneMesh mesh = square_mesh(7, 0.2, 2);
  const fem::Triangulation part{mesh.xy, mesh.triangles};
  for (const char* one : {"0.3", "(0.1*3 - 0.3)*x^0 + 0.3", "0.3 + 0*1"}) {
    const double value = expression::Function(one, "f")(0, 0);
    EXPECT_EQ(fem::load_vector(part, fem::Expression{one}, "a"),
              fem::load_vector(part, value, "a"));
  }
  const Eigen::VectorXd plane = fem::load_vector(part, fem::Expression{"1 + 2*x - y/3"}, "a");
  EXPECT_NEAR(plane.sum(), 4, 1e-13);
}

/// Bisection towards tips makes triangles that coordinates hardly resolve.
TEST(FlatTriangle, HasNoLoadAndDisturbsNoOther) {
  const PlaneMesh mesh{{0, 0, 1, 0, 0, 1, 0, 1}, {0, 1, 2, 1, 2, 3}};
  const std::string f = "x + y > 0.4 ? 3 : 0";
  const PlaneMesh first{mesh.xy, {0, 1, 2}};
  const std::vector<double> exact = loads_cut_by_lines(first, {{1, 1, 0.4}}, field(f));
  std::vector<double> load;
  const auto report = integrate(mesh, f, load);
  EXPECT_LT(report.relative_error_estimate, 1e-10);
  for (std::size_t i = 0; i < load.size(); ++i) {
    EXPECT_NEAR(load[i], exact[i], 1e-11) << i;
  }
}

}  // namespace
}  // namespace anticrack::testing
