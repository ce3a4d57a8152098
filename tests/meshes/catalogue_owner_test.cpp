// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <future>
#include <stop_token>
#include <string>

#include "support/backend.hpp"
#include "support/errors.hpp"
#include "support/eventually.hpp"

namespace anticrack::meshes {
namespace {

using anticrack::testing::Backend;
using anticrack::testing::eventually;
using anticrack::testing::throws;
using errors::Reason;
using records::MeshRecord;
using records::MeshState;

class Owners : public ::testing::Test {
 protected:
  MeshRecord create(const std::string& owner) {
    return backend.catalogue.create(Backend::definition(), "", owner);
  }
  bool ready(const std::string& id) { return backend.reaches(id, MeshState::ready); }

  Backend backend;
};

TEST_F(Owners, HaveTheirOwnRecordsOfOneMesh) {
  const std::string nobodys = create("").id;
  const MeshRecord ann = create("ann");
  const MeshRecord bob = create("bob");
  EXPECT_EQ(ann.owner, "ann");
  EXPECT_NE(ann.id, nobodys);
  EXPECT_NE(ann.id, bob.id);
  EXPECT_EQ(create("ann").id, ann.id);
  EXPECT_EQ(backend.catalogue.list({{}, 10, {}}).size(), 3U);
  const auto page = backend.catalogue.list({{}, 10, "ann"});
  ASSERT_EQ(page.size(), 1U);
  EXPECT_EQ(page[0].id, ann.id);
}

TEST_F(Owners, ShareTheTriangulationAndTheOperators) {
  const std::string ann = create("ann").id;
  ASSERT_TRUE(ready(ann));
  const std::string bob = create("bob").id;
  ASSERT_TRUE(ready(bob));
  EXPECT_EQ(backend.catalogue.meshings(), 1U);
  EXPECT_EQ(backend.cache.metrics().factorizations, 1U);
  const MeshRecord first = backend.catalogue.get(ann);
  const MeshRecord second = backend.catalogue.get(bob);
  EXPECT_EQ(second.sha256, first.sha256);
  EXPECT_EQ(second.owner, "bob");
  EXPECT_EQ(second.node_count, first.node_count);
  EXPECT_EQ(second.operator_bytes, first.operator_bytes);
  EXPECT_EQ(backend.prepare(ann), backend.prepare(bob));
}

TEST_F(Owners, GetTheOperatorsThoughTheOtherStoppedWaitingForThem) {
  const std::string ann = create("ann").id;
  ASSERT_TRUE(ready(ann));
  const std::string bob = create("bob").id;
  ASSERT_TRUE(ready(bob));
  backend.catalogue.evict(ann);
  backend.door.shut();
  const auto prepare = [&](const std::string& id, std::stop_token stop) {
    return std::async(std::launch::async, [this, id, stop] { return backend.prepare(id, stop); });
  };
  std::stop_source stop;
  auto first = prepare(ann, stop.get_token());
  ASSERT_TRUE(eventually([&] { return backend.door.waiting() == 1; }));
  auto second = prepare(bob, {});
  ASSERT_TRUE(eventually([&] { return backend.cache.metrics().joins == 1; }));
  stop.request_stop();
  EXPECT_TRUE(throws([&] { first.get(); }, Reason::cancelled));
  EXPECT_EQ(backend.door.waiting(), 1);
  backend.door.open();
  EXPECT_NE(second.get(), nullptr);
  EXPECT_EQ(backend.cache.metrics().factorizations, 2U);
}

TEST_F(Owners, KeepWhatTheOtherErases) {
  const std::string ann = create("ann").id;
  ASSERT_TRUE(ready(ann));
  const std::string bob = create("bob").id;
  ASSERT_TRUE(ready(bob));
  backend.catalogue.erase(ann);
  EXPECT_TRUE(throws([&] { backend.catalogue.get(ann); }, Reason::not_found));
  EXPECT_EQ(backend.state(bob), MeshState::ready);
  EXPECT_NE(backend.catalogue.read(bob), nullptr);
  EXPECT_EQ(backend.cache.metrics().entries, 1);
  backend.catalogue.erase(bob);
  EXPECT_EQ(backend.cache.metrics().entries, 0);
  EXPECT_EQ(backend.store->usage().meshes, 0U);
}

TEST_F(Owners, CannotMeshTheUploadsOfOthers) {
  const records::UploadRef upload = backend.upload("$MeshFormat\n", "ann");
  EXPECT_TRUE(
      throws([&] { backend.catalogue.create(upload, "", "bob"); }, Reason::not_found, "upload"));
  EXPECT_EQ(backend.catalogue.create(upload, "", "ann").owner, "ann");
}

}  // namespace
}  // namespace anticrack::meshes
