// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/retention.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace anticrack::jobs {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using namespace std::chrono_literals;

const records::Clock::time_point today{1'000h};

/// Jobs "0", "1", ... that ended one minute after another, the last one today.
Retention with(const RetentionLimits& limits, const std::vector<std::uint64_t>& bytes) {
  Retention retention(limits);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto age = std::chrono::minutes(static_cast<int>(bytes.size() - 1 - i));
    retention.add({std::to_string(i), today - age, bytes[i]});
  }
  return retention;
}

TEST(Retention, ErasesTheOldestOverTheCount) {
  EXPECT_THAT(with({2, 0ms, 100}, {}).due(today).erase, IsEmpty());
  EXPECT_THAT(with({2, 0ms, 100}, {1, 1}).due(today).erase, IsEmpty());
  const Expiry expiry = with({2, 0ms, 100}, {1, 1, 0, 1}).due(today);
  EXPECT_THAT(expiry.erase, ElementsAre("0", "1"));
  EXPECT_THAT(expiry.expire, IsEmpty());
  EXPECT_THAT(with({0, 0ms, 100}, {1, 1}).due(today).erase, ElementsAre("0"));
}

TEST(Retention, ExpiresTheOldestOverTheBytes) {
  EXPECT_THAT(with({9, 0ms, 100}, {60, 30, 10}).due(today).expire, IsEmpty());
  EXPECT_THAT(with({9, 0ms, 100}, {60, 30, 11}).due(today).expire, ElementsAre("0"));
  EXPECT_THAT(with({9, 0ms, 100}, {10, 0, 10, 95}).due(today).expire, ElementsAre("0", "2"));
  EXPECT_THAT(with({2, 0ms, 100}, {60, 90, 10}).due(today).expire, IsEmpty());  // "0" is erased
}

TEST(Retention, KeepsTheNewestResultWhateverItsSize) {
  EXPECT_THAT(with({9, 0ms, 100}, {1, 1, 500}).due(today).expire, ElementsAre("0", "1"));
  EXPECT_THAT(with({9, 0ms, 100}, {1, 500, 0}).due(today).expire, ElementsAre("0"));
}

TEST(Retention, ExpiresByAge) {
  EXPECT_THAT(with({9, 2min, 100}, {1, 1, 0, 1, 1}).due(today).expire, ElementsAre("0", "1"));
  EXPECT_THAT(with({9, 2min, 100}, {1}).due(today + 2min).expire, ElementsAre("0"));
}

TEST(Retention, TakesFromWhoHasMost) {
  Retention retention({4, 0ms, 100});
  retention.add({"modest", today - 9h, 30, "modest"});
  for (int i = 0; i < 5; ++i)
    retention.add({std::to_string(i), today - 1h + i * 1min, 1, "tiny ones"});
  Expiry expiry = retention.due(today);
  EXPECT_THAT(expiry.erase, ElementsAre("0", "1"));
  EXPECT_THAT(expiry.expire, IsEmpty());
  for (const char* id : {"0", "1", "2"}) retention.remove(id);
  retention.add({"large", today, 90, "large ones"});
  EXPECT_THAT(retention.due(today).expire, ElementsAre("modest"));  // the newest stays
  retention.add({"small", today + 1s, 1, "tiny ones"});
  retention.remove("3");
  EXPECT_THAT(retention.due(today).expire, ElementsAre("large"));
}

TEST(Retention, TakesTheOldestOfThoseWhoHaveAsMuch) {
  Retention retention({2, 0ms, 100});
  retention.add({"b", today - 2h, 50, "bob"});
  retention.add({"c", today - 1h, 50, "carol"});
  retention.add({"a", today, 60, "ada"});
  EXPECT_THAT(retention.due(today).erase, ElementsAre("b"));
  EXPECT_THAT(retention.due(today).expire, ElementsAre("c"));
}

TEST(Retention, ForgetsWhatIsGone) {
  Retention retention = with({2, 0ms, 100}, {60, 60, 1});
  retention.remove("0");
  EXPECT_THAT(retention.due(today).erase, IsEmpty());
  EXPECT_THAT(retention.due(today).expire, IsEmpty());
  retention.add({"late", today - 1h, 50});
  EXPECT_THAT(retention.due(today).erase, ElementsAre("late"));
  retention.remove("unknown");
  retention.remove("late");
  retention.add({"3", today, 60});
  retention.remove("2");
  EXPECT_THAT(retention.due(today).expire, ElementsAre("1"));
  retention.expired("1");
  EXPECT_THAT(retention.due(today).expire, IsEmpty());
}

}  // namespace
}  // namespace anticrack::jobs
