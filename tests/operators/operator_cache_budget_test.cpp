// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <future>

#include "operators/cache_support.hpp"
#include "support/errors.hpp"
#include "support/eventually.hpp"

namespace anticrack::operators {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::eventually;
using anticrack::testing::throws;
using errors::Reason;
using Operator = std::shared_ptr<const MeshOperator>;
using Eviction = OperatorCache::Eviction;

class OperatorCacheBudget : public ::testing::Test {
 protected:
  Operator acquire(OperatorCache& from, const std::string& key) {
    return from.acquire(key, mesh, {});
  }

  std::shared_ptr<const mesh::Mesh> mesh = small_mesh();
  std::uint64_t estimate = estimate_bytes(*mesh);
  std::uint64_t measured = MeshOperator::factorise(mesh, 1, {})->bytes();
  GatedFactorise factorise;
  /// Room for two of them, and for the estimate of a third only once one of them is gone.
  OperatorCache cache{measured + estimate, std::ref(factorise)};
};

TEST_F(OperatorCacheBudget, HasAnEstimateThatIsAnUpperBound) { EXPECT_GE(estimate, measured); }

TEST_F(OperatorCacheBudget, EvictsTheLeastRecentlyUsed) {
  acquire(cache, "a");
  acquire(cache, "b");
  EXPECT_EQ(cache.metrics().bytes, 2 * measured);
  acquire(cache, "a");
  acquire(cache, "c");
  EXPECT_TRUE(cache.contains("a"));
  EXPECT_FALSE(cache.contains("b"));
  EXPECT_TRUE(cache.contains("c"));
  EXPECT_EQ(cache.metrics().evictions, 1U);
  EXPECT_EQ(cache.metrics().bytes, 2 * measured);
}

TEST_F(OperatorCacheBudget, EvictsAsManyAsNeededAndNoMore) {
  const auto large = small_mesh(32);
  OperatorCache several(estimate_bytes(*large) + measured, std::ref(factorise));
  for (const char* key : {"a", "b", "c", "a"}) acquire(several, key);
  several.acquire("large", large, {});
  EXPECT_TRUE(several.contains("a") && several.contains("large"));
  EXPECT_FALSE(several.contains("b") || several.contains("c"));
  EXPECT_EQ(several.metrics().evictions, 2U);
}

TEST_F(OperatorCacheBudget, EvictsNothingWhereItWouldNotHelp) {
  const auto large = small_mesh(32);
  OperatorCache several(estimate_bytes(*large), std::ref(factorise));
  const Operator a = acquire(several, "a");
  acquire(several, "b");
  EXPECT_TRUE(throws([&] { several.acquire("large", large, {}); }, Reason::busy));
  EXPECT_TRUE(several.contains("b"));
  EXPECT_EQ(several.metrics().evictions, 0U);
}

TEST_F(OperatorCacheBudget, NeverEvictsWhatSomebodyHolds) {
  const Operator a = acquire(cache, "a");
  acquire(cache, "b");
  acquire(cache, "c");
  EXPECT_TRUE(cache.contains("a"));
  EXPECT_FALSE(cache.contains("b"));
  EXPECT_EQ(cache.evict("a"), Eviction::in_use);
  EXPECT_TRUE(cache.contains("a"));
}

TEST_F(OperatorCacheBudget, IsBusyWhenAllOfItIsHeldAndRecovers) {
  Operator a = acquire(cache, "a");
  const Operator b = acquire(cache, "b");
  const auto error = error_of([&] { acquire(cache, "c"); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::busy);
  EXPECT_GT(error->retry_delay().count(), 0);
  EXPECT_TRUE(cache.contains("a") && cache.contains("b"));
  a.reset();
  EXPECT_NE(acquire(cache, "c"), nullptr);
  EXPECT_FALSE(cache.contains("a"));
}

TEST_F(OperatorCacheBudget, RefusesForGoodWhatCouldNeverFit) {
  OperatorCache tiny(estimate - 1, std::ref(factorise));
  EXPECT_TRUE(throws([&] { acquire(tiny, "a"); }, Reason::limit_exceeded));
  OperatorCache enough(estimate, std::ref(factorise));
  EXPECT_NE(acquire(enough, "a"), nullptr);
}

TEST_F(OperatorCacheBudget, ReservesTheEstimateWhileFactorising) {
  factorise.open(false);
  auto first = std::async(std::launch::async, [&] { return acquire(cache, "a"); });
  ASSERT_TRUE(eventually([&] { return cache.metrics().factorizations == 1; }));
  EXPECT_EQ(cache.metrics().bytes, estimate);
  EXPECT_EQ(cache.metrics().pinned, estimate);
  EXPECT_EQ(cache.evict("a"), Eviction::in_use);
  EXPECT_FALSE(cache.pin("a"));
  if (2 * estimate > measured + estimate) {
    EXPECT_TRUE(throws([&] { acquire(cache, "b"); }, Reason::busy));
  }
  factorise.open();
  first.get();
  EXPECT_EQ(cache.metrics().bytes, measured);
}

TEST_F(OperatorCacheBudget, EvictsOnDemand) {
  acquire(cache, "a");
  EXPECT_EQ(cache.evict("a"), Eviction::done);
  EXPECT_FALSE(cache.contains("a"));
  EXPECT_EQ(cache.evict("a"), Eviction::not_there);
  EXPECT_EQ(cache.metrics().bytes, 0U);
  EXPECT_EQ(cache.metrics().evictions, 1U);
  acquire(cache, "a");
  EXPECT_EQ(cache.metrics().factorizations, 2U);
}

TEST_F(OperatorCacheBudget, KeepsWhatIsPinnedUntilItIsEvicted) {
  EXPECT_FALSE(cache.pin("a"));
  acquire(cache, "a");
  EXPECT_FALSE(cache.pinned("a"));
  EXPECT_TRUE(cache.pin("a"));
  EXPECT_TRUE(cache.pinned("a"));
  EXPECT_EQ(cache.metrics().pinned, measured);
  acquire(cache, "b");
  acquire(cache, "c");  // "a" was used before "b"
  EXPECT_TRUE(cache.contains("a"));
  EXPECT_FALSE(cache.contains("b"));
  EXPECT_TRUE(cache.pin("c"));
  EXPECT_TRUE(throws([&] { acquire(cache, "b"); }, Reason::busy));
  EXPECT_EQ(cache.evict("a"), Eviction::done);
  EXPECT_FALSE(cache.pinned("a"));
  EXPECT_NE(acquire(cache, "b"), nullptr);
  acquire(cache, "a");
  EXPECT_FALSE(cache.pinned("a"));  // the pin went with the entry
}

TEST_F(OperatorCacheBudget, CountsWhatItHolds) {
  acquire(cache, "a");
  const Operator held = acquire(cache, "b");
  const CacheMetrics metrics = cache.metrics();
  EXPECT_EQ(metrics.budget, measured + estimate);
  EXPECT_EQ(metrics.entries, 2);
  EXPECT_EQ(metrics.bytes, 2 * measured);
  EXPECT_EQ(metrics.pinned, measured);
}

TEST_F(OperatorCacheBudget, FreesWhatHasToGoBeforeItFactorises) {
  std::weak_ptr<const MeshOperator> gone;
  std::atomic<bool> freed{false};
  OperatorCache small(estimate, [&](auto cut, std::stop_token stop) {
    freed = gone.expired();
    return MeshOperator::factorise(std::move(cut), 1, stop);
  });
  gone = acquire(small, "a");
  ASSERT_FALSE(gone.expired());
  acquire(small, "b");
  EXPECT_TRUE(freed);
}

TEST_F(OperatorCacheBudget, TellsOfEachFactorisation) {
  std::atomic<int> told{0};
  std::atomic<bool> fail{false};
  OperatorCache listened(
      std::uint64_t{1} << 30,
      [&](auto cut, std::stop_token stop) {
        if (fail) {
          throw errors::Error(Reason::numerical, "floats");
        }
        return MeshOperator::factorise(std::move(cut), 1, stop);
      },
      [&](std::chrono::duration<double> seconds) { told += seconds.count() > 0 ? 1 : 100; });
  acquire(listened, "a");
  acquire(listened, "a");
  EXPECT_EQ(told, 1);
  acquire(listened, "b");
  EXPECT_EQ(told, 2);
  fail = true;
  EXPECT_TRUE(throws([&] { acquire(listened, "c"); }, Reason::numerical));
  EXPECT_EQ(told, 2);
}

/// The mesh that is asked for has a small estimate; what "comes out" is the operator of a larger
/// one: as if the estimate were wrong.
TEST_F(OperatorCacheBudget, EvictsOthersWhereAnEstimateWasTooSmall) {
  const auto larger = MeshOperator::factorise(small_mesh(32), 1, {});
  const std::uint64_t too_much = larger->bytes();
  ASSERT_GT(too_much, 2 * estimate);
  std::atomic<bool> lie{false};
  const auto surprise = [&](auto cut, std::stop_token stop) {
    return MeshOperator::factorise(lie ? small_mesh(32) : cut, 1, stop);
  };
  OperatorCache enough(too_much + measured, surprise);
  acquire(enough, "a");
  acquire(enough, "b");
  lie = true;
  Operator wrong = acquire(enough, "c");
  EXPECT_EQ(enough.metrics().bytes, too_much + measured);
  EXPECT_FALSE(enough.contains("a"));
  EXPECT_TRUE(enough.contains("b"));

  lie = false;
  OperatorCache tight(2 * estimate, surprise);
  acquire(tight, "a");
  lie = true;
  wrong = acquire(tight, "c");
  EXPECT_FALSE(tight.contains("a"));
  EXPECT_EQ(tight.metrics().bytes, too_much);  // over the budget, and it says so
  lie = false;
  EXPECT_TRUE(throws([&] { acquire(tight, "a"); }, Reason::busy));
  wrong.reset();
  EXPECT_NE(acquire(tight, "a"), nullptr);
  EXPECT_FALSE(tight.contains("c"));
  EXPECT_EQ(tight.metrics().bytes, measured);
}

}  // namespace
}  // namespace anticrack::operators
