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

TEST(Axes, have_a_label_where_no_round_one_lies_on_a_short_side) {
  EXPECT_EQ(tics('y', {0, 10}, 20, Scale()), "set ytics 0, 20, 10");
  EXPECT_EQ(tics('y', {11, 19}, 20, Scale()), "set ytics ('16' 16)");
  EXPECT_EQ(tics('y', {25.1, 25.9}, 20, Scale()), "set ytics ('25.6' 25.6)");
}

TEST(Axes, far_from_zero_leave_an_offset_out_and_say_so) {
  EXPECT_EQ(offset_of({-50, 50}), 0);
  EXPECT_EQ(offset_of({900, 1000}), 0);
  EXPECT_EQ(offset_of({6000000, 6000100}), 6000000);
  EXPECT_EQ(offset_of({-6000100, -6000000}), -6000000);
  EXPECT_EQ(offset_of({50, 50.01}), 50);
  EXPECT_EQ(offset_of({50, 50.01}, 100), 0);  // a strip of a long sheet
  EXPECT_EQ(offset_of({5, 5}), 0);
  EXPECT_EQ(offset_of(empty_range()), 0);
  EXPECT_EQ(named_without("x", 6000000), "x \xE2\x88\x92 6000000");
  EXPECT_EQ(named_without("x", -0.5), "x + 0.5");
  EXPECT_EQ(named_without("x", 0), "x");
  EXPECT_EQ(axis_range('x', {6000020, 6000060}, 6, 20, Scale({6000000, 6000100})),
            "set xrange [6000020:6000060]\n"
            "set xtics ('20' 6000020, '40' 6000040, '60' 6000060)\n");
}

TEST(Axes, tell_a_point_from_its_neighbours) {
  EXPECT_EQ(point_text(0.5, 0, 1, 4), "(0.5, 0)");
  EXPECT_EQ(point_text(1.0 / 3, 2.0 / 3, 1, 4), "(0.3333, 0.6667)");
  EXPECT_EQ(point_text(6000020.25, 50, 100, 4), "(6000020.25, 50)");
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

TEST(Scale, leaves_an_offset_out) {
  const Scale lifted({1e6, 1e6 + 0.5});
  EXPECT_EQ(lifted.label("u", "mm"), "u \xE2\x88\x92 1000000 [mm]");
  EXPECT_EQ(lifted.column(2), "(($2-1000000)*1e0)");
  EXPECT_DOUBLE_EQ(lifted.drawn({1e6, 1e6 + 0.5}).high, 0.5);
  const Scale narrow({-1.5 - 2e-6, -1.5 + 2e-6});
  EXPECT_EQ(narrow.label("energy", "J"), "energy + 1.5 J [10\xE2\x81\xBB\xE2\x81\xB6 J]");
}

}  // namespace
}  // namespace anticrack::figures
