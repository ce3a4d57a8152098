// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/retention.hpp"

#include <gtest/gtest.h>

namespace anticrack::jobs {
namespace {

TEST(Retention, DropsTheOldestOverTheCount) {
  EXPECT_EQ(jobs_to_drop({}, 2, 100), 0U);
  EXPECT_EQ(jobs_to_drop({1, 1}, 2, 100), 0U);
  EXPECT_EQ(jobs_to_drop({1, 1, 1, 1}, 2, 100), 2U);
}

TEST(Retention, DropsTheOldestOverTheBytes) {
  EXPECT_EQ(jobs_to_drop({60, 30, 10}, 9, 100), 0U);
  EXPECT_EQ(jobs_to_drop({60, 30, 11}, 9, 100), 1U);
  EXPECT_EQ(jobs_to_drop({10, 10, 95}, 9, 100), 2U);
}

TEST(Retention, AlwaysKeepsTheNewest) {
  EXPECT_EQ(jobs_to_drop({1, 1, 500}, 9, 100), 2U);
  EXPECT_EQ(jobs_to_drop({1, 1}, 0, 100), 1U);
}

}  // namespace
}  // namespace anticrack::jobs
