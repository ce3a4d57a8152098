// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/pressure.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/sample_result.hpp"

namespace anticrack::figures {
namespace {

using anticrack::testing::sample_result;

TEST(Peaks, end_the_axis_by_weight_and_not_by_number) {
  // Nine nodes in ten lie near a tip.
  std::vector<std::pair<double, double>> values{{1, 10}};
  for (int i = 0; i < 9; ++i) values.emplace_back(std::pow(10, i + 1), 1e-3);
  const Peaks seen = peaks(values, 0.9, 1.5);
  EXPECT_EQ(seen.highest, 1e9);
  EXPECT_EQ(seen.shown, 1.5);
  EXPECT_TRUE(seen.cut_off());
}

TEST(Peaks, are_shown_where_they_are_little_above_the_end) {
  const Peaks seen = peaks({{1, 10}, {1.8, 0.1}}, 0.9, 1.5);
  EXPECT_EQ(seen.shown, 1.8);
  EXPECT_FALSE(seen.cut_off());
  EXPECT_EQ(peaks({}, 0.9, 1.5).shown, 0);
}

TEST(Pressure, is_none_on_glue_and_on_free_cracks) {
  auto result = sample_result(10);
  auto& trace = result.loads[1].traces[0];
  trace.pressure.front() = 7;  // the flux of glue
  result.interfaces[0].kind[12] = results::Kind::free;
  const Pressure seen = pressure(result.interfaces[0], trace);
  EXPECT_TRUE(std::isnan(seen.values.front()));
  EXPECT_TRUE(std::isnan(seen.values[12]));
  EXPECT_EQ(seen.values[6], trace.pressure[6]);
  EXPECT_EQ(seen.values[13], 0);  // open
}

TEST(Pressure, has_no_axis_without_contact) {
  const auto result = sample_result(10);
  EXPECT_EQ(pressure(result.interfaces[0], result.loads[0].traces[0]).peaks.highest, 0);
}

}  // namespace
}  // namespace anticrack::figures
