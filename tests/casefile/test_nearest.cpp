// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "words/nearest.hpp"

namespace anticrack::words {
namespace {

TEST(EditDistance, CountsTheFourMistakes) {
  EXPECT_EQ(edit_distance("theta", "theta"), 0U);
  EXPECT_EQ(edit_distance("theta", "thta"), 1U);
  EXPECT_EQ(edit_distance("theta", "thheta"), 1U);
  EXPECT_EQ(edit_distance("theta", "tieta"), 1U);
  EXPECT_EQ(edit_distance("theta", "thtea"), 1U);
  EXPECT_EQ(edit_distance("", "theta"), 5U);
  EXPECT_EQ(edit_distance("theta", ""), 5U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
}

TEST(EditDistance, IsSymmetric) {
  EXPECT_EQ(edit_distance("preset", "rpeest"), edit_distance("rpeest", "preset"));
}

TEST(Nearest, PrefersTheClosestAndIgnoresCase) {
  const std::vector<std::string> known{"mass", "max_iterations", "method", "p"};
  EXPECT_EQ(nearest("Mas", known), "mass");
  EXPECT_EQ(nearest("maxiterations", known), "max_iterations");
  EXPECT_EQ(nearest("METHOD", known), "method");
}

TEST(Nearest, SaysNothingWhereNothingIsNear) {
  EXPECT_FALSE(nearest("colour", {"theta", "p"}).has_value());
  EXPECT_FALSE(nearest("q", {"p"}).has_value());
  EXPECT_FALSE(nearest(std::string(10'000, 'x'), {"theta"}).has_value());
  EXPECT_FALSE(nearest("theta", {}).has_value());
}

TEST(Suggestion, ListsWhatIsKnownInOrder) {
  EXPECT_EQ(suggestion("colour", {"p", "mass"}), "known are mass, p");
}

}  // namespace
}  // namespace anticrack::words
