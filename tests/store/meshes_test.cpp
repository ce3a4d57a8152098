// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/contract_fixture.hpp"
#include "store/record_fields.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::AnyValue;
using anticrack::testing::Listing;
using anticrack::testing::throws;
using errors::Reason;
using ::testing::ElementsAre;

class StoredMeshes : public ContractTest {};

TEST_P(StoredMeshes, ComeBackWholeAfterAnotherStart) {
  auto record = AnyValue(5).make<records::MeshRecord>();
  record.id = "m";
  store->put(record);
  reopen();
  EXPECT_EQ(Listing::of(*store->mesh("m")), Listing::of(record));
  record.title = "renamed";
  store->put(record);
  reopen();
  EXPECT_EQ(Listing::of(*store->mesh("m")), Listing::of(record));
  EXPECT_FALSE(store->mesh("other"));
}

TEST_P(StoredMeshes, AreListedNewestFirstByOwner) {
  EXPECT_EQ(store->mesh_count(), 0U);
  store->put(mesh_record("a", "ann"));
  store->put(mesh_record("b", "bob"));
  store->put(mesh_record("c", "ann"));
  store->put(mesh_record("a", "ann"));  // replaced where it is
  EXPECT_EQ(store->mesh_count(), 3U);
  EXPECT_THAT(meshes({"", 9, {}}), ElementsAre("c", "b", "a"));
  EXPECT_THAT(meshes({"c", 1, {}}), ElementsAre("b"));
  EXPECT_THAT(meshes({"c", 9, "ann"}), ElementsAre("a"));
  EXPECT_TRUE(throws([&] { meshes({"b", 9, "ann"}); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { meshes({"gone", 9, {}}); }, Reason::not_found));
}

TEST_P(StoredMeshes, KeepTheirTriangulations) {
  const mesh::Mesh mesh = strip(4);
  const records::MeshRecord record = meshed_record("m", mesh);
  EXPECT_EQ(store->triangulation(record.sha256), nullptr);
  store->put(record, mesh);
  reopen();
  const auto read = store->triangulation(record.sha256);
  ASSERT_NE(read, nullptr);
  EXPECT_EQ(mesh::encode(*read), mesh::encode(mesh));
  EXPECT_EQ(store->triangulation(record.sha256), read) << "all who hold it share one";
  EXPECT_EQ(store->usage().meshes, mesh::encode(mesh).size());
  EXPECT_EQ(store->triangulation("../anticrack.db"), nullptr);
  EXPECT_EQ(store->triangulation(""), nullptr);
}

TEST_P(StoredMeshes, ShareEqualTriangulationsUntilTheLastGoes) {
  const mesh::Mesh mesh = strip(4);
  const records::MeshRecord a = meshed_record("a", mesh);
  store->put(a, mesh);
  store->put(meshed_record("b", mesh), mesh);
  EXPECT_EQ(blobs(FileKind::mesh), 1U);
  store->erase_mesh("a");
  EXPECT_NE(store->triangulation(a.sha256), nullptr);
  const auto held = store->triangulation(a.sha256);
  store->erase_mesh("b");
  EXPECT_EQ(store->triangulation(a.sha256), nullptr);
  EXPECT_EQ(blobs(FileKind::mesh), 0U);
  EXPECT_EQ(store->usage().meshes, 0U);
  EXPECT_EQ(mesh::encode(*held), mesh::encode(mesh));
  EXPECT_TRUE(throws([&] { store->erase_mesh("b"); }, Reason::not_found));
}

TEST_P(StoredMeshes, DropATriangulationThatAnotherReplaces) {
  store->put(meshed_record("m", strip(4)), strip(4));
  const records::MeshRecord finer = meshed_record("m", strip(8));
  store->put(finer, strip(8));
  EXPECT_EQ(blobs(FileKind::mesh), 1U);
  EXPECT_NE(store->triangulation(finer.sha256), nullptr);
  store->put(mesh_record("m"));
  EXPECT_EQ(blobs(FileKind::mesh), 0U);
}

TEST_P(StoredMeshes, RefuseAnotherTriangulation) {
  EXPECT_TRUE(
      throws([&] { store->put(meshed_record("m", strip(4)), strip(5)); }, Reason::internal));
  EXPECT_FALSE(store->mesh("m"));
}

TEST_P(StoredMeshes, SayWhenATriangulationIsDamaged) {
  const records::MeshRecord record = meshed_record("m", strip(4));
  store->put(record, strip(4));
  damage(FileKind::mesh, record.sha256);
  EXPECT_TRUE(throws([&] { store->triangulation(record.sha256); }, Reason::storage));
  store->put(record, strip(4));
  EXPECT_NE(store->triangulation(record.sha256), nullptr);
}

INSTANTIATE_TEST_SUITE_P(All, StoredMeshes, stores, name_of_store);

}  // namespace
}  // namespace anticrack::store
