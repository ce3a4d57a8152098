// SPDX-License-Identifier: GPL-3.0-or-later
//
// Single flight: who waits for whom, and whose stop ends what.
#include <gtest/gtest.h>

#include <future>
#include <vector>

#include "operators/cache_support.hpp"
#include "support/errors.hpp"
#include "support/eventually.hpp"

namespace anticrack::operators {
namespace {

using anticrack::testing::eventually;
using anticrack::testing::throws;
using errors::Error;
using errors::Reason;
using Operator = std::shared_ptr<const MeshOperator>;

class OperatorCacheFlight : public ::testing::Test {
 protected:
  std::future<Operator> acquire(std::stop_token stop = {}, const std::string& key = "mesh") {
    return std::async(std::launch::async,
                      [this, stop, key] { return cache.acquire(key, mesh, stop); });
  }
  bool joined(std::uint64_t count) {
    return eventually([&] { return cache.metrics().joins == count; });
  }
  bool factorising(std::uint64_t count) {
    return eventually([&] { return cache.metrics().factorizations == count; });
  }

  std::shared_ptr<const mesh::Mesh> mesh = small_mesh();
  GatedFactorise factorise;
  OperatorCache cache{std::uint64_t{1} << 30, std::ref(factorise)};
};

TEST_F(OperatorCacheFlight, FactorisesOnceAndThenHits) {
  const Operator first = cache.acquire("mesh", mesh, {});
  EXPECT_EQ(&first->mesh(), mesh.get());
  EXPECT_EQ(cache.acquire("mesh", mesh, {}), first);
  EXPECT_EQ(cache.find("mesh"), first);
  const CacheMetrics metrics = cache.metrics();
  EXPECT_EQ(metrics.factorizations, 1U);
  EXPECT_EQ(metrics.hits, 2U);
  EXPECT_EQ(metrics.joins, 0U);
  EXPECT_EQ(metrics.bytes, first->bytes());
  EXPECT_TRUE(cache.contains("mesh"));
  EXPECT_FALSE(cache.contains("other"));
  EXPECT_EQ(cache.find("other"), nullptr);
}

TEST_F(OperatorCacheFlight, GivesAllWhoComeMeanwhileTheSameOperator) {
  factorise.open(false);
  std::vector<std::future<Operator>> callers;
  for (int i = 0; i < 8; ++i) {
    callers.push_back(acquire());
  }
  ASSERT_TRUE(joined(7));
  EXPECT_FALSE(cache.contains("mesh"));
  EXPECT_EQ(cache.find("mesh"), nullptr);
  factorise.open();
  const Operator first = callers.front().get();
  for (std::size_t i = 1; i < callers.size(); ++i) {
    EXPECT_EQ(callers[i].get(), first);
  }
  EXPECT_EQ(cache.metrics().factorizations, 1U);
}

TEST_F(OperatorCacheFlight, FactorisesDifferentMeshesAtOnce) {
  factorise.open(false);
  auto a = acquire({}, "a");
  auto b = acquire({}, "b");
  EXPECT_TRUE(eventually([&] { return factorise.most_at_once == 2; }));
  factorise.open();
  EXPECT_NE(a.get(), b.get());
}

TEST_F(OperatorCacheFlight, EndsOnlyTheWaitOfAJoinerThatStops) {
  factorise.open(false);
  auto leader = acquire();
  ASSERT_TRUE(factorising(1));
  std::stop_source stop;
  auto joiner = acquire(stop.get_token());
  ASSERT_TRUE(joined(1));
  stop.request_stop();
  EXPECT_TRUE(throws([&] { joiner.get(); }, Reason::cancelled));
  factorise.open();
  EXPECT_NE(leader.get(), nullptr);
  EXPECT_EQ(factorise.stops_seen, 0);
}

TEST_F(OperatorCacheFlight, GoesOnForTheOthersWhenTheFirstStops) {
  factorise.open(false);
  std::stop_source stop;
  auto leader = acquire(stop.get_token());
  ASSERT_TRUE(factorising(1));
  auto joiner = acquire();
  ASSERT_TRUE(joined(1));
  stop.request_stop();
  factorise.open();
  EXPECT_TRUE(throws([&] { leader.get(); }, Reason::cancelled));
  EXPECT_NE(joiner.get(), nullptr);
  EXPECT_EQ(factorise.stops_seen, 0);
  EXPECT_EQ(cache.metrics().factorizations, 1U);
}

TEST_F(OperatorCacheFlight, StopsWhenNobodyWaitsAnyMore) {
  factorise.open(false);
  std::stop_source stop;
  auto leader = acquire(stop.get_token());
  ASSERT_TRUE(factorising(1));
  auto joiner = acquire(stop.get_token());
  ASSERT_TRUE(joined(1));
  stop.request_stop();
  EXPECT_TRUE(throws([&] { leader.get(); }, Reason::cancelled));
  EXPECT_TRUE(throws([&] { joiner.get(); }, Reason::cancelled));
  EXPECT_TRUE(eventually([&] { return factorise.stops_seen == 1; }));
  EXPECT_TRUE(eventually([&] { return cache.metrics().bytes == 0; }));
  factorise.open();
  EXPECT_NE(cache.acquire("mesh", mesh, {}), nullptr);
  EXPECT_EQ(cache.metrics().factorizations, 2U);
}

TEST_F(OperatorCacheFlight, DoesNotJoinWhatIsBeingStopped) {
  factorise.open(false);
  factorise.obeys_stop = false;  // it notices late
  std::stop_source stop;
  auto first = acquire(stop.get_token());
  ASSERT_TRUE(factorising(1));
  stop.request_stop();

  std::stop_source impatient;
  auto gives_up = acquire(impatient.get_token());
  auto second = acquire();
  impatient.request_stop();
  EXPECT_TRUE(throws([&] { gives_up.get(); }, Reason::cancelled));
  factorise.open();
  EXPECT_TRUE(throws([&] { first.get(); }, Reason::cancelled));
  EXPECT_NE(second.get(), nullptr);
  EXPECT_EQ(cache.metrics().factorizations, 2U);
  EXPECT_EQ(cache.metrics().joins, 0U);
  EXPECT_EQ(factorise.most_at_once, 1);
}

TEST_F(OperatorCacheFlight, StartsNothingForACallerThatHasStopped) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(throws([&] { cache.acquire("mesh", mesh, stop.get_token()); }, Reason::cancelled));
  EXPECT_EQ(cache.metrics().factorizations, 0U);
}

TEST(OperatorCacheError, ReachesAllWhoWaitAndIsNotKept) {
  std::atomic<bool> fail{true};
  std::promise<void> all_wait;
  const std::shared_future<void> go = all_wait.get_future().share();
  OperatorCache cache(std::uint64_t{1} << 30, [&](auto mesh, std::stop_token stop) {
    go.wait();
    if (fail) {
      throw Error(Reason::numerical, "subdomain \"upper\" floats").with("subdomain", "upper");
    }
    return MeshOperator::factorise(mesh, 1, stop);
  });
  const auto mesh = small_mesh();
  std::vector<std::future<Operator>> callers;
  for (int i = 0; i < 4; ++i) {
    callers.push_back(
        std::async(std::launch::async, [&] { return cache.acquire("mesh", mesh, {}); }));
  }
  ASSERT_TRUE(eventually([&] { return cache.metrics().joins == 3; }));
  all_wait.set_value();
  for (auto& caller : callers) {
    const auto error = anticrack::testing::error_of([&] { caller.get(); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->reason(), Reason::numerical);
    EXPECT_EQ(error->metadata().at("subdomain"), "upper");
  }
  EXPECT_EQ(cache.metrics().bytes, 0U);
  fail = false;
  EXPECT_NE(cache.acquire("mesh", mesh, {}), nullptr);
}

TEST(OperatorCacheError, OfAnyOtherKindIsTold) {
  const auto mesh = small_mesh();
  OperatorCache broken(std::uint64_t{1} << 30,
                       [](auto, std::stop_token) -> Operator { throw std::runtime_error("odd"); });
  EXPECT_TRUE(throws([&] { broken.acquire("mesh", mesh, {}); }, Reason::internal));
}

TEST(OperatorCacheError, OfTooLittleMemoryGoesAwayWithWhatIsInMemory) {
  const auto mesh = small_mesh();
  bool there_is_memory = true;
  OperatorCache cache(std::uint64_t{1} << 30, [&](auto made_of, std::stop_token stop) {
    if (!there_is_memory) throw std::bad_alloc();
    return MeshOperator::factorise(std::move(made_of), 1, stop);
  });
  Operator held = cache.acquire("held", mesh, {});
  cache.acquire("unused", mesh, {});
  there_is_memory = false;
  EXPECT_TRUE(throws([&] { cache.acquire("mesh", mesh, {}); }, Reason::busy));
  EXPECT_FALSE(cache.contains("unused"));
  EXPECT_TRUE(throws([&] { cache.acquire("mesh", mesh, {}); }, Reason::busy)) << "a job may end";
  held.reset();
  EXPECT_TRUE(throws([&] { cache.acquire("mesh", mesh, {}); }, Reason::busy));
  EXPECT_TRUE(throws([&] { cache.acquire("mesh", mesh, {}); }, Reason::limit_exceeded));
  there_is_memory = true;
  EXPECT_TRUE(cache.acquire("mesh", mesh, {}));
}

TEST(OperatorCacheEnd, StopsAFactorisationThatWasLeft) {
  GatedFactorise factorise;
  factorise.open(false);
  {
    OperatorCache cache(std::uint64_t{1} << 30, std::ref(factorise));
    std::stop_source stop;
    auto caller = std::async(std::launch::async,
                             [&] { return cache.acquire("mesh", small_mesh(), stop.get_token()); });
    ASSERT_TRUE(eventually([&] { return cache.metrics().factorizations == 1; }));
    stop.request_stop();
    EXPECT_TRUE(throws([&] { caller.get(); }, Reason::cancelled));
  }
  EXPECT_EQ(factorise.stops_seen, 1);
}

}  // namespace
}  // namespace anticrack::operators
