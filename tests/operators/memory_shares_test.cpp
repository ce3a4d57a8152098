// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/memory_shares.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

#include "operators/cache_support.hpp"
#include "support/errors.hpp"

namespace anticrack::operators {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Optional;
using ::testing::UnorderedElementsAre;
using Keys = std::vector<std::string>;

class MemoryShares : public ::testing::Test {
 protected:
  Resident& add(const std::string& key, std::uint64_t bytes, const std::set<std::string>& owners) {
    _keys.push_back(key);
    _owners.push_back(owners);
    residents.push_back({&_keys.back(), &_owners.back(), bytes, ++_clock});
    return residents.back();
  }
  std::optional<Keys> victims(const std::string& owner, std::uint64_t wanted) {
    return choose_victims(residents, owner, wanted, 100);
  }

  std::vector<Resident> residents;

 private:
  std::deque<std::string> _keys;
  std::deque<std::set<std::string>> _owners;
  std::uint64_t _clock = 0;
};

TEST_F(MemoryShares, NothingGoesWhileThereIsRoom) {
  add("a", 50, {"x"});
  EXPECT_THAT(victims("y", 50), Optional(IsEmpty()));
}

TEST_F(MemoryShares, WhoHasMostGivesFirst) {
  add("small", 5, {"modest"});  // the least recently used
  add("g1", 40, {"greedy"});
  add("g2", 40, {"greedy"});
  EXPECT_THAT(victims("greedy", 30), Optional(ElementsAre("g1")));
  EXPECT_THAT(victims("modest", 30), Optional(ElementsAre("g1")));
  EXPECT_THAT(victims("newcomer", 30), Optional(ElementsAre("g1")));
}

TEST_F(MemoryShares, WhoWantsMostCountsWithWhatTheyWant) {
  add("m1", 30, {"modest"});
  add("m2", 25, {"modest"});
  add("g", 40, {"greedy"});
  EXPECT_THAT(victims("greedy", 45), Optional(ElementsAre("g")));
}

TEST_F(MemoryShares, AModestOwnerGivesNothingToOneWhoOnlyHasToWait) {
  add("small", 5, {"modest"});
  add("g1", 60, {"greedy"}).in_use = true;
  add("g2", 30, {"greedy"}).in_use = true;
  EXPECT_EQ(victims("greedy", 10), std::nullopt);
  EXPECT_EQ(victims("greedy", 95), std::nullopt);
}

TEST_F(MemoryShares, AModestOwnerGivesWhereThereWouldNeverBeRoom) {
  add("small", 5, {"modest"});
  add("tiny", 1, {"modest"});
  add("g1", 60, {"greedy"});
  EXPECT_THAT(victims("greedy", 97), Optional(UnorderedElementsAre("g1", "small")));
}

TEST_F(MemoryShares, WhatIsKeptIsNothingToWaitFor) {
  add("small", 5, {"modest"});
  add("kept", 50, {"greedy"}).kept = true;
  add("g1", 40, {"greedy"});
  EXPECT_THAT(victims("greedy", 48), Optional(UnorderedElementsAre("g1", "small")));
}

TEST_F(MemoryShares, EqualOwnersKeepWhatTheyHave) {
  add("a", 40, {"x"}).in_use = true;
  add("b", 50, {"y"});
  EXPECT_EQ(victims("x", 20), std::nullopt) << "x would have 60";
  residents[0].bytes = 25;
  EXPECT_THAT(victims("x", 20), Optional(IsEmpty()));
  add("c", 10, {"y"});
  EXPECT_THAT(victims("x", 20), Optional(ElementsAre("b"))) << "y has 60, and x would have 45";
}

TEST_F(MemoryShares, StaleOnesGoFirstWhoeverHasThem) {
  add("g1", 60, {"greedy"});
  add("old", 20, {"modest"}).stale = true;
  add("older", 20, {"absent"}).stale = true;
  residents[2].last_use = 0;
  EXPECT_THAT(victims("greedy", 15), Optional(ElementsAre("older")));
  EXPECT_THAT(victims("greedy", 35), Optional(UnorderedElementsAre("old", "older")));
}

TEST_F(MemoryShares, SharedOnesStayAsLongAsForWhoHasLeast) {
  add("shared", 10, {"greedy", "modest"});
  add("g1", 45, {"greedy"});
  add("g2", 45, {"greedy"});
  EXPECT_THAT(victims("greedy", 50), Optional(UnorderedElementsAre("g1", "g2")));
}

TEST_F(MemoryShares, SharedOnesCountForEachWithAPart) {
  add("both", 60, {"x", "y"});
  add("x1", 25, {"x"});
  add("z1", 10, {"z"});
  EXPECT_THAT(victims("z", 10), Optional(ElementsAre("x1"))) << "x has 55, y 30, z would have 20";
}

TEST_F(MemoryShares, SmallOnesStayThatLargeOnesMakeUnnecessary) {
  add("small", 5, {"x"});
  add("large", 80, {"x"});
  add("last", 10, {"x"});
  EXPECT_THAT(victims("x", 50), Optional(ElementsAre("large")));
}

TEST_F(MemoryShares, WithoutNamesTheLeastRecentlyUsedGoFirst) {
  for (const char* key : {"a", "b", "c"}) add(key, 30, {""});
  EXPECT_THAT(victims("", 30), Optional(ElementsAre("a")));
  EXPECT_EQ(victims("", 101), std::nullopt);
}

TEST_F(MemoryShares, LeaveRoomForNewcomersInWhatIsPinned) {
  add("g1", 30, {"greedy"}).in_use = true;
  EXPECT_TRUE(pinned_share(residents, "greedy", 20, 100).enough);
  EXPECT_FALSE(pinned_share(residents, "greedy", 21, 100).enough) << "one user has half at most";
  EXPECT_TRUE(pinned_share(residents, "newcomer", 70, 100).enough);
  EXPECT_FALSE(pinned_share(residents, "newcomer", 71, 100).enough);
  EXPECT_TRUE(pinned_share({}, "greedy", 100, 100).enough) << "alone it may have everything";
  residents[0].kept = true;
  EXPECT_TRUE(pinned_share(residents, "greedy", 70, 100).enough) << "kept for ever: not counted";
  const std::set<std::string> nobody{""};
  residents[0].owners = &nobody;
  residents[0].kept = false;
  EXPECT_TRUE(pinned_share(residents, "", 70, 100).enough);
}

/// The cache itself, over real factors: one modest mesh among a hundred of a greedy owner.
TEST(OperatorCacheOwners, KeepTheirMeshesHoweverManyAnotherMakes) {
  const auto small = small_mesh(8), large = small_mesh(24);
  GatedFactorise factorise;
  OperatorCache cache(3 * estimate_bytes(*large), std::ref(factorise));
  cache.acquire("modest", small, {}, "modest");
  for (int i = 0; i < 100; ++i) {
    cache.acquire("greedy-" + std::to_string(i), large, {}, "greedy");
    ASSERT_TRUE(cache.contains("modest")) << i;
  }
  EXPECT_GE(cache.metrics().evictions, 90U);
  EXPECT_LE(cache.metrics().bytes, cache.metrics().budget);
}

TEST(OperatorCacheOwners, ThatHoldAllTheyMayWaitAndOthersDoNot) {
  using anticrack::testing::throws;
  const auto small = small_mesh(8), large = small_mesh(24);
  const std::uint64_t bytes = MeshOperator::factorise(large, 1, {})->bytes();
  GatedFactorise factorise;
  OperatorCache cache(2 * bytes + estimate_bytes(*large), std::ref(factorise));
  std::vector<std::shared_ptr<const MeshOperator>> held;
  held.push_back(cache.acquire("g0", large, {}, "greedy"));
  EXPECT_TRUE(throws([&] { cache.acquire("g1", large, {}, "greedy"); }, errors::Reason::busy));
  held.push_back(cache.acquire("m", small, {}, "modest"));
  held.clear();
  EXPECT_TRUE(cache.acquire("g1", large, {}, "greedy"));
  EXPECT_TRUE(cache.contains("m"));
}

TEST(OperatorCacheOwners, ThatDoNotComeBackGiveTheirMemoryUp) {
  const auto mesh = small_mesh(24);
  for (const bool stale : {false, true}) {
    GatedFactorise factorise;
    const std::chrono::milliseconds after =
        stale ? std::chrono::milliseconds(0) : default_stale_after;
    OperatorCache cache(2 * estimate_bytes(*mesh), std::ref(factorise), {}, after);
    cache.acquire("absent", mesh, {}, "absent");
    for (int i = 0; i < 10; ++i) cache.acquire("greedy-" + std::to_string(i), mesh, {}, "greedy");
    EXPECT_EQ(cache.contains("absent"), !stale);
  }
}

TEST(OperatorCacheOwners, OfASharedMeshBothKeepIt) {
  const auto small = small_mesh(8), large = small_mesh(24);
  GatedFactorise factorise;
  OperatorCache cache(2 * estimate_bytes(*large), std::ref(factorise));
  cache.acquire("shared", small, {}, "greedy");
  EXPECT_TRUE(cache.find("shared", "modest"));
  for (int i = 0; i < 20; ++i) {
    cache.acquire("greedy-" + std::to_string(i), large, {}, "greedy");
    ASSERT_TRUE(cache.contains("shared")) << i;
  }
}

}  // namespace
}  // namespace anticrack::operators
