// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <limits>

namespace anticrack::figures {
namespace {

using ::testing::ElementsAre;

TEST(Quoted, keeps_plain_text) {
  EXPECT_EQ(quoted("Example 3 of Rudoy & Shcherbakov (2016)"),
            "'Example 3 of Rudoy & Shcherbakov (2016)'");
  EXPECT_EQ(quoted("\xCE\xB8 \xE2\x89\xA4 \xCE\xB8*"), "'\xCE\xB8 \xE2\x89\xA4 \xCE\xB8*'");
  EXPECT_EQ(quoted(""), "''");
}

TEST(Quoted, cannot_be_left) {
  EXPECT_EQ(quoted("a'b"), "'a''b'");
  // gnuplot takes three quotes at the beginning for an empty string and another one.
  EXPECT_EQ(quoted("'; system('rm x'); '"), "'\xE2\x80\x99; system(''rm x''); '''");
  EXPECT_EQ(quoted("a\nb\r\tc"), "'a b  c'");
  EXPECT_EQ(quoted(std::string_view("a\0b", 3)), "'a b'");
}

TEST(Quoted, has_neither_backquotes_nor_backslashes) {
  const std::string text = quoted("`touch x` \\n \\`");
  EXPECT_EQ(text.find('`'), std::string::npos);
  EXPECT_EQ(text.find('\\'), std::string::npos);
}

TEST(Quoted, replaces_what_is_no_text) {
  EXPECT_EQ(quoted("a\xFF"
                   "b"),
            "'a b'");
  EXPECT_EQ(quoted("\xC0\xA7"), "'  '");            // overlong apostrophe
  EXPECT_EQ(quoted("\xE0\x80\xA7"), "'   '");       // and a longer one
  EXPECT_EQ(quoted("a\xE2\x80"), "'a  '");          // cut off
  EXPECT_EQ(quoted("\xED\xA0\x80"), "'   '");       // surrogate
  EXPECT_EQ(quoted("\xF4\x90\x80\x80"), "'    '");  // past Unicode
  EXPECT_EQ(quoted("\xC2\x85"), "'  '");            // C1 control
  EXPECT_EQ(quoted("\xE2\x80\xAE"
                   "abc"),
            "'   abc'");  // right-to-left override
}

TEST(Quoted, cuts_by_characters_and_says_so) {
  EXPECT_EQ(quoted("\xC3\xA9\xC3\xA9\xC3\xA9", 2), "'\xC3\xA9\xC3\xA9\xE2\x80\xA6'");
  EXPECT_EQ(quoted("abc", 3), "'abc'");
}

TEST(Number, does_not_depend_on_the_locale_and_marks_what_is_not_finite) {
  EXPECT_EQ(number(0.5), "0.5");
  EXPECT_EQ(number(-1e-12), "-1e-12");
  EXPECT_EQ(number(1.0 / 3), "0.333333333");
  EXPECT_EQ(number(std::numeric_limits<double>::infinity()), "NaN");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN()), "NaN");
}

TEST(Readable, is_written_as_in_print) {
  EXPECT_EQ(readable(0.0865712), "0.08657");
  EXPECT_EQ(bounded(-0.1703715, -0.1695454),
            "\xE2\x88\x92"
            "0.16996 \xC2\xB1 0.00042");
  EXPECT_EQ(bounded(1e-7, 1.2e-7),
            "(1.10 \xC2\xB1 0.10)\xC3\x97"
            "10\xE2\x81\xBB\xE2\x81\xB7");
  EXPECT_EQ(readable(-0.5),
            "\xE2\x88\x92"
            "0.5");
  EXPECT_EQ(readable(1e-12), "10\xE2\x81\xBB\xC2\xB9\xC2\xB2");
  EXPECT_EQ(readable(-4.55e-14, 3),
            "\xE2\x88\x92"
            "4.55\xC3\x97"
            "10\xE2\x81\xBB\xC2\xB9\xE2\x81\xB4");
}

TEST(Shortened, ends_in_an_ellipsis_where_it_is_cut) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "ab\xE2\x80\xA6");
  EXPECT_EQ(shortened("\xC3\xA9\xC3\xA9\xC3\xA9", 2), "\xC3\xA9\xE2\x80\xA6");
  EXPECT_EQ(length("\xC3\xA9\xC3\xA9\xC3\xA9"), 3u);
}

TEST(Wrapped, breaks_at_blanks_and_keeps_everything) {
  EXPECT_THAT(wrapped("a fibre pressed shut", 9, 5), ElementsAre("a fibre", "pressed", "shut"));
  EXPECT_THAT(wrapped("a fibre pressed shut", 9, 2), ElementsAre("a fibre", "pressed shut"));
  EXPECT_THAT(wrapped("unbreakable and on", 5, 2), ElementsAre("unbreakable", "and on"));
  EXPECT_THAT(wrapped("unbreakable", 5, 2), ElementsAre("unbreakable"));
  EXPECT_THAT(wrapped("short", 9, 2), ElementsAre("short"));
  EXPECT_THAT(wrapped("", 9, 2), ElementsAre());
}

TEST(FileStems, are_safe_and_unique) {
  EXPECT_THAT(file_stems({"opening", "partly closed", "partly_closed", "PARTLY_CLOSED"}, {}),
              ElementsAre("opening", "partly_closed", "partly_closed-2", "PARTLY_CLOSED-3"));
  EXPECT_THAT(file_stems({"../etc/passwd", "-rf", "", "a'b|c"}, {}),
              ElementsAre("load.._etc_passwd", "load-rf", "load", "a_b_c"));
}

TEST(FileStems, do_not_meet_in_a_suffix) {
  EXPECT_THAT(file_stems({"a", "a-traces"}, {"-traces"}), ElementsAre("a", "a-traces-2"));
  EXPECT_THAT(file_stems({"a-traces", "a"}, {"-traces"}), ElementsAre("a-traces", "a-2"));
}

}  // namespace
}  // namespace anticrack::figures
