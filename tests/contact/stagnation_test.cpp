// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/uzawa_block.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace anticrack::contact {
namespace {

/// Iterations until recognised, 0 when never within `limit`.
template <class Criterion, class Turned>
int recognised(Criterion criterion, Turned turned, int limit = 100000) {
  StagnationMonitor monitor;
  for (int k = 1; k <= limit; ++k) {
    if (monitor.add(criterion(k), turned(k))) {
      return k;
    }
  }
  return 0;
}

bool always(int) { return true; }
bool never(int) { return false; }

TEST(StagnationMonitor, RecognisesABoundedOscillationWithinTwoHundredIterations) {
  const auto falls_then_stays = [](int k) { return std::max(2.7, 1e3 * std::pow(0.7, k)); };
  const int k = recognised(falls_then_stays, always);
  EXPECT_GT(k, 0);
  EXPECT_LE(k, 200);
}

TEST(StagnationMonitor, RecognisesAGrowingOscillation) {
  EXPECT_GT(recognised([](int k) { return 1e-9 * std::pow(1.001, k); }, always), 0);
}

TEST(StagnationMonitor, LeavesAloneAnOscillationThatDiesOutSlowly) {
  // The amplitude falls by 1e-4 an iteration, the criterion by twice that.
  EXPECT_EQ(recognised([](int k) { return std::pow(0.9998, k); }, always), 0);
}

TEST(StagnationMonitor, LeavesAloneASlowApproachFromOneSide) {
  EXPECT_EQ(recognised([](int k) { return 1e-6 * (1 - 1e-9 * k); }, never), 0);
}

TEST(StagnationMonitor, LeavesAloneARiseWhileContactChanges) {
  // Rises for 60 iterations, then converges.
  const auto criterion = [](int k) { return k < 60 ? 1e-3 * std::pow(1.05, k) : std::pow(0.9, k); };
  EXPECT_EQ(recognised(criterion, always), 0);
}

TEST(StagnationMonitor, LeavesAloneTheNoiseOfRounding) {
  EXPECT_EQ(recognised([](int) { return 1e-31; }, always), 0);
}

}  // namespace
}  // namespace anticrack::contact
