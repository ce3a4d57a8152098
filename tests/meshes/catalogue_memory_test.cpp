// SPDX-License-Identifier: GPL-3.0-or-later
//
// Warming, pinning, evicting and erasing.
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <stop_token>
#include <string>
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

class Memory : public ::testing::Test {
 protected:
  std::string ready_mesh(double size = 0.2) {
    const std::string id = backend.create(size);
    EXPECT_TRUE(backend.reaches(id, MeshState::ready));
    return id;
  }
  bool pinned(const std::string& id) {
    return eventually([&] { return backend.catalogue.pinned(id); });
  }

  Backend backend;
};

TEST_F(Memory, IsWarmedInTheBackground) {
  const std::string id = ready_mesh();
  EXPECT_EQ(backend.catalogue.warm(id, false).state, MeshState::ready);
  EXPECT_EQ(backend.cache.metrics().factorizations, 1U);
  backend.catalogue.evict(id);
  backend.door.shut();
  EXPECT_EQ(backend.catalogue.warm(id, false).state, MeshState::factorizing);
  backend.door.open();
  EXPECT_TRUE(backend.reaches(id, MeshState::ready));
  EXPECT_FALSE(backend.catalogue.pinned(id));
  EXPECT_EQ(backend.catalogue.meshings(), 1U);
  EXPECT_EQ(backend.cache.metrics().factorizations, 2U);
  EXPECT_TRUE(throws([&] { backend.catalogue.warm("unknown", true); }, Reason::not_found));
}

TEST_F(Memory, IsPinnedAtOnceWhereItIsThere) {
  const std::string id = ready_mesh();
  EXPECT_FALSE(backend.catalogue.pinned(id));
  backend.catalogue.warm(id, true);
  EXPECT_TRUE(backend.catalogue.pinned(id));
  EXPECT_EQ(backend.cache.metrics().factorizations, 1U);
  EXPECT_EQ(backend.catalogue.evict(id).state, MeshState::evicted);
  EXPECT_FALSE(backend.catalogue.pinned(id));
}

TEST_F(Memory, IsPinnedWhenItHasCome) {
  backend.door.shut();
  const std::string id = backend.create();
  ASSERT_TRUE(backend.reaches(id, MeshState::factorizing));
  backend.catalogue.warm(id, true);
  EXPECT_FALSE(backend.catalogue.pinned(id));
  backend.door.open();
  EXPECT_TRUE(pinned(id));
  EXPECT_TRUE(backend.reaches(id, MeshState::ready));
  EXPECT_FALSE(backend.catalogue.pinned("unknown"));
}

TEST_F(Memory, IsNotEvictedWhileItIsHeldOrMade) {
  const std::string id = ready_mesh();
  auto held = backend.prepare(id);
  EXPECT_TRUE(throws([&] { backend.catalogue.evict(id); }, Reason::in_use));
  held.reset();
  backend.catalogue.evict(id);
  backend.catalogue.evict(id);  // nothing to do
  EXPECT_EQ(backend.cache.metrics().bytes, 0U);
  backend.door.shut();
  backend.catalogue.warm(id, false);
  ASSERT_TRUE(eventually([&] { return backend.cache.metrics().factorizations == 2; }));
  EXPECT_TRUE(throws([&] { backend.catalogue.evict(id); }, Reason::in_use));
  backend.door.open();
  EXPECT_TRUE(backend.reaches(id, MeshState::ready));
  EXPECT_TRUE(throws([&] { backend.catalogue.evict("unknown"); }, Reason::not_found));
}

TEST_F(Memory, GoesWithAMeshThatIsErased) {
  const std::string id = ready_mesh();
  backend.catalogue.erase(id);
  EXPECT_EQ(backend.cache.metrics().entries, 0);
  EXPECT_EQ(backend.store->usage().meshes, 0U);
  EXPECT_TRUE(backend.catalogue.list({{}, 10, {}}).empty());
  EXPECT_TRUE(throws([&] { backend.catalogue.erase(id); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { backend.catalogue.use(id); }, Reason::not_found));
  EXPECT_EQ(ready_mesh(), id);  // made anew
  EXPECT_EQ(backend.catalogue.meshings(), 2U);
}

TEST_F(Memory, GoesWithAMeshThatIsErasedWhileItIsFactorised) {
  backend.door.shut();
  const std::string id = backend.create();
  ASSERT_TRUE(backend.reaches(id, MeshState::factorizing));
  std::stop_source stop;
  auto caller =
      std::async(std::launch::async, [&] { return backend.prepare(id, stop.get_token()); });
  backend.catalogue.erase(id);
  EXPECT_TRUE(throws([&] { caller.get(); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { backend.catalogue.get(id); }, Reason::not_found));
  backend.door.open();
  EXPECT_TRUE(eventually([&] { return backend.cache.metrics().entries == 0; }));
  EXPECT_EQ(backend.store->usage().meshes, 0U);
}

TEST_F(Memory, IsNotErasedWhileAJobUsesIt) {
  const std::string id = ready_mesh();
  std::shared_ptr<void> first = backend.catalogue.use(id);
  std::shared_ptr<void> second = backend.catalogue.use(id);
  first.reset();
  EXPECT_TRUE(throws([&] { backend.catalogue.erase(id); }, Reason::in_use));
  second.reset();
  backend.catalogue.erase(id);
}

TEST(MemoryQueue, IsBusyWhenTooManyWaitToBeWarmed) {
  BackendOptions options;
  options.max_pending = 1;
  Backend backend(options);
  std::vector<std::string> ids;
  for (const double size : {0.2, 0.25, 0.3, 0.35}) {
    ids.push_back(backend.create(size));
    ASSERT_TRUE(backend.reaches(ids.back(), MeshState::ready));
    backend.catalogue.evict(ids.back());
  }
  backend.door.shut();
  for (int i = 0; i < 2; ++i) {  // one for each thread that prepares
    backend.catalogue.warm(ids[static_cast<std::size_t>(i)], false);
    ASSERT_TRUE(eventually([&] { return backend.door.waiting() == i + 1; }));
  }
  backend.catalogue.warm(ids[2], false);
  EXPECT_TRUE(throws([&] { backend.catalogue.warm(ids[3], false); }, Reason::busy));
  backend.door.open();
  EXPECT_TRUE(backend.reaches(ids[2], MeshState::ready));
}

}  // namespace
}  // namespace anticrack::meshes
