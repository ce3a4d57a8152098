// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/marking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace anticrack::estimate {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

TEST(Marking, SplitsWhereTheErrorIs) {
  EXPECT_THAT(levels(std::vector<double>{1, 1, 1, 1}, 4), Each(2)) << "four pieces each";
  EXPECT_THAT(levels(std::vector<double>{1, 1, 1, 1}, 2), Each(1));
  EXPECT_THAT(levels(std::vector<double>{16, 1, 1, 0}, 4), ElementsAre(2, 0, 0, 0));
}

TEST(Marking, LeavesWhatWasAskedFor) {
  std::vector<double> indicator;
  for (int i = 1; i <= 1000; ++i) indicator.push_back(1.0 / (i * i));
  for (const double reduction : {1.5, 3.0, 8.0}) {
    const std::vector<std::uint8_t> found = levels(indicator, reduction);
    double before = 0, after = 0;
    for (std::size_t t = 0; t < indicator.size(); ++t) {
      before += indicator[t];
      after += indicator[t] / static_cast<double>(1U << found[t]);
    }
    EXPECT_NEAR(before / after, reduction, 0.3 * reduction);
  }
}

TEST(Marking, BisectsTheLargestHoweverLittleIsAskedFor) {
  // Doerfler's half: without it nothing would be bisected here.
  EXPECT_THAT(levels(std::vector<double>{3, 2, 1, 1}, 1.0001), ElementsAre(1, 1, 0, 0));
}

TEST(Marking, TreatsImagesUnderASymmetryAlike) {
  const double rounded = 1 - 1e-13;
  EXPECT_THAT(levels(std::vector<double>{rounded, 1, 1, rounded}, 1.0001), Each(1));
}

TEST(Marking, OfNoErrorIsNothing) {
  EXPECT_THAT(levels(std::vector<double>{0, 0}, 4), Each(0));
  EXPECT_THAT(levels({}, 4), ::testing::IsEmpty());
}

TEST(Marking, ExpectsTheTrianglesThatBisectionGives) {
  EXPECT_EQ(expected_triangles(std::vector<std::uint8_t>{0, 1, 3}), 1 + 2 + 8);
}

}  // namespace
}  // namespace anticrack::estimate
