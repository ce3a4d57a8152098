// SPDX-License-Identifier: GPL-3.0-or-later
//
// Expressions against muParser: what it accepts has its value.
#include <gtest/gtest.h>
#include <muParser.h>

#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>

#include "expression/evaluator.hpp"
#include "expression/function.hpp"
#include "support/random_expression.hpp"

namespace anticrack::expression {
namespace {

/// muParser's own value. Its _pi has 13 digits.
class Reference {
 public:
  explicit Reference(const std::string& text) {
    _parser.DefineFun("floor", static_cast<double (*)(double)>(std::floor));
    _parser.DefineFun("ceil", static_cast<double (*)(double)>(std::ceil));
    _parser.DefineConst("_pi", std::numbers::pi);
    _parser.DefineVar("x", &_x);
    _parser.DefineVar("y", &_y);
    _parser.SetExpr(text);
  }
  double operator()(double x, double y) {
    _x = x;
    _y = y;
    return _parser.Eval();
  }

 private:
  double _x = 0, _y = 0;
  mu::Parser _parser;
};

std::vector<double> values(const Tape& tape, const std::vector<double>& x,
                           const std::vector<double>& y) {
  const Ref root = tape.result();
  Evaluator evaluator(tape, {&root, 1});
  std::vector<double> at_x = x, at_y = y;
  at_x.resize(Evaluator::block);
  at_y.resize(Evaluator::block);
  evaluator(at_x.data(), at_y.data(), x.size());
  return {evaluator.values(0), evaluator.values(0) + x.size()};
}

TEST(ExpressionReference, GrammarIsMuParsers) {
  for (const char* text : {"-2^2",        "2^-2",           "2^3^2",
                           "-x^2",        "2^-x^2",         "1-2-3",
                           "2*-3",        "1?2:3",          "0?1:x>1?5:6",
                           "1<2<3",       "1||0&&0",        "1.",
                           "  .5",        "1e-999",         "avg(1,2,6)",
                           "1<2==2>1",    "3-2?4:5",        "2>1?1:0+5",
                           "max(1)",      "sum(x>1?1:2,3)", "-1?2:3",
                           "2^x?1:2",     "1&&2>3",         "-x^-y",
                           "x^2^-1",      "2*x^2",          "1?2?3:4:5",
                           "1>2?1:2?3:4", "ln(2)",          "sin(x)^2",
                           "-sin(x)^2",   "2^sin(x)",       "x>y==1",
                           "2/3*4",       "2*3/4",          "x*-y",
                           "-(2)^2",      "1- -2^2",        "2*-x^2",
                           "-x>y",        "1e+3",           "1.e3",
                           "+2",          "1+ +2",          "1?-1:-2",
                           "x>1&&-y",     "rint(-0.3)",     "sign(-x)",
                           "x!=y",        "((x))",          "min(1,max(2,3),-x)",
                           "x^16",        "x^-3",           "x^0",
                           "x^0.5",       "abs(-y)^1.5"}) {
    Reference reference(text);
    const Function function(text, "f");
    for (const double x : {0.3, 1.7, 4.0}) {
      const double wanted = reference(x, 2.5);
      EXPECT_NEAR(function(x, 2.5), wanted, 4e-15 * std::abs(wanted)) << text << " at " << x;
    }
  }
}

TEST(ExpressionReference, FloorAndCeilAreKnown) {
  const Function function("floor(x) + 10*ceil(y)", "f");
  EXPECT_EQ(function(-0.5, 0.5), 9);
  EXPECT_EQ(function(2, -1.5), -8);
}

/// Values of random texts. What muParser computes from constants alone is left out where it takes
/// && and || of whole parts; sums of what cancels may differ by rounding.
TEST(ExpressionReference, RandomTextsHaveTheSameValues) {
  const unsigned seed = 77;
  std::cout << "seed " << seed << "\n";
  testing::RandomExpression random(seed);
  int compared = 0, different = 0;
  for (int i = 0; i < 8'000; ++i) {
    const std::string text = random.any(4);
    const Function function(text, "f");
    Reference reference(text);
    const std::vector<double> x{-0.83, -0.21, 0.13, 0.57}, y{0.91, 0.37, -0.29, -0.63};
    const std::vector<double> found = values(function.tape(), x, y);
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double wanted = reference(x[k], y[k]);
      if (!std::isfinite(wanted) || std::abs(wanted) > 1e8) continue;
      ++compared;
      different += std::abs(found[k] - wanted) <= 1e-9 * (1 + std::abs(wanted)) ? 0 : 1;
    }
  }
  EXPECT_GT(compared, 12'000);
  // Rounding right at a jump, e.g. in rint(8.25*2 + 0.5*0), decides the side.
  EXPECT_LT(different, compared / 200);
}

TEST(ExpressionReference, SmoothTextsAreRightToRounding) {
  testing::RandomExpression random(78);
  for (int i = 0; i < 500; ++i) {
    const std::string text = random.smooth(20) + " + " + random.smooth(3);
    const Function function(text, "f");
    Reference reference(text);
    const std::vector<double> x{-0.83, -0.21, 0.13, 0.57}, y{0.91, 0.37, -0.29, -0.63};
    const std::vector<double> found = values(function.tape(), x, y);
    for (std::size_t k = 0; k < x.size(); ++k) {
      EXPECT_NEAR(found[k], reference(x[k], y[k]), 1e-14) << text;
    }
  }
}

TEST(Tape, ComputesConstantsOnceAndSharesWhatIsEqual) {
  const auto operations = [](const char* text) {
    const Function function(text, "f");
    const Ref root = function.tape().result();
    return Evaluator(function.tape(), {&root, 1}).cost();
  };
  EXPECT_EQ(operations("2*3 + sin(4)"), 0);
  EXPECT_EQ(operations("sin(x*y) + sin(y*x) + sin(x*y)"),
            operations("sin(x*y)") + 2 * operations("x + y"));
}

TEST(Tape, KnowsDegrees) {
  const auto degree = [](const char* text) {
    const Function function(text, "f");
    return function.tape().degree(function.tape().result());
  };
  EXPECT_EQ(degree("2 + 3^4"), 0);
  EXPECT_EQ(degree("2*x - y/3"), 1);
  EXPECT_EQ(degree("(x + y)^3*x"), 4);
  EXPECT_EQ(degree("x/y"), Tape::no_polynomial);
  EXPECT_EQ(degree("x^0.5"), Tape::no_polynomial);
}

TEST(Tape, KnowsItsSwitches) {
  const auto switches = [](const char* text) {
    return Function(text, "f").tape().switches().size();
  };
  EXPECT_EQ(switches("sin(x) + y"), 0U);
  EXPECT_EQ(switches("x > y ? 1 : 2"), 1U);
  EXPECT_EQ(switches("(x > y) + (y <= x) + abs(x - y)"), 1U);
  EXPECT_EQ(switches("x*y > 0"), 2U);
  EXPECT_EQ(switches("rint(4*x) + floor(y)"), 2U);
  EXPECT_EQ(switches("max(x, y, x*y)"), 2U);
}

}  // namespace
}  // namespace anticrack::expression
