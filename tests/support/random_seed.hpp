// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where random tests begin: always at the same seed, so that no change is refused by luck;
// elsewhere with --gtest_random_seed=N or GTEST_RANDOM_SEED=N.
#pragma once

#include <gtest/gtest.h>

namespace anticrack::testing {

inline unsigned random_seed() {
  const auto given = static_cast<unsigned>(::testing::GTEST_FLAG(random_seed));
  return given > 0 ? given : 1;
}

}  // namespace anticrack::testing
