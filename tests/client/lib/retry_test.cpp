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
  EXPECT_TRUE(is_lost_connection(Error(Code::cancelled, "CANCELLED")));
  Details stopped;
  stopped.reason = "CANCELLED";
  EXPECT_FALSE(is_lost_connection(Error(Code::cancelled, "stopped on request", stopped)));
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
    const auto delay = backoff.next(lost, milliseconds(0), policy.patience);
    ASSERT_TRUE(delay.has_value());
    EXPECT_GE(delay->count(), full / 2);
    EXPECT_LE(delay->count(), full);
  }
  backoff.reset();
  EXPECT_LE(backoff.next(lost, milliseconds(0), policy.patience)->count(), 100);
}

TEST(Backoff, WaitsAtLeastWhatTheServerAsks) {
  Backoff backoff(RetryPolicy{}, 1);
  EXPECT_EQ(backoff.next(busy(milliseconds(5000)), milliseconds(0), milliseconds(60'000)),
            milliseconds(5000));
}

TEST(Backoff, GivesUpWithItsPatienceOrWithoutHope) {
  const RetryPolicy policy{milliseconds(100), milliseconds(1000), milliseconds(500)};
  const Error lost(Code::unavailable, "gone");
  const auto next = [&](const Error& error, int failing) {
    return Backoff(policy, 1).next(error, milliseconds(failing), policy.patience);
  };
  EXPECT_TRUE(next(lost, 300).has_value());
  EXPECT_FALSE(next(lost, 500).has_value());
  EXPECT_FALSE(next(Error(Code::not_found, "no"), 0).has_value());
  EXPECT_FALSE(next(busy(milliseconds(501)), 0).has_value()) << "would come too late";
}

TEST(RetryText, SaysWhoIsGoneAndForHowLongItIsTried) {
  const Error lost(Code::unavailable, "gone");
  EXPECT_EQ(retry_text(lost, "here:1", milliseconds(300'000)),
            "server here:1 gone, trying again for up to 5 min");
  EXPECT_EQ(retry_text(lost, "here:1", milliseconds(1'500)),
            "server here:1 gone, trying again for up to 2 s");
  EXPECT_EQ(retry_text(busy(milliseconds(10)), "here:1", milliseconds(0)),
            "queue full; trying again");
}

}  // namespace
}  // namespace anticrack::client
