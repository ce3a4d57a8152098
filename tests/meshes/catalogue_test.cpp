// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>
#include <thread>
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
using records::MeshRecord;
using records::MeshState;

class Catalogue : public ::testing::Test {
 protected:
  Backend backend;
};

TEST_F(Catalogue, MakesAMeshReadyInTheBackground) {
  const MeshRecord created = backend.catalogue.create(Backend::definition(), "a title", "");
  EXPECT_EQ(created.state, MeshState::pending);
  EXPECT_EQ(created.id.size(), 16U);
  ASSERT_TRUE(backend.reaches(created.id, MeshState::ready));
  const MeshRecord record = backend.catalogue.get(created.id);
  EXPECT_EQ(record.title, "a title");
  EXPECT_EQ(record.sha256.size(), 64U);
  EXPECT_FALSE(record.error);
  ASSERT_EQ(record.subdomains.size(), 2U);
  EXPECT_NEAR(record.subdomains[0].area, 2, 1e-12);
  EXPECT_NEAR(record.subdomains[1].area, 2, 1e-12);
  ASSERT_EQ(record.interfaces.size(), 1U);
  EXPECT_NEAR(record.interfaces[0].length, 2, 1e-12);
  ASSERT_EQ(record.interfaces[0].segments.size(), 3U);
  EXPECT_EQ(record.interfaces[0].segments[1].kind, mesh::Kind::delaminated);
  EXPECT_NEAR(record.interfaces[0].segments[1].begin, 0.5, 1e-12);
  EXPECT_EQ(record.inclusions, std::vector<std::string>{"inclusion"});
  EXPECT_GT(record.minimum_angle, 20);
  EXPECT_GT(record.mesh_seconds, 0);
  EXPECT_GT(record.factorize_seconds, 0);
  EXPECT_EQ(record.operator_bytes, backend.cache.metrics().bytes);
  EXPECT_TRUE(backend.catalogue.ready(created.id));
  EXPECT_EQ(backend.catalogue.meshings(), 1U);
  EXPECT_EQ(backend.cache.metrics().factorizations, 1U);
}

TEST_F(Catalogue, ReadsTheMeshOnceThereIsOne) {
  const std::string id = backend.create();
  ASSERT_TRUE(backend.reaches(id, MeshState::ready));
  const auto block = backend.catalogue.read(id);
  const MeshRecord record = backend.catalogue.get(id);
  EXPECT_EQ(block->arrays()[0].shape[0], record.node_count);
  EXPECT_EQ(block->arrays()[1].shape[0], record.triangle_count);
  EXPECT_TRUE(throws([&] { backend.catalogue.read("unknown"); }, Reason::not_found));
}

