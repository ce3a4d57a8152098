// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/load.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

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
