// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/jobs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace anticrack::client {
namespace {

TEST(Uuid, IsVersionFour) {
  EXPECT_THAT(make_uuid(), ::testing::MatchesRegex("[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-"
                                                   "[89ab][0-9a-f]{3}-[0-9a-f]{12}"));
}

TEST(Uuid, IsNewEveryTime) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    seen.insert(make_uuid());
  }
  EXPECT_EQ(seen.size(), 1000U);
}

}  // namespace
}  // namespace anticrack::client
