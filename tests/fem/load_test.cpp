// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/load.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include "expression/function.hpp"
#include "support/errors.hpp"

namespace anticrack::fem {
namespace {

using anticrack::testing::throws;
using errors::Reason;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Load good() {
  Load load;
  load.name = "all kinds";
  load.force = Array{std::string(64, 'a'), true, nullptr};
  load.boundary_value = "x";
  load.traction = "y > 0 ? 1 : 0";
  load.point_forces = {{0.1, 0.2, 3}, {0.1, 0.2, -3}};
  load.inclusion_forces = {{"fibre", 2.0}};
  load.inclusion_moments = {{"fibre", {0.5, -0.25}}};
  return load;
}

::testing::AssertionResult refuses(const std::function<void(Load&)>& spoil,
                                   const std::string& field,
                                   Reason reason = Reason::invalid_argument) {
  Load load = good();
  spoil(load);
  return throws([&] { check(load, 100); }, reason, field);
}

TEST(LoadCheck, AcceptsEveryKindOfLoad) {
  EXPECT_NO_THROW(check(good(), 100));
  EXPECT_NO_THROW(check(Load{}, 100));
}

TEST(LoadCheck, NamesTheFieldAtFault) {
  EXPECT_TRUE(refuses([](Load& load) { load.force = nan; }, "force.constant"));
  EXPECT_TRUE(refuses(
      [](Load& load) {
        load.force = PerRegion{{{"up", 1.0}, {"down", nan}}};
      },
      "force.per_region[down]"));
  EXPECT_TRUE(refuses([](Load& load) { load.force = Array{}; }, "force.array.upload"));
  EXPECT_TRUE(
      refuses([](Load& load) { load.traction = "x +"; }, "traction", Reason::expression_invalid));
  EXPECT_TRUE(refuses([](Load& load) { load.traction = std::string(101, '1'); }, "traction",
                      Reason::expression_invalid));
  EXPECT_TRUE(refuses([](Load& load) { load.boundary_value = "z"; }, "boundary_value",
                      Reason::expression_invalid));
  EXPECT_TRUE(refuses([](Load& load) { load.point_forces[1].x = nan; }, "point_forces[1].at"));
  EXPECT_TRUE(refuses([](Load& load) { load.point_forces[0].y = nan; }, "point_forces[0].at"));
  EXPECT_TRUE(
      refuses([](Load& load) { load.point_forces[1].value = HUGE_VAL; }, "point_forces[1].value"));
  EXPECT_TRUE(refuses([](Load& load) { load.inclusion_forces["b"] = nan; }, "inclusion_forces[b]"));
  EXPECT_TRUE(
      refuses([](Load& load) { load.inclusion_moments["b"].x = nan; }, "inclusion_moments[b]"));
  EXPECT_TRUE(refuses([](Load& load) { load.inclusion_moments["b"].y = HUGE_VAL; },
                      "inclusion_moments[b]"));
}

/// What a sum says of each part, whatever form the forces have.
TEST(SumOfLoads, HasTheSumOfEachPart) {
  Load dead{"dead", 2.0, "x", ""}, live{"live", Expression{"x + y"}, "1", "y"};
  dead.point_forces = {{1, 2, 3}};
  live.point_forces = {{4, 5, 6}};
  dead.inclusion_forces = {{"a", 1}};
  live.inclusion_forces = {{"a", 2}, {"b", 4}};
  live.inclusion_moments = {{"b", {1, -2}}};
  const Load both = sum(dead, -0.5, live, {"lower"});
  EXPECT_EQ(both.name, "live");
  EXPECT_NO_THROW(check(both, 1000));
  const auto at = [](const std::string& text) { return expression::Function(text, "text")(3, 5); };
  EXPECT_EQ(at(std::get<Expression>(both.force).text), 2 - 0.5 * 8);
  EXPECT_EQ(at(both.boundary_value), 3 - 0.5);
  EXPECT_EQ(at(both.traction), -0.5 * 5);
  ASSERT_EQ(both.point_forces.size(), 2U);
  EXPECT_EQ(both.point_forces[1].value, -3);
  EXPECT_EQ(both.inclusion_forces, (std::map<std::string, double>{{"a", 0}, {"b", -2}}));
  EXPECT_EQ(both.inclusion_moments.at("b").y, 1);

  live.force = PerRegion{{{"upper", 4}}};
  const auto regions = std::get<PerRegion>(sum(dead, 0.5, live, {"lower", "upper"}).force).values;
  EXPECT_EQ(regions, (std::map<std::string, double>{{"lower", 2}, {"upper", 4}}));
  EXPECT_EQ(obstacle_to_sum(dead.force, live.force), "");
  EXPECT_NE(obstacle_to_sum(Expression{"x"}, live.force), "");
  EXPECT_NE(obstacle_to_sum(Array{}, 0.0), "");
}

TEST(LoadCheck, CountsWhatACaseMayHave) {
  EXPECT_TRUE(refuses([](Load& load) { load.point_forces.resize(max_point_forces + 1); },
                      "point_forces", Reason::limit_exceeded));
  EXPECT_TRUE(refuses(
      [](Load& load) {
        for (std::size_t i = 0; i <= max_named_forces; ++i) {
          load.inclusion_forces[std::to_string(i)] = 1;
        }
      },
      "inclusion_forces", Reason::limit_exceeded));
  EXPECT_TRUE(refuses(
      [](Load& load) {
        for (std::size_t i = 0; i <= max_named_forces; ++i) {
          load.inclusion_moments[std::to_string(i)] = {1, 0};
        }
      },
      "inclusion_moments", Reason::limit_exceeded));
  EXPECT_TRUE(refuses(
      [](Load& load) {
        PerRegion regions;
        for (std::size_t i = 0; i <= max_named_forces; ++i) {
          regions.values[std::to_string(i)] = 1;
        }
        load.force = regions;
      },
      "force.per_region", Reason::limit_exceeded));
}

}  // namespace
}  // namespace anticrack::fem
