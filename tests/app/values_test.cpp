// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/values.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace anticrack::app {
namespace {

TEST(Bytes, AreReadWithEverySuffix) {
  EXPECT_EQ(to_bytes("0"), 0u);
  EXPECT_EQ(to_bytes("1000"), 1000u);
  EXPECT_EQ(to_bytes("4K"), 4'000u);
  EXPECT_EQ(to_bytes("4KB"), 4'000u);
  EXPECT_EQ(to_bytes("4KiB"), 4'096u);
  EXPECT_EQ(to_bytes("512 MiB"), 512ull << 20);
  EXPECT_EQ(to_bytes("1.5GiB"), 3ull << 29);
  EXPECT_EQ(to_bytes("2G"), 2'000'000'000u);
  EXPECT_EQ(to_bytes("1Ti"), 1ull << 40);
  EXPECT_EQ(to_bytes("7B"), 7u);
  EXPECT_EQ(to_bytes("6e9"), 6'000'000'000u);
}

TEST(Bytes, OfOtherFormsAreRefused) {
  for (const char* text : {"", "GiB", "-1", "1X", "1 G B", "nan", "inf", "1e30", "99999999Ti"}) {
    EXPECT_THROW(to_bytes(text), std::invalid_argument) << text;
  }
}

TEST(Bytes, AreWrittenSoThatTheyAreReadBack) {
  for (const std::uint64_t bytes :
       {0ull, 1ull, 1000ull, 1ull << 10, 3ull << 29, (1ull << 40) + 1}) {
    EXPECT_EQ(to_bytes(from_bytes(bytes)), bytes);
  }
  EXPECT_EQ(from_bytes(6ull << 30), "6GiB");
}

TEST(Integers, KeepTheirRange) {
  EXPECT_EQ(to_integer("12", 0, 12), 12);
  for (const char* text : {"13", "-1", "1.5", "", "x", "99999999999999999999"}) {
    EXPECT_THROW(to_integer(text, 0, 12), std::invalid_argument) << text;
  }
}

TEST(Times, AreReadWithEveryUnit) {
  EXPECT_EQ(to_time("3").count(), 3000);
  EXPECT_EQ(to_time("0.25s").count(), 250);
  EXPECT_EQ(to_time("90s"), std::chrono::seconds(90));
  EXPECT_EQ(to_time("1.5 m"), std::chrono::seconds(90));
  EXPECT_EQ(to_time("12h"), std::chrono::hours(12));
  EXPECT_EQ(to_time("30d"), std::chrono::hours(30 * 24));
}

TEST(Times, OfOtherFormsAreRefused) {
  for (const char* text : {"", "s", "-1", "3w", "1h30m", "31d", "2592001", "nan"}) {
    EXPECT_THROW(to_time(text), std::invalid_argument) << text;
  }
}

TEST(Times, AreWrittenSoThatTheyAreReadBack) {
  for (const std::int64_t time : {0LL, 1LL, 999LL, 3000LL, 3005LL, 60'000LL, 61'000LL, 5400'000LL,
                                  43'200'000LL, 604'800'000LL}) {
    EXPECT_EQ(to_time(from_time(std::chrono::milliseconds(time))).count(), time);
  }
  EXPECT_EQ(from_time(std::chrono::milliseconds(3000)), "3");
  EXPECT_EQ(from_time(std::chrono::milliseconds(3005)), "3.005");
  EXPECT_EQ(from_time(std::chrono::hours(7 * 24)), "7d");
  EXPECT_EQ(from_time(std::chrono::minutes(90)), "90m");
}

}  // namespace
}  // namespace anticrack::app
