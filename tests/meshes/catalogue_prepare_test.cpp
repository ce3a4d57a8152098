// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <stop_token>
#include <vector>

#include "support/backend.hpp"
#include "support/errors.hpp"
#include "support/eventually.hpp"

namespace anticrack::meshes {
namespace {

using anticrack::testing::Backend;
using anticrack::testing::BackendOptions;
using anticrack::testing::eventually;
using anticrack::testing::throws;
using errors::Reason;
using records::MeshState;
using ::testing::ElementsAre;
using Phase = MeshNews::Phase;
using Operator = std::shared_ptr<const operators::MeshOperator>;

class Prepare : public ::testing::Test {
 protected:
  Operator prepare(const std::string& id, std::stop_token stop = {}) {
    return backend.prepare(id, stop);
  }

  Backend backend;
};

TEST_F(Prepare, SharesTheWorkWithTheBackgroundAndOthers) {
  const std::string id = backend.create();
  std::vector<std::future<Operator>> callers;
  for (int i = 0; i < 6; ++i) {
    callers.push_back(std::async(std::launch::async, [&] { return prepare(id); }));
  }
  const Operator first = callers[0].get();
  for (std::size_t i = 1; i < callers.size(); ++i) {
    EXPECT_EQ(callers[i].get(), first);
  }
  EXPECT_EQ(prepare(id), first);
  EXPECT_EQ(backend.catalogue.meshings(), 1U);
  EXPECT_EQ(backend.cache.metrics().factorizations, 1U);
  EXPECT_TRUE(backend.reaches(id, MeshState::ready));
}

TEST_F(Prepare, SaysEvictedWhenTheFactorsAreGoneAndMakesThemAgain) {
  const std::string id = backend.create();
  ASSERT_TRUE(backend.reaches(id, MeshState::ready));
  EXPECT_EQ(backend.catalogue.evict(id).state, MeshState::evicted);
  EXPECT_EQ(backend.state(id), MeshState::evicted);
  EXPECT_EQ(backend.catalogue.list({{}, 1, {}}).at(0).state, MeshState::evicted);
  EXPECT_FALSE(backend.catalogue.ready(id));

  std::vector<Phase> heard;
  const auto hear = [&](const MeshNews& news) { heard.push_back(news.phase); };
  const Operator result = backend.prepare(id, {}, hear);
  EXPECT_THAT(heard, ElementsAre(Phase::factorising, Phase::ready));
  EXPECT_EQ(backend.state(id), MeshState::ready);
  EXPECT_EQ(backend.catalogue.meshings(), 1U);
  EXPECT_EQ(backend.cache.metrics().factorizations, 2U);
  EXPECT_TRUE(throws([&] { backend.catalogue.evict(id); }, Reason::in_use));  // held here

  heard.clear();
  EXPECT_EQ(backend.prepare(id, {}, hear), result);
  EXPECT_THAT(heard, ElementsAre(Phase::ready));
}

TEST_F(Prepare, TellsTheStepsOnTheWay) {
  backend.door.shut();
  const std::string id = backend.create();
  std::vector<Phase> heard;
  auto caller = std::async(std::launch::async, [&] {
    return backend.prepare(id, {}, [&](const MeshNews& news) { heard.push_back(news.phase); });
  });
  EXPECT_TRUE(backend.reaches(id, MeshState::factorizing));
  backend.door.open();
  EXPECT_NE(caller.get(), nullptr);
  ASSERT_FALSE(heard.empty());
  EXPECT_TRUE(std::is_sorted(heard.begin(), heard.end()));
  EXPECT_EQ(heard.back(), Phase::ready);
}

TEST_F(Prepare, ObeysAStopWhileFactorisingAndLeavesTheOthersAlone) {
  backend.door.shut();
  const std::string id = backend.create();
  ASSERT_TRUE(backend.reaches(id, MeshState::factorizing));
  std::stop_source stop;
  auto caller = std::async(std::launch::async, [&] { return prepare(id, stop.get_token()); });
  ASSERT_TRUE(eventually([&] { return backend.cache.metrics().joins == 1; }));
  stop.request_stop();
  EXPECT_TRUE(throws([&] { caller.get(); }, Reason::cancelled));
  EXPECT_EQ(backend.state(id), MeshState::factorizing);
  backend.door.open();
  EXPECT_TRUE(backend.reaches(id, MeshState::ready));
  EXPECT_EQ(backend.cache.metrics().factorizations, 1U);
}

TEST_F(Prepare, SaysEvictedAgainAfterTheOnlyCallerStopped) {
  const std::string id = backend.create();
  ASSERT_TRUE(backend.reaches(id, MeshState::ready));
  EXPECT_EQ(backend.catalogue.evict(id).state, MeshState::evicted);
  backend.door.shut();
  std::stop_source stop;
  auto caller = std::async(std::launch::async, [&] { return prepare(id, stop.get_token()); });
  ASSERT_TRUE(backend.reaches(id, MeshState::factorizing));
  ASSERT_TRUE(eventually([&] { return backend.cache.metrics().factorizations == 2; }));
  stop.request_stop();
  EXPECT_TRUE(throws([&] { caller.get(); }, Reason::cancelled));
  EXPECT_EQ(backend.state(id), MeshState::evicted);
  backend.door.open();
  EXPECT_NE(prepare(id), nullptr);
}

TEST_F(Prepare, GoesOnForTheOthersWhenTheFirstCallerStops) {
  const std::string id = backend.create();
  ASSERT_TRUE(backend.reaches(id, MeshState::ready));
  backend.catalogue.evict(id);
  backend.door.shut();
  std::stop_source stop;
  auto first = std::async(std::launch::async, [&] { return prepare(id, stop.get_token()); });
  ASSERT_TRUE(eventually([&] { return backend.cache.metrics().factorizations == 2; }));
  auto second = std::async(std::launch::async, [&] { return prepare(id); });
  ASSERT_TRUE(eventually([&] { return backend.cache.metrics().joins == 1; }));
  stop.request_stop();
  EXPECT_TRUE(throws([&] { first.get(); }, Reason::cancelled));  // while the door is shut
  EXPECT_EQ(backend.state(id), MeshState::factorizing);
  backend.door.open();
  EXPECT_NE(second.get(), nullptr);
  EXPECT_EQ(backend.cache.metrics().factorizations, 2U);
}

TEST_F(Prepare, LetsACallerGoThoughTheFactorisationNoticesItsStopLate) {
  const std::string id = backend.create();
  ASSERT_TRUE(backend.reaches(id, MeshState::ready));
  backend.catalogue.evict(id);
  backend.deaf = true;
  backend.door.shut();
  std::stop_source stop;
  auto first = std::async(std::launch::async, [&] { return prepare(id, stop.get_token()); });
  ASSERT_TRUE(eventually([&] { return backend.door.waiting() == 1; }));
  stop.request_stop();
  EXPECT_TRUE(throws([&] { first.get(); }, Reason::cancelled));
  EXPECT_EQ(backend.state(id), MeshState::evicted);
  auto second = std::async(std::launch::async, [&] { return prepare(id); });
  ASSERT_TRUE(backend.reaches(id, MeshState::factorizing));
  EXPECT_EQ(backend.door.waiting(), 1);  // not beside the one that is being stopped
  backend.door.open();
  EXPECT_NE(second.get(), nullptr);
  EXPECT_EQ(backend.state(id), MeshState::ready);
}

TEST_F(Prepare, KnowsNoOtherMeshes) {
  EXPECT_TRUE(throws([&] { prepare("unknown"); }, Reason::not_found));
}

TEST(PrepareMeshing, ObeysAStopAndTheMesherIsKilledAtTheEnd) {
  BackendOptions options;
  options.mesher_hangs = true;
  Backend backend(options);
  const std::string id = backend.create();
  std::stop_source stop;
  std::promise<void> meshing;
  auto caller = std::async(std::launch::async, [&] {
    return backend.prepare(id, stop.get_token(), [&](const MeshNews& news) {
      if (news.phase == Phase::meshing) meshing.set_value();
    });
  });
  meshing.get_future().wait();
  stop.request_stop();
  EXPECT_TRUE(throws([&] { caller.get(); }, Reason::cancelled));
  EXPECT_EQ(backend.state(id), MeshState::meshing);
  // The destructor would wait for an hour if it did not kill the helper.
}

TEST(PrepareBudget, PassesOnThatMemoryIsHeldByOthers) {
  std::uint64_t larger = 0;
  {
    Backend measure;
    const Operator result = measure.prepare(measure.create(0.2));
    larger = operators::estimate_bytes(result->mesh());
  }
  BackendOptions options;
  options.memory_budget = larger;
  Backend backend(options);
  const std::string first = backend.create(0.25);
  Operator held = backend.prepare(first);
  const std::string second = backend.create(0.2);
  EXPECT_TRUE(throws([&] { backend.prepare(second); }, Reason::busy));
  EXPECT_TRUE(backend.reaches(second, MeshState::evicted));
  held.reset();
  EXPECT_NE(backend.prepare(second), nullptr);
  EXPECT_EQ(backend.state(first), MeshState::evicted);
}

TEST(PrepareFailure, OfTheFactorisationFailsTheMesh) {
  BackendOptions options;
  options.memory_budget = 1024;
  Backend backend(options);
  const std::string id = backend.create();
  EXPECT_TRUE(throws([&] { backend.prepare(id); }, Reason::limit_exceeded));
  ASSERT_TRUE(backend.reaches(id, MeshState::failed));
  EXPECT_EQ(backend.catalogue.get(id).error->reason(), Reason::limit_exceeded);
  EXPECT_NE(backend.catalogue.read(id), nullptr);  // the triangulation is good
  EXPECT_EQ(backend.catalogue.create(Backend::definition(), "", "").state, MeshState::factorizing);
  EXPECT_TRUE(backend.reaches(id, MeshState::failed));
  EXPECT_EQ(backend.catalogue.meshings(), 1U);
}

}  // namespace
}  // namespace anticrack::meshes
