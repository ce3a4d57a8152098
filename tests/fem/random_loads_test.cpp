// SPDX-License-Identifier: GPL-3.0-or-later
//
// Integrals of random expressions (smooth, kinked, jumping, nested) against a slow reference: the
// mesh divided again and again, with many points in each of the triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>

#include "expression/evaluator.hpp"
#include "support/load_errors.hpp"
#include "support/random_expression.hpp"

namespace anticrack::testing {
namespace {

/// Loads by the midpoints of n^2 equal triangles in each: right to some 1 / n^2 where f is smooth
/// or bends, and to 1 / n of a triangle where it jumps.
std::vector<double> reference(const PlaneMesh& mesh, const std::string& text, std::size_t n) {
  const expression::Function f(text, "f");
  const expression::Ref root = f.tape().result();
  expression::Evaluator evaluator(f.tape(), {&root, 1});
  constexpr std::size_t block = expression::Evaluator::block;
  std::array<double, block> x{}, y{}, b{}, c{};
  std::vector<double> load(mesh.node_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Polygon p = corners(mesh, t);
    const double part = polygon_area(p) / static_cast<double>(n * n);
    std::size_t count = 0;
    const auto flush = [&] {
      evaluator(x.data(), y.data(), count);
      for (std::size_t i = 0; i < count; ++i) {
        const double value = part * evaluator.values(0)[i];
        const std::array<double, 3> phi{1 - b[i] - c[i], b[i], c[i]};
        for (std::size_t k = 0; k < 3; ++k) {
          load[static_cast<std::size_t>(mesh.triangles[3 * t + k])] += value * phi[k];
        }
      }
      count = 0;
    };
    const auto add = [&](double at_b, double at_c) {
      b[count] = at_b / static_cast<double>(n);
      c[count] = at_c / static_cast<double>(n);
      x[count] = p[0][0] + b[count] * (p[1][0] - p[0][0]) + c[count] * (p[2][0] - p[0][0]);
      y[count] = p[0][1] + b[count] * (p[1][1] - p[0][1]) + c[count] * (p[2][1] - p[0][1]);
      if (++count == block) flush();
    };
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; i + j < n; ++j) {
        const auto from_b = static_cast<double>(i), from_c = static_cast<double>(j);
        add(from_b + 1.0 / 3, from_c + 1.0 / 3);
        if (i + j + 1 < n) add(from_b + 2.0 / 3, from_c + 2.0 / 3);
      }
    }
    flush();
  }
  return load;
}

/// Sum of the differences of nodal values over int |f|, by the reference with n and with n / 2: how
/// far these two are apart says how far the reference can be trusted.
void expect_right(const PlaneMesh& mesh, const std::string& f, std::size_t n, double trusted) {
  std::vector<double> load;
  const auto report = integrate(mesh, f, load, {.relative_tolerance = 1e-6, .work = 1e9});
  const std::vector<double> fine = reference(mesh, f, n), coarse = reference(mesh, f, n / 2),
                            whole = reference(mesh, "abs(" + f + ")", n / 4);
  double error = 0, doubt = 0, absolute = 0;
  for (std::size_t i = 0; i < load.size(); ++i) {
    error += std::abs(load[i] - fine[i]);
    doubt += std::abs(coarse[i] - fine[i]);
    absolute += whole[i];
  }
  EXPECT_LE(error, 10 * report.relative_error_estimate * absolute + 2 * doubt + trusted * absolute)
      << f << "\nestimate " << report.relative_error_estimate;
  EXPECT_LE(report.relative_error_estimate, 1e-6) << f;
}

class RandomLoads : public ::testing::Test {
 protected:
  PlaneMesh mesh = square_mesh(7, 0.2, 5);
  RandomExpression random{4242};
};

TEST_F(RandomLoads, Smooth) {
  for (int i = 0; i < 40; ++i) {
    expect_right(mesh, "(" + random.smooth(10) + ")*(2 + " + random.smooth(3) + ")", 64, 1e-6);
  }
}

TEST_F(RandomLoads, Kinked) {
  for (int i = 0; i < 30; ++i) {
    const std::string kinked[] = {"abs(" + random.smooth(4) + " - " + random.number(1) + ")",
                                  "min(" + random.smooth(3) + ", " + random.smooth(3) + ")",
                                  "max(x, " + random.smooth(2) + ", y)"};
    expect_right(mesh, kinked[random.pick(3)] + " + " + random.smooth(2), 64, 1e-5);
  }
}

TEST_F(RandomLoads, Jumping) {
  for (int i = 0; i < 30; ++i) {
    expect_right(
        mesh, "(" + random.side() + " ? 1 + " + random.smooth(2) + " : " + random.number(1) + ")",
        128, 4e-4);
  }
}

TEST_F(RandomLoads, Nested) {
  for (int i = 0; i < 30; ++i) {
    const std::string nested[] = {
        "(" + random.side() + " && " + random.side() + " ? 1 : " + random.smooth(2) + ")",
        "(" + random.side() + " ? (" + random.side() + " ? 2 : x) : abs(y - " + random.number(1) +
            "))",
        "(abs(abs(x) - 0.4) + abs(y) < 0.35 ? 1 : " + random.number(1) + ")",
        "rint(3*x + " + random.smooth(1) + ")*(1 + y^2)",
        "floor(2*abs(x - y) + " + random.number(1) + ")",
        "(max(abs(x), abs(y)) > 0.6 ? sign(x*y) : " + random.smooth(2) + ")"};
    expect_right(mesh, nested[random.pick(6)], 128, 1e-3);
  }
}

}  // namespace
}  // namespace anticrack::testing
