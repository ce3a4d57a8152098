// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/axes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace anticrack::figures {
namespace {

using ::testing::HasSubstr;

TEST(Axes, have_round_labels_not_too_many) {
  EXPECT_DOUBLE_EQ(label_step({0, 1}, 5), 0.2);
  EXPECT_DOUBLE_EQ(label_step({-1, 1}, 4), 0.5);
  EXPECT_DOUBLE_EQ(label_step({0, 100000}, 6), 20000);
  for (const double size : {1.0, 1.7, 2.3, 4.9, 5.1, 9.99}) {
    for (const int most : {4, 6, 9}) {
      EXPECT_LE(size / label_step({0, size}, most), 1.05 * most) << size;
    }
  }
}

TEST(Axes, of_a_range_without_extent_reach_around_it) {
  EXPECT_THAT(axis_range('y', {0, 0}), HasSubstr("set yrange [-1:1]"));
  EXPECT_THAT(axis_range('x', {2, 2}), HasSubstr("set xrange [1:3]"));
  EXPECT_THAT(axis_range('y', empty_range()), HasSubstr("set yrange [-1:1]"));
  EXPECT_THAT(axis_range('x', {-0.5, 0.5}, 6, 1), HasSubstr("set xtics 1\n"));
}

TEST(Axes, with_a_log_scale_label_whole_decades_or_parts_of_few) {
  EXPECT_THAT(log_axis('x', {100, 1500}), HasSubstr("('' 90 1, '100' 100, '200' 200, '' 300 1"));
  EXPECT_THAT(log_axis('y', {1e-5, 2e-2}), HasSubstr("'10\xE2\x81\xBB\xE2\x81\xB4' 0.0001"));
  EXPECT_THAT(log_axis('x', {100, 1500}, false), HasSubstr("('' 90 1, '' 100, "));
  EXPECT_THAT(log_axis('x', {1, 1e9}), HasSubstr("'10\xE2\x81\xB0' 1, '' 10 1, '10\xC2\xB2' 100"));
  EXPECT_THAT(log_axis('x', {300, 900}), HasSubstr("'400' 400, '600' 600, "));
  EXPECT_THAT(log_axis('y', {0.0075, 0.014}), HasSubstr("'0.012' 0.012, '0.014' 0.014"));
}

TEST(Axes, with_a_log_scale_have_two_labels_at_least) {
  for (double low = 1e-3; low < 1e-2; low *= 1.07) {
    for (double size = 1; size < 1e15; size *= 1.3) {
      const std::string axis = log_axis('y', {low, size * low});
      int labels = 0;
      for (std::size_t at = 0; (at = axis.find("' ", at)) != std::string::npos; ++at)
        labels += axis[at - 1] != '\'' ? 1 : 0;
      EXPECT_GE(labels, 2) << low << " " << size << "\n" << axis;
      EXPECT_LE(labels, 8) << low << " " << size << "\n" << axis;
    }
  }
}

TEST(Range, takes_in_what_is_finite) {
  Range range = empty_range();
  for (const double value : {2.0, std::nan(""), -1.0, HUGE_VAL}) range.include(value);
  EXPECT_EQ(range.low, -1);
  EXPECT_EQ(range.high, 2);
}

TEST(Scale, is_a_power_of_ten_for_what_is_small_or_large) {
  for (const Range plain : {Range{0, 0.002}, Range{-1, 1}, Range{0, 99999}, Range{0, 0}}) {
    EXPECT_EQ(Scale(plain).label("u", ""), "u");
    EXPECT_EQ(Scale(plain).label("u", "mm"), "u [mm]");
    EXPECT_EQ(Scale(plain).column(2), "2");
    EXPECT_EQ(Scale(plain).drawn(plain).high, plain.high);
  }
  const Scale micro({-3e-6, 2e-6});
  EXPECT_EQ(micro.label("u", ""), "u [10\xE2\x81\xBB\xE2\x81\xB6]");
  EXPECT_EQ(micro.label("u", "mm"), "u [10\xE2\x81\xBB\xE2\x81\xB6 mm]");
  EXPECT_EQ(micro.column(4), "($4*1e6)");
  EXPECT_DOUBLE_EQ(micro.drawn({-3e-6, 2e-6}).low, -3);
  EXPECT_EQ(Scale({0, 2e5}).column(2), "($2*1e-3)");
}

}  // namespace
}  // namespace anticrack::figures
