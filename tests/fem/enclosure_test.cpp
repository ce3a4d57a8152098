// SPDX-License-Identifier: GPL-3.0-or-later
//
// Enclosures hold what they enclose: values and derivatives of every operation, of random
// expressions of any shape, in random boxes.
#include "expression/enclosure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "expression/function.hpp"
#include "expression/parse.hpp"
#include "support/random_expression.hpp"

namespace anticrack::testing {
namespace {

using expression::Enclosure;
using expression::Interval;
using expression::Jet;

struct Box {
  double x, y, width, height;
};

double value(const expression::Tape& tape, double x, double y) {
  const expression::Ref root = tape.result();
  expression::Evaluator evaluator(tape, {&root, 1});
  std::array<double, expression::kernel_width> at_x{}, at_y{};
  at_x.fill(x);
  at_y.fill(y);
  evaluator(at_x.data(), at_y.data(), 1);
  return *evaluator.values(0);
}

/// f(q) by the Taylor polynomial about p whose coefficients of degree `order` are anywhere in the
/// box.
Interval taylor(const Jet& at_p, const Jet& box, int order, double dx, double dy) {
  Interval sum;
  for (int d = 0; d <= order; ++d) {
    for (int i = 0; i <= d; ++i) {
      const auto k = static_cast<std::size_t>(d * (d + 1) / 2 + i);
      const double factor = std::pow(dx, d - i) * std::pow(dy, i);
      sum = sum + factor * (d == order ? box.of[k] : at_p.of[k]);
    }
  }
  return sum;
}

void expect_enclosed(const std::string& text, const Box& box, std::mt19937& random) {
  const expression::Tape tape = expression::parse(text, "f");
  Enclosure enclosure(tape);
  const Jet jet = enclosure({box.x, box.x + box.width}, {box.y, box.y + box.height}, Jet::most);
  std::uniform_real_distribution<double> part(0, 1);
  for (int k = 0; k < 12; ++k) {
    const double px = box.x + part(random) * box.width, py = box.y + part(random) * box.height,
                 qx = box.x + part(random) * box.width, qy = box.y + part(random) * box.height;
    const double f = value(tape, qx, qy);
    if (!std::isfinite(f) || !std::isfinite(value(tape, px, py))) continue;
    const double slack = 1e-13 * std::abs(f);
    ASSERT_LE(jet.value().low, f + slack) << text << " at " << qx << ' ' << qy;
    ASSERT_GE(jet.value().high, f - slack) << text << " at " << qx << ' ' << qy;
    for (int order = 1; order <= jet.order; ++order) {
      const Jet at_p = enclosure({px, px}, {py, py}, order - 1);
      if (at_p.order < order - 1) continue;
      const Interval by = taylor(at_p, jet, order, qx - px, qy - py);
      const double rounding = 1e-12 * (std::abs(f) + at_p.value().magnitude());
      ASSERT_LE(by.low, f + rounding)
          << text << " of degree " << order << " from " << px << ' ' << py;
      ASSERT_GE(by.high, f - rounding)
          << text << " of degree " << order << " from " << px << ' ' << py;
    }
  }
}

Box random_box(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-2, 2), digits(-6, 0.5);
  return {place(random), place(random), std::pow(10, digits(random)), std::pow(10, digits(random))};
}

TEST(Enclosure, HoldsEachOperation) {
  std::mt19937 random(11);
  const std::string texts[] = {"x + y",
                               "x - y",
                               "x*y",
                               "x/y",
                               "-x^3*y",
                               "x^y",
                               "x^2.5",
                               "x^(-1.5)",
                               "x^17",
                               "x^(-18)",
                               "sqrt(x)",
                               "exp(x*y)",
                               "log(x + 3*y)",
                               "log2(x)",
                               "log10(x)",
                               "sin(3*x + y)",
                               "cos(x*y)",
                               "tan(x + y)",
                               "asin(x/3)",
                               "acos(x*y/5)",
                               "atan(x - y)",
                               "sinh(x)",
                               "cosh(x*y)",
                               "tanh(3*x)",
                               "asinh(x*y)",
                               "acosh(1.5 + x)",
                               "atanh(x/3)",
                               "atan2(y, x)",
                               "abs(x - y)",
                               "min(x, y^2)",
                               "max(x*y, y, x)",
                               "rint(3*x)",
                               "floor(2*y + x)",
                               "ceil(x)",
                               "sign(x*y)",
                               "x < y ? x : y^2",
                               "x <= y*y ? 1 : 2",
                               "x == y ? 5 : x",
                               "x != 1 ? y : 3",
                               "x > 0 && y > x ? 1 : x*y",
                               "x > 0 || y > x ? sin(x) : 2",
                               "(x > 0 ? 0 : 1) ? y : x"};
  for (const std::string& text : texts)
    for (int i = 0; i < 60; ++i) expect_enclosed(text, random_box(random), random);
}

TEST(Enclosure, HoldsRandomExpressions) {
  std::mt19937 random(12);
  RandomExpression expressions(13);
  for (int i = 0; i < 1500; ++i) {
    const std::string text = expressions.any(1 + i % 4);
    for (int k = 0; k < 4; ++k) expect_enclosed(text, random_box(random), random);
  }
}

TEST(Enclosure, IsCloseWhereABoxIsSmall) {
  const expression::Tape tape = expression::parse("exp(sin(3*x)*y)/(1 + x^2) + sqrt(2 + x*y)", "f");
  Enclosure enclosure(tape);
  for (const double width : {1e-2, 1e-4, 1e-6}) {
    const Jet jet = enclosure({0.3, 0.3 + width}, {-0.4, -0.4 + width}, Jet::most);
    ASSERT_EQ(jet.order, Jet::most);
    for (const Interval& coefficient : jet.of) EXPECT_LE(coefficient.radius(), 200 * width);
  }
}

TEST(Enclosure, TellsTheOneLineThatPassesAndBothSides) {
  const expression::Tape tape = expression::parse("x^2 + y^2 < 0.25 && x > 0 ? 7 : x", "f");
  Enclosure enclosure(tape);
  const Interval x{0.3, 0.6}, y{-0.1, 0.1};
  const Jet either = enclosure(x, y, Jet::most);
  EXPECT_TRUE(either.value().holds(7) && either.value().holds(0.6));
  const auto choice = enclosure.choice();
  ASSERT_TRUE(choice);
  std::vector<Enclosure::Choice> taken{*choice};
  EXPECT_TRUE(enclosure(x, y, 1, taken).value().is(7));
  EXPECT_NEAR(enclosure.argument().value().low, 0.3 * 0.3 - 0.25, 1e-12);
  taken.back().above = true;
  const Jet outside = enclosure(x, y, 1, taken);
  EXPECT_EQ(outside.value().low, 0.3);
  EXPECT_TRUE(outside.of[1].is(1));
  enclosure({-0.1, 0.6}, {-0.1, 0.6}, 1);  // the corner of both lines
  ASSERT_TRUE(enclosure.choice());
  taken = {*enclosure.choice()};
  enclosure({-0.1, 0.6}, {-0.1, 0.6}, 1, taken);
  EXPECT_TRUE(enclosure.choice());
  EXPECT_TRUE(enclosure({0.6, 0.7}, {-0.1, 0.6}, 1).of[1].is(1));
  EXPECT_FALSE(enclosure.choice());
}

TEST(Enclosure, ALineAlongABoxHasNoArea) {
  const expression::Tape tape = expression::parse("y > 0 ? 1 : -1", "f");
  Enclosure enclosure(tape);
  EXPECT_TRUE(enclosure({0, 1}, {0, 1}, 1).value().is(1));
  EXPECT_TRUE(enclosure({0, 1}, {-1, 0}, 1).value().is(-1));
  EXPECT_TRUE(enclosure({0, 1}, {0, 0}, 1).value().is(-1));  // the line itself
}

}  // namespace
}  // namespace anticrack::testing
