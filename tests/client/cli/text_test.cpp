// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/text.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <limits>

#include "results/result.hpp"
#include "words/shown.hpp"

namespace anticrack::cli {
namespace {

TEST(Sanitise, TakesTheTerminalOutOfTheServersHands) {
  EXPECT_EQ(sanitise("\x1b[2Jgone\r\n\t\x7f"), "?[2Jgone????");
  EXPECT_EQ(sanitise("\xc2\x9b"
                     "31m"),
            "?31m")
      << "the C1 control CSI, in UTF-8";
  EXPECT_EQ(sanitise(std::string("a\0b", 3)), "a?b");
}

TEST(Bytes, ArePrintedInAUnitThatFits) {
  EXPECT_EQ(bytes(0), "0 B");
  EXPECT_EQ(bytes(999), "999 B");
  EXPECT_EQ(bytes(4'136'000), "4.14 MB");
  EXPECT_EQ(bytes(999'999), "1 MB");
  EXPECT_EQ(bytes(12'640'000'000), "12.6 GB");
}

TEST(Sanitise, KeepsText) {
  EXPECT_EQ(sanitise("Плита δ = 0,5 — \xf0\x9f\x99\x82"), "Плита δ = 0,5 — \xf0\x9f\x99\x82");
}

TEST(Sanitise, ReplacesWhatIsNoUtf8) {
  EXPECT_EQ(sanitise("a\xff"
                     "b"),
            "a?b");
  EXPECT_EQ(sanitise("\xe2\x82"), "??") << "cut off";
  EXPECT_EQ(sanitise("\xc0\xaf"), "??") << "overlong";
  EXPECT_EQ(sanitise("\xed\xa0\x80"), "???") << "a surrogate";
  EXPECT_EQ(sanitise("\xf5\x80\x80\x80"), "????") << "beyond Unicode";
}

TEST(Sanitise, ReplacesMarksThatReorderALine) {
  EXPECT_EQ(sanitise("a\xe2\x80\xae"
                     "b"),
            "a?b");
  for (const char* hidden : {"\u202a", "\u202b", "\u202c", "\u202d", "\u2066", "\u2067", "\u2068",
                             "\u2069", "\u200e", "\u200f", "\u061c"})
    EXPECT_EQ(sanitise(std::string("a") + hidden + "b"), "a?b");
}

TEST(Sanitise, ReplacesWhatBreaksALineOrIsNotSeen) {
  for (const char* hidden :
       {"\u0085",     "\u2028",     "\u2029",     "\u000b",    "\u000c", "\u00ad", "\u034f",
        "\u115f",     "\u180e",     "\u200b",     "\u200c",    "\u200d", "\u2060", "\u2063",
        "\u206a",     "\u3164",     "\ufe0f",     "\ufeff",    "\uffa0", "\ufff9", "\U000e0001",
        "\U000e0041", "\U000e01ef", "\U0001d173", "\U000110bd"})
    EXPECT_EQ(sanitise(std::string("a") + hidden + "b"), "a?b")
        << words::first_character(hidden).code;
}

TEST(Sanitise, IsUndoneByReadersOfJson) {
  EXPECT_EQ(words::escaped_in_json("{\n \"a\": \"\u202eb\U000e0041\"}"),
            "{\n \"a\": \"\\u202eb\\udb40\\udc41\"}");
}

TEST(Columns, AreThoseOfATerminal) {
  EXPECT_EQ(columns_of(""), 0U);
  EXPECT_EQ(columns_of("δδ"), 2U);
  EXPECT_EQ(columns_of("大きさ"), 6U);
  EXPECT_EQ(columns_of("e\xcc\x81"), 1U) << "an accent of its own";
}

TEST(Fit, CutsWideCharactersToTheColumnsThereAre) {
  EXPECT_EQ(fit("大きさ", 6), "大きさ");
  EXPECT_EQ(fit("大きさ", 5), "大き~");
  EXPECT_EQ(fit("大きさ", 4), "大~");
  EXPECT_EQ(fit("大きさ", 1), "~");
}

TEST(Fit, CutsBetweenCodePoints) {
  EXPECT_EQ(fit("abc", 3), "abc");
  EXPECT_EQ(fit("abcd", 3), "ab~");
  EXPECT_EQ(fit("δδδδ", 3), "δδ~");
  EXPECT_EQ(fit("abc", 1), "~");
  EXPECT_EQ(fit("abc", 0), "");
}

TEST(Pad, IsByColumnsAndNeverCuts) {
  EXPECT_EQ(pad_right("δ", 3), "δ  ");
  EXPECT_EQ(pad_left("δ", 3), "  δ");
  EXPECT_EQ(pad_left("abcd", 3), "abcd");
}

TEST(Number, IsShortAndSaysWhenThereIsNone) {
  EXPECT_EQ(number(2.0, 4), "2");
  EXPECT_EQ(number(1.74321, 4), "1.743");
  EXPECT_EQ(number(9.56e-13, 2, true), "9.56e-13");
  EXPECT_EQ(number(-0.0), "0");
  EXPECT_EQ(exact(-0.0), "0");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN()), "-");
  EXPECT_EQ(number(std::numeric_limits<double>::infinity()), "-");
}

TEST(Text, IntervalsContainWhatTheyPrint) {
  EXPECT_EQ(results::interval(0.1038235, 0.1028791, 0.1047679), "0.10382 +- 0.00095");
  EXPECT_EQ(results::interval(-0.16995845, -0.1703715, -0.1695454), "-0.16996 +- 0.00042");
  EXPECT_EQ(results::interval(1, 1, 1), "1.000000 +- 0.000000");
  EXPECT_EQ(results::interval(1e-5, -2e-5, 4e-5), "(1.0 +- 3.0)e-5");
  EXPECT_EQ(results::interval(123456894, 123456789, 123456999), "(1.234569 +- 0.000002)e8");
  EXPECT_EQ(results::interval(0, 0, 0), "0 +- 0");
  EXPECT_EQ(results::interval(0, 0, std::numeric_limits<double>::infinity()), "-");
}

TEST(Seconds, AreNoFinerThanATenthOfAMillisecond) {
  EXPECT_EQ(seconds(0.011756), "0.0118");
  EXPECT_EQ(seconds(9.87e-05), "0.0001");
  EXPECT_EQ(seconds(12.345), "12.3");
  EXPECT_EQ(seconds(0), "0");
  EXPECT_EQ(seconds(std::numeric_limits<double>::quiet_NaN()), "-");
}

TEST(ClockText, IsInTheZoneOfTheComputer) {
  const char* before = std::getenv("TZ");
  const std::string zone = before == nullptr ? "" : before;
  setenv("TZ", "XYZ-2", 1);  // two hours east of Greenwich
  tzset();
  EXPECT_EQ(clock_text(0), "1970-01-01 02:00:00");
  EXPECT_EQ(clock_text(1'700'000'000), "2023-11-15 00:13:20");
  before == nullptr ? unsetenv("TZ") : setenv("TZ", zone.c_str(), 1);
  tzset();
  EXPECT_EQ(clock_text(std::numeric_limits<std::int64_t>::max()), "-");
}

TEST(Table, AlignsNumbersRightAndTextLeft) {
  EXPECT_EQ(table({{"load", "status", "A"}, {"one", "converged", "0.5"}, {"δ", "-", "12.25"}}, {1}),
            "load  status         A\n"
            "one   converged    0.5\n"
            "δ     -          12.25\n");
}

TEST(Table, TakesRowsOfDifferentLength) {
  EXPECT_EQ(table({{"a"}, {"b", "c"}}), "a\nb  c\n");
  EXPECT_EQ(table({}), "");
}

TEST(PerCent, HasTwoDigitsAndNoExponentFromAHundredOn) {
  EXPECT_EQ(per_cent(0.00821), "0.82 %");
  EXPECT_EQ(per_cent(0.1234), "12 %");
  EXPECT_EQ(per_cent(1), "100 %");
  EXPECT_EQ(per_cent(1.13), "113 %");
  EXPECT_EQ(per_cent(std::numeric_limits<double>::quiet_NaN()), "- %");
}

}  // namespace
}  // namespace anticrack::cli