TEST_F(Catalogue, RefusesARefinementThatAddsNothing) {
  const std::string id = backend.create();
  ASSERT_TRUE(backend.reaches(id, MeshState::ready));
  std::vector<std::uint8_t> levels(backend.catalogue.get(id).triangle_count, 0);
  EXPECT_TRUE(throws(
      [&] {
        backend.catalogue.refine({id, "job", ""}, levels, 10'000);
      },
      Reason::numerical));
  EXPECT_EQ(backend.catalogue.list({{}, 10, {}}).size(), 1U);
  levels[0] = 1;
  EXPECT_GT(backend.catalogue.refine({id, "job", ""}, levels, 10'000).triangle_count,
            levels.size());
}

TEST_F(Catalogue, GivesTheSameMeshForTheSameDefinition) {
  const MeshRecord first = backend.catalogue.create(Backend::definition(), "first", "");
  ASSERT_TRUE(backend.reaches(first.id, MeshState::ready));
  const MeshRecord again = backend.catalogue.create(Backend::definition(), "second", "");
  EXPECT_EQ(again.id, first.id);
  EXPECT_EQ(again.title, "first");
  EXPECT_EQ(again.state, MeshState::ready);
  EXPECT_NE(backend.create(0.3), first.id);
  EXPECT_EQ(backend.catalogue.list({{}, 10, {}}).size(), 2U);
}

TEST_F(Catalogue, MakesOneMeshOfADefinitionThatManyThreadsSend) {
  std::vector<std::thread> threads;
  std::vector<std::string> ids(4);
  for (std::size_t t = 0; t < ids.size(); ++t) {
    threads.emplace_back([&, t] { ids[t] = backend.create(); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  ASSERT_TRUE(backend.reaches(ids[0], MeshState::ready));
  EXPECT_THAT(ids, ::testing::Each(ids[0]));
  EXPECT_EQ(backend.catalogue.meshings(), 1U);
  EXPECT_EQ(backend.cache.metrics().factorizations, 1U);
}

TEST_F(Catalogue, RefusesWhatCanBeNoMesh) {
  auto source = std::get<records::GeometrySource>(Backend::definition());
  source.geometry.inclusions[0].part.from = {-0.5, 0.3};
  EXPECT_TRUE(throws([&] { backend.catalogue.create(source, "", ""); }, Reason::geometry_invalid));
  EXPECT_TRUE(throws([&] { backend.catalogue.create(Backend::definition(-1), "", ""); },
                     Reason::invalid_argument, "options.size"));
  EXPECT_TRUE(
      throws([&] { backend.catalogue.create(records::UploadRef{std::string(64, 'f')}, "", ""); },
             Reason::not_found, "upload"));
  records::UploadRef wrong = backend.upload("$MeshFormat\n");
  wrong.options.preset = mesh::Preset::paper;
  EXPECT_TRUE(throws([&] { backend.catalogue.create(wrong, "", ""); }, Reason::invalid_argument,
                     "options.preset"));
  EXPECT_TRUE(throws([&] { backend.catalogue.create(backend.upload("Merge \"x.geo\";"), "", ""); },
                     Reason::mesh_invalid));
  EXPECT_TRUE(backend.catalogue.list({{}, 10, {}}).empty());
  EXPECT_TRUE(throws([&] { backend.catalogue.get("unknown"); }, Reason::not_found));
  EXPECT_FALSE(backend.catalogue.ready("unknown"));
}

TEST_F(Catalogue, KeepsTheErrorOfAMeshThatFailedAndTriesItAgain) {
  const records::MeshDefinition truncated =
      backend.upload("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n9");
  const std::string id = backend.catalogue.create(truncated, "", "").id;
  ASSERT_TRUE(backend.reaches(id, MeshState::failed));
  EXPECT_EQ(backend.catalogue.get(id).error->reason(), Reason::mesh_invalid);
  EXPECT_TRUE(throws([&] { backend.catalogue.read(id); }, Reason::not_ready));
  EXPECT_TRUE(throws([&] { backend.prepare(id); }, Reason::mesh_invalid));
  EXPECT_TRUE(throws([&] { backend.catalogue.warm(id, true); }, Reason::mesh_invalid));
  EXPECT_EQ(backend.catalogue.meshings(), 1U);

  const MeshRecord again = backend.catalogue.create(truncated, "", "");
  EXPECT_EQ(again.id, id);
  EXPECT_EQ(again.state, MeshState::pending);
  EXPECT_TRUE(eventually([&] { return backend.catalogue.meshings() == 2; }));
  EXPECT_TRUE(backend.reaches(id, MeshState::failed));
}

TEST_F(Catalogue, ListsNewestFirst) {
  const std::string first = backend.create(0.25);
  const std::string second = backend.create(0.3);
  const auto page = backend.catalogue.list({{}, 1, {}});
  ASSERT_EQ(page.size(), 1U);
  EXPECT_EQ(page[0].id, second);
  EXPECT_EQ(backend.catalogue.list({second, 5, {}}).at(0).id, first);
  EXPECT_TRUE(throws([&] { backend.catalogue.list({"unknown", 5, {}}); }, Reason::not_found));
}

TEST(CatalogueQueue, IsBusyWhenTooManyWait) {
  BackendOptions options;
  options.mesher_hangs = true;
  options.max_pending = 1;
  Backend backend(options);
  backend.create(0.2);
  ASSERT_TRUE(eventually([&] { return backend.catalogue.meshings() == 1; }));
  backend.create(0.3);
  ASSERT_TRUE(eventually([&] { return backend.catalogue.meshings() == 2; }));
  const std::string waiting = backend.create(0.4);
  EXPECT_EQ(backend.state(waiting), MeshState::pending);
  const auto error = anticrack::testing::error_of([&] { backend.create(0.5); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::busy);
  EXPECT_GT(error->retry_delay().count(), 0);
  EXPECT_EQ(backend.catalogue.list({{}, 10, {}}).size(), 3U);
  EXPECT_EQ(backend.create(0.4), waiting);  // no new one
  EXPECT_EQ(backend.catalogue.pending(), 3);
}

TEST(CatalogueQueue, KeepsNoMoreMeshesThanItMay) {
  BackendOptions options;
  options.max_meshes = 2;
  Backend backend(options);
  const std::string first = backend.create(0.3);
  backend.create(0.35);
  EXPECT_TRUE(throws([&] { backend.create(0.4); }, Reason::quota_exceeded));
  EXPECT_EQ(backend.create(0.3), first);  // no new one
  ASSERT_TRUE(backend.reaches(first, MeshState::ready));
  backend.catalogue.erase(first);
  EXPECT_FALSE(backend.create(0.4).empty());
}

TEST(CatalogueMeshed, TellsOfEachMeshTheHelperMadeOrDidNot) {
  std::mutex mutex;
  std::vector<MeshRecord> told;
  BackendOptions options;
  options.meshed = [&](const MeshRecord& record) {
    const std::lock_guard lock(mutex);
    told.push_back(record);
  };
  Backend backend(options);
  const std::string good = backend.create();
  ASSERT_TRUE(backend.reaches(good, MeshState::ready));
  const std::string bad = backend.catalogue.create(backend.upload("$MeshFormat\n"), "", "").id;
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return told.size() == 2;
  }));
  EXPECT_EQ(told[0].id, good);
  EXPECT_FALSE(told[0].error);
  EXPECT_GT(told[0].mesh_seconds, 0);
  EXPECT_EQ(told[1].id, bad);
  EXPECT_TRUE(told[1].error);
}

}  // namespace
}  // namespace anticrack::meshes
