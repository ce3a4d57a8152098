// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/large.hpp"

#include <gtest/gtest.h>

#include <cstddef>

namespace anticrack::base {
namespace {

/// An array that is not set shows what its memory held before.
TEST(Large, KeepsBlocksForTheNextOfTheirSizeUntilTheyAreReturned) {
  constexpr std::size_t count = std::size_t{64} << 20;
  constexpr char mark = 42;
  const auto first_of = [](std::size_t size) { return *Large<char>(size).data(); };
  Large<char>(count).front() = mark;
  EXPECT_NE(first_of(2 * count), mark);
  EXPECT_EQ(first_of(count), mark);
  EXPECT_EQ(first_of(count), mark);
  return_kept_blocks();
  EXPECT_NE(first_of(count), mark);
}

TEST(Large, KeepsTwoBlocksApart) {
  constexpr std::size_t count = std::size_t{32} << 20;
  for (int turn = 0; turn < 2; ++turn) {
    Large<char> a(count), b(count);
    EXPECT_NE(a.data(), b.data());
  }
}

}  // namespace
}  // namespace anticrack::base
