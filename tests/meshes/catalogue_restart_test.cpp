// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a catalogue finds on the disk, and what it does when the disk refuses.
#include <gtest/gtest.h>

#include <filesystem>

#include "meshes/mesh_index.hpp"
#include "support/backend.hpp"
#include "support/errors.hpp"
#include "support/eventually.hpp"
#include "support/flip.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::meshes {
namespace {

using anticrack::testing::Backend;
using anticrack::testing::BackendOptions;
using anticrack::testing::eventually;
using anticrack::testing::TemporaryFolder;
using anticrack::testing::throws;
using errors::Reason;
using records::MeshRecord;
using records::MeshState;

class Restart : public ::testing::Test {
 protected:
  Restart() { options.data_folder = (folder / "data").string(); }
  /// From now on the disk refuses meshes; give_back() ends that.
  void take_away() { std::filesystem::rename(folder / "data/meshes", folder / "away"); }
  void give_back() { std::filesystem::rename(folder / "away", folder / "data/meshes"); }

  TemporaryFolder folder;
  BackendOptions options;
};

TEST_F(Restart, FindsMeshesEvictedAndMakesTheirOperatorsAgain) {
  MeshRecord before;
  {
    Backend backend(options);
    const std::string id = backend.catalogue.create(Backend::definition(), "a title", "ann").id;
    ASSERT_TRUE(backend.reaches(id, MeshState::ready));
    before = backend.catalogue.get(id);
  }
  Backend backend(options);
  const MeshRecord after = backend.catalogue.get(before.id);
  EXPECT_EQ(after.state, MeshState::evicted);
  EXPECT_EQ(after.title, "a title");
  EXPECT_EQ(after.owner, "ann");
  EXPECT_EQ(after.sha256, before.sha256);
  EXPECT_EQ(after.operator_bytes, before.operator_bytes);
  EXPECT_EQ(backend.catalogue.read(before.id)->arrays()[0].shape[0], before.node_count);
  EXPECT_NE(backend.prepare(before.id), nullptr);
  EXPECT_EQ(backend.catalogue.get(before.id).state, MeshState::ready);
  EXPECT_EQ(backend.catalogue.create(Backend::definition(), "", "ann").id, before.id);
  EXPECT_EQ(backend.catalogue.meshings(), 0U);
}

TEST_F(Restart, MeshesWhatWasNotMeshed) {
  std::string meshing;
  std::string waiting;
  options.mesher_hangs = true;
  {
    Backend backend(options);
    meshing = backend.create(0.2);
    backend.create(0.25);
    ASSERT_TRUE(eventually([&] { return backend.catalogue.meshings() == 2; }));
    waiting = backend.create(0.3);
  }
  options.mesher_hangs = false;
  Backend backend(options);
  EXPECT_TRUE(backend.reaches(meshing, MeshState::ready));
  EXPECT_TRUE(backend.reaches(waiting, MeshState::ready));
  EXPECT_EQ(backend.catalogue.meshings(), 3U);
}

TEST_F(Restart, FindsAFailedMeshWithItsError) {
  std::string id;
  {
    Backend backend(options);
    id = backend.catalogue.create(backend.upload("$MeshFormat\n"), "", "").id;
    ASSERT_TRUE(backend.reaches(id, MeshState::failed));
  }
  Backend backend(options);
  const MeshRecord record = backend.catalogue.get(id);
  EXPECT_EQ(record.state, MeshState::failed);
  ASSERT_TRUE(record.error);
  EXPECT_TRUE(throws([&] { backend.prepare(id); }, record.error->reason()));
  EXPECT_EQ(backend.catalogue.meshings(), 0U);
}

TEST_F(Restart, MakesAMeshWhoseRecordIsDamagedAgain) {
  std::string id;
  {
    Backend backend(options);
    id = backend.catalogue.create(Backend::definition(), "a long title", "").id;
    ASSERT_TRUE(backend.reaches(id, MeshState::ready));
  }
  const std::string database = options.data_folder + "/anticrack.db";
  const auto places = anticrack::testing::places_of("a long title", database);
  ASSERT_FALSE(places.empty());
  for (const std::size_t place : places) anticrack::testing::flip(database, place, 10);
  Backend backend(options);
  const MeshRecord damaged = backend.catalogue.get(id);
  EXPECT_EQ(damaged.state, MeshState::failed);
  EXPECT_EQ(damaged.error.value().reason(), Reason::storage);
  EXPECT_EQ(backend.catalogue.list({{}, 9, {}}).size(), 1U);
  EXPECT_TRUE(throws([&] { backend.prepare(id); }, Reason::storage));
  EXPECT_EQ(backend.catalogue.create(Backend::definition(), "again", "").id, id);
  ASSERT_TRUE(backend.reaches(id, MeshState::ready));
  EXPECT_EQ(backend.catalogue.get(id).title, "again");
  EXPECT_FALSE(backend.catalogue.get(id).error);
}

TEST_F(Restart, DoesNotMeshAnUploadThatHasChangedOnTheDisk) {
  const std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n9";
  Backend backend(options);
  const records::UploadRef upload = backend.upload(text);
  anticrack::testing::flip(backend.store->upload_path(upload.sha256, "").value(), text.size() - 1);
  const std::string id = backend.catalogue.create(upload, "", "").id;
  EXPECT_TRUE(throws([&] { backend.prepare(id); }, Reason::not_found));
}

TEST_F(Restart, MeshesWhatTheDiskHadNoRoomFor) {
  std::string id;
  options.disk_budget = 1;
  {
    Backend backend(options);
    id = backend.create(0.2);
    EXPECT_TRUE(throws([&] { backend.prepare(id); }, Reason::disk_full));
    EXPECT_TRUE(backend.reaches(id, MeshState::pending));
    EXPECT_FALSE(backend.catalogue.get(id).error);
    EXPECT_TRUE(eventually([&] { return backend.catalogue.pending() == 0; }));
    const std::uint64_t before = backend.catalogue.meshings();
    EXPECT_EQ(backend.create(0.2), id);
    EXPECT_TRUE(eventually([&] { return backend.catalogue.meshings() > before; }));
  }
  options.disk_budget = 0;
  Backend backend(options);
  EXPECT_TRUE(backend.reaches(id, MeshState::ready));
}

TEST_F(Restart, TellsWhoWaitsThatTheDiskRefusesAndTriesAgainLater) {
  Backend backend(options);
  take_away();
  const std::string id = backend.create(0.2);
  const auto prepare = [&] { return backend.prepare(id); };
  EXPECT_TRUE(throws(prepare, Reason::storage));
  EXPECT_TRUE(backend.reaches(id, MeshState::pending));
  EXPECT_FALSE(backend.catalogue.get(id).error);
  EXPECT_TRUE(eventually([&] { return backend.catalogue.pending() == 0; }));

  give_back();
  EXPECT_EQ(backend.create(0.2), id);
  EXPECT_NE(prepare(), nullptr);
  EXPECT_EQ(backend.state(id), MeshState::ready);
}

TEST_F(Restart, TriesAgainForWhoAsksForTheOperators) {
  Backend backend(options);
  take_away();
  const std::string id = backend.create(0.2);
  ASSERT_TRUE(eventually(
      [&] { return backend.catalogue.meshings() == 1 && backend.catalogue.pending() == 0; }));
  give_back();
  EXPECT_NE(backend.prepare(id), nullptr);
  EXPECT_GE(backend.catalogue.meshings(), 2U);
}

TEST(Lasting, IsNoErrorOfTheMoment) {
  for (const Reason passing :
       {Reason::busy, Reason::cancelled, Reason::disk_full, Reason::storage}) {
    EXPECT_FALSE(lasting({passing, ""}));
  }
  for (const Reason certain : {Reason::mesh_invalid, Reason::mesher_failed, Reason::numerical,
                               Reason::limit_exceeded, Reason::internal}) {
    EXPECT_TRUE(lasting({certain, ""}));
  }
}

}  // namespace
}  // namespace anticrack::meshes
