// SPDX-License-Identifier: GPL-3.0-or-later
#include "expression/function.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <thread>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "fem/load.hpp"
#include "fem/load_vector.hpp"

namespace anticrack::fem {
namespace {

using errors::Reason;
using ::testing::HasSubstr;

constexpr std::size_t length_limit = 200;

/// The error `check` throws for a load; fails the test when it throws none.
errors::Error error_of(const Load& load) {
  try {
    check(load, length_limit);
  } catch (const errors::Error& error) {
    return error;
  }
  ADD_FAILURE() << "accepted";
  return {Reason::internal, "accepted"};
}

Load load_of(Force force, const std::string& boundary_value = {}) {
  Load load;
  load.name = "a";
  load.force = std::move(force);
  load.boundary_value = boundary_value;
  return load;
}

std::string field_of(const errors::Error& error) {
  return error.fields().empty() ? "" : error.fields().front().field;
}

TEST(Expression, KnowsCoordinatesFunctionsConstantsAndConditions) {
  const expression::Function function("y > 0 && x <= 1 ? sin(_pi*x)^2 + 0*_e : -abs(y)", "f");
  EXPECT_NEAR(function(0.5, 1), 1.0, 1e-15);
  EXPECT_EQ(function(0.5, -2), -2.0);
  EXPECT_EQ(function(2, 3), -3.0);
}

class Refused : public ::testing::TestWithParam<const char*> {};

TEST_P(Refused, InBothFieldsThatTakeExpressions) {
  const errors::Error force = error_of(load_of(Expression{GetParam()}));
  EXPECT_EQ(force.reason(), Reason::expression_invalid) << force.what();
  EXPECT_EQ(field_of(force), "force.expression");
  if (*GetParam() != '\0') {
    const errors::Error boundary = error_of(load_of(1.0, GetParam()));
    EXPECT_EQ(boundary.reason(), Reason::expression_invalid) << boundary.what();
    EXPECT_EQ(field_of(boundary), "boundary_value");
  }
}

INSTANTIATE_TEST_SUITE_P(Expressions, Refused,
                         ::testing::Values("", "  ", "1 +", "z", "sin(x", "foo(x)", "x = 2",
                                           "y = x > 0", "1, 2", "\"text\"", "x y", "atof(\"1\")",
                                           "x\x01", "\xd1\x84", "1 ? 2", "x; y"));

TEST(Expression, ComparisonsAreNoAssignments) {
  for (const char* text : {"x == 1", "x<=1", "x >= 1", "x != 1", "(x==y)*(y==x)"}) {
    EXPECT_NO_THROW(check(load_of(Expression{text}), length_limit)) << text;
  }
}

TEST(Expression, ThatIsANumberWithAUnitNamesTheNumber) {
  for (const char* text : {"3 N/mm", " 3N / mm", "3kPa"})
    EXPECT_THAT(error_of(load_of(Expression{text})).what(), HasSubstr("with a unit; write 3:"));
  for (const char* text : {"3 x", "3 sin(x)", "z", "N/mm"})
    EXPECT_THAT(error_of(load_of(Expression{text})).what(), HasSubstr("cannot be read")) << text;
}

TEST(Expression, LongerThanTheLimitIsRefused) {
  const errors::Error error = error_of(load_of(Expression{std::string(length_limit + 1, '1')}));
  EXPECT_EQ(error.reason(), Reason::expression_invalid);
  EXPECT_THAT(error.what(), HasSubstr("201"));
}

TEST(Expression, NestedAsDeepAsItsLengthAllowsIsRead) {
  constexpr std::size_t depth = 2000;
  const std::string text = std::string(depth, '(') + "x" + std::string(depth, ')');
  const expression::Function function(text, "f");
  EXPECT_EQ(function(3, 0), 3.0);
}

// Only ThreadSanitizer sees this one fail, and only in a process that has read no number before.
TEST(Expression, MayBeTheFirstOnManyThreadsAtOnce) {
  std::atomic<int> ready = 0;
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&ready] {
      for (++ready; ready < 4;) {
      }
      const expression::Function function("1.5 * x", "f");
      EXPECT_EQ(function(2, 0), 3.0);
    });
  }
}

TEST(Expression, ValueThatIsNotFiniteNamesThePlace) {
  const expression::Function function("1/(x-2)", "force.expression");
  EXPECT_EQ(function(3, 0), 1.0);
  try {
    function(2, 0.25);
    FAIL() << "accepted";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), Reason::expression_invalid);
    EXPECT_EQ(field_of(error), "force.expression");
    EXPECT_THAT(error.what(), HasSubstr("inf at (x, y) = (2, 0.25)"));
  }
}

TEST(Expression, NotANumberInsideATriangleNamesThePlace) {
  const Triangulation part{{0, 0, 1, 0, 0, 1}, {0, 1, 2}};
  try {
    load_vector(part, Expression{"sqrt(x - 2)"}, "a");
    FAIL() << "accepted";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), Reason::expression_invalid);
    EXPECT_THAT(error.what(), HasSubstr("nan at (x, y) = ("));
  }
}

}  // namespace
}  // namespace anticrack::fem
