// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/retry.hpp"

#include <gtest/gtest.h>

namespace anticrack::client {
namespace {

using std::chrono::milliseconds;

Error busy(milliseconds delay) {
  Details details;
  details.retry_delay = delay;
  return Error(Code::resource_exhausted, "queue full", details);
}

TEST(LostConnection, IsWhatKilledServersLookLike) {
  EXPECT_TRUE(is_lost_connection(Error(Code::unavailable, "Socket closed")));
  EXPECT_TRUE(is_lost_connection(Error(Code::unknown, "Stream removed")));
  EXPECT_TRUE(is_lost_connection(Error(Code::internal, "Received RST_STREAM with error code 2")));
  EXPECT_FALSE(is_lost_connection(Error(Code::unknown, "a bug")));
  EXPECT_FALSE(is_lost_connection(Error(Code::internal, "a bug")));
  EXPECT_FALSE(is_lost_connection(Error(Code::not_found, "Stream removed")));
}

TEST(MayRetry, ARefusalOnlyWhereItNamesADelay) {
  EXPECT_TRUE(may_retry(busy(milliseconds(1))));
  EXPECT_FALSE(may_retry(busy(milliseconds(0))));
  EXPECT_FALSE(may_retry(Error(Code::invalid_argument, "bad")));
}

TEST(Backoff, DoublesUpToABoundWithJitterInTheUpperHalf) {
  const RetryPolicy policy{milliseconds(100), milliseconds(1000), milliseconds(60'000)};
  Backoff backoff(policy, 1);
  const Error lost(Code::unavailable, "gone");
  for (const int full : {100, 200, 400, 800, 1000, 1000}) {
    const auto delay = backoff.next(lost, milliseconds(0));
    ASSERT_TRUE(delay.has_value());
    EXPECT_GE(delay->count(), full / 2);
    EXPECT_LE(delay->count(), full);
  }
  backoff.reset();
  EXPECT_LE(backoff.next(lost, milliseconds(0))->count(), 100);
}

TEST(Backoff, WaitsAtLeastWhatTheServerAsks) {
  Backoff backoff(RetryPolicy{}, 1);
  EXPECT_EQ(backoff.next(busy(milliseconds(5000)), milliseconds(0)), milliseconds(5000));
}

TEST(Backoff, GivesUpWithItsPatienceOrWithoutHope) {
  const RetryPolicy policy{milliseconds(100), milliseconds(1000), milliseconds(500)};
  const Error lost(Code::unavailable, "gone");
  EXPECT_TRUE(Backoff(policy, 1).next(lost, milliseconds(300)).has_value());
  EXPECT_FALSE(Backoff(policy, 1).next(lost, milliseconds(500)).has_value());
  EXPECT_FALSE(Backoff(policy, 1).next(Error(Code::not_found, "no"), milliseconds(0)).has_value());
}

}  // namespace
}  // namespace anticrack::client
