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

TEST_F(OperatorCacheBudget, HasAnEstimateThatIsAnUpperBound) {
  EXPECT_GE(estimate, measured);
}

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

TEST_F(OperatorCacheBudget, NeverEvictsWhatSomebodyHolds) {
  const Operator a = acquire(cache, "a");
  acquire(cache, "b");
  acquire(cache, "c");
  EXPECT_TRUE(cache.contains("a"));
  EXPECT_FALSE(cache.contains("b"));
  EXPECT_FALSE(cache.evict("a"));
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
  EXPECT_FALSE(cache.evict("a"));
  if (2 * estimate > measured + estimate) {
    EXPECT_TRUE(throws([&] { acquire(cache, "b"); }, Reason::busy));
  }
  factorise.open();
  first.get();
  EXPECT_EQ(cache.metrics().bytes, measured);
}

TEST_F(OperatorCacheBudget, EvictsOnDemand) {
  acquire(cache, "a");
  EXPECT_TRUE(cache.evict("a"));
  EXPECT_FALSE(cache.contains("a"));
  EXPECT_FALSE(cache.evict("a"));
  EXPECT_EQ(cache.metrics().bytes, 0U);
  EXPECT_EQ(cache.metrics().evictions, 1U);
  acquire(cache, "a");
  EXPECT_EQ(cache.metrics().factorizations, 2U);
}

}  // namespace
}  // namespace anticrack::operators
