// SPDX-License-Identifier: GPL-3.0-or-later
//
// Who wants a mesh, what becomes of one that nobody wants, and how far the mesher says it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <future>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "support/backend.hpp"
#include "support/errors.hpp"
#include "support/eventually.hpp"
#include "support/flip.hpp"

namespace anticrack::meshes {
namespace {

using anticrack::testing::Backend;
using anticrack::testing::BackendOptions;
using anticrack::testing::eventually;
using anticrack::testing::throws;
using errors::Reason;
using records::MeshState;

/// The processes of this one whose program is `name`.
int children(const std::string& name) {
  int count = 0;
  const std::string own = std::to_string(getpid());
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "stat");
    std::string pid, program, state, parent;
    if (!(file >> pid >> program >> state >> parent)) continue;
    count += parent == own && program == "(" + name + ")" && state != "Z" ? 1 : 0;
  }
  return count;
}

/// A mesher that does not end by itself.
class Wanted : public ::testing::Test {
 protected:
  static BackendOptions hanging() {
    BackendOptions options;
    options.mesher_hangs = true;
    return options;
  }
  std::string create(bool for_job, double size = 0.1) {
    return backend.catalogue.create(Backend::definition(size), "", "", for_job).id;
  }
  bool meshers(int count) {
    return eventually([&] { return children("sleep") == count; });
  }
  /// Waits for the mesh as a job does.
  auto wait(const std::string& id, const std::stop_source& stop) {
    return std::async(std::launch::async,
                      [this, id, token = stop.get_token()] { return backend.prepare(id, token); });
  }

  Backend backend{hanging()};
};

TEST_F(Wanted, ByTheJobsItWasMadeForUntilTheLastEnds) {
  const std::string id = create(true);
  std::shared_ptr<void> first = backend.catalogue.use(id), second = backend.catalogue.use(id);
  ASSERT_TRUE(backend.reaches(id, MeshState::meshing));
  ASSERT_TRUE(meshers(1));
  first.reset();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(backend.state(id), MeshState::meshing);
  second.reset();
  EXPECT_EQ(backend.state(id), MeshState::pending);
  EXPECT_TRUE(meshers(0));
}

TEST_F(Wanted, StopsWithTheWaitOfItsJobs) {
  const std::string id = create(true);
  std::shared_ptr<void> use = backend.catalogue.use(id);
  std::stop_source stop;
  auto waiter = wait(id, stop);
  ASSERT_TRUE(meshers(1));
  stop.request_stop();
  EXPECT_TRUE(throws([&] { waiter.get(); }, Reason::cancelled));
  use.reset();
  EXPECT_EQ(backend.state(id), MeshState::pending);
  EXPECT_TRUE(meshers(0));
}

TEST_F(Wanted, GoesOnForTheNextJob) {
  const std::string id = create(true);
  backend.catalogue.use(id).reset();
  EXPECT_TRUE(backend.reaches(id, MeshState::pending));
  EXPECT_TRUE(meshers(0));
  std::shared_ptr<void> use = backend.catalogue.use(id);
  std::stop_source stop;
  auto waiter = wait(id, stop);
  EXPECT_TRUE(backend.reaches(id, MeshState::meshing));
  EXPECT_TRUE(meshers(1));
  stop.request_stop();
  EXPECT_TRUE(throws([&] { waiter.get(); }, Reason::cancelled));
}

TEST_F(Wanted, ByItsOwnerWhoCreatedItOnItsOwn) {
  const std::string id = create(false);
  ASSERT_TRUE(backend.reaches(id, MeshState::meshing));
  std::shared_ptr<void> use = backend.catalogue.use(id);
  std::stop_source stop;
  auto waiter = wait(id, stop);
  stop.request_stop();
  EXPECT_TRUE(throws([&] { waiter.get(); }, Reason::cancelled));
  use.reset();
  EXPECT_EQ(backend.state(id), MeshState::meshing);
}

TEST_F(Wanted, ByAnOwnerWhoCreatesItBesideItsJobs) {
  const std::string id = create(true);
  std::shared_ptr<void> use = backend.catalogue.use(id);
  ASSERT_TRUE(backend.reaches(id, MeshState::meshing));
  EXPECT_EQ(create(false), id);
  EXPECT_EQ(create(true), id);  // a job more does not take it from its owner
  use.reset();
  EXPECT_EQ(backend.state(id), MeshState::meshing);
  EXPECT_TRUE(meshers(1));
  EXPECT_EQ(backend.catalogue.meshings(), 1U);
  EXPECT_FALSE(backend.store->mesh(id)->for_job) << "after a restart it is wanted still";
}

TEST_F(Wanted, ByWhoWarmsIt) {
  const std::string id = create(true);
  std::shared_ptr<void> use = backend.catalogue.use(id);
  ASSERT_TRUE(backend.reaches(id, MeshState::meshing));
  backend.catalogue.warm(id, false);
  use.reset();
  EXPECT_EQ(backend.state(id), MeshState::meshing);
}

TEST_F(Wanted, MakesRoomForOthersThatWait) {
  std::vector<std::shared_ptr<void>> uses;
  std::vector<std::string> ids;
  for (const double size : {0.2, 0.21, 0.22}) {  // two of a size are meshed at once
    ids.push_back(create(true, size));
    uses.push_back(backend.catalogue.use(ids.back()));
  }
  ASSERT_TRUE(eventually([&] { return backend.catalogue.meshings() == 2; }));
  EXPECT_EQ(backend.state(ids[2]), MeshState::pending);
  uses[0].reset();
  EXPECT_TRUE(backend.reaches(ids[2], MeshState::meshing));
  uses[2].reset();
  uses[1].reset();
  EXPECT_TRUE(meshers(0));
  EXPECT_EQ(backend.catalogue.pending(), 0);
}

TEST_F(Wanted, IsErasedWhileItIsMeshedOrWaits) {
  std::vector<std::string> ids;
  for (const double size : {0.2, 0.21, 0.22}) ids.push_back(create(false, size));
  ASSERT_TRUE(eventually([&] { return backend.catalogue.meshings() == 2; }));
  ASSERT_TRUE(meshers(2));
  std::stop_source stop;
  auto waiter = wait(ids[0], stop);
  ASSERT_TRUE(backend.reaches(ids[0], MeshState::meshing));
  for (const std::string& id : {ids[2], ids[0], ids[1]}) {
    backend.catalogue.erase(id);
    EXPECT_TRUE(throws([&] { backend.catalogue.get(id); }, Reason::not_found));
  }
  EXPECT_TRUE(throws([&] { waiter.get(); }, Reason::not_found));
  EXPECT_TRUE(meshers(0));
  EXPECT_TRUE(backend.catalogue.list({{}, 10, {}}).empty());
  EXPECT_EQ(create(false, 0.2), ids[0]);
  EXPECT_TRUE(backend.reaches(ids[0], MeshState::meshing));
}

TEST_F(Wanted, IsNotErasedWhileAJobNeedsIt) {
  const std::string id = create(true);
  const std::shared_ptr<void> use = backend.catalogue.use(id);
  EXPECT_TRUE(throws([&] { backend.catalogue.erase(id); }, Reason::in_use));
  EXPECT_TRUE(backend.reaches(id, MeshState::meshing));
}

TEST(WantedAfterARestart, ByItsOwnerAndNotForJobsThatHaveGone) {
  const anticrack::testing::TemporaryFolder folder;
  BackendOptions options;
  options.data_folder = (folder / "data").string();
  options.mesher_hangs = true;
  std::string of_owner, of_job;
  {
    Backend backend(options);
    of_owner = backend.catalogue.create(Backend::definition(0.2), "", "", false).id;
    of_job = backend.catalogue.create(Backend::definition(0.25), "", "", true).id;
  }
  options.mesher_hangs = false;
  Backend backend(options);
  EXPECT_TRUE(backend.reaches(of_owner, MeshState::ready));
  EXPECT_EQ(backend.state(of_job), MeshState::pending);
  EXPECT_NE(backend.prepare(of_job), nullptr);
}

/// Erased at any moment of a real preparation, and made again: nothing stays behind.
TEST(WantedRace, ErasedAtAnyMoment) {
  Backend backend;
  for (int i = 0; i < 40; ++i) {
    const std::string id = backend.create(0.2);
    std::this_thread::sleep_for(std::chrono::milliseconds(5 * (i % 20)));
    std::shared_ptr<void> use = i % 3 == 0 ? backend.catalogue.use(id) : nullptr;
    use.reset();
    backend.catalogue.erase(id);
    EXPECT_TRUE(throws([&] { backend.catalogue.get(id); }, Reason::not_found));
  }
  EXPECT_EQ(backend.store->usage().meshes, 0U);
  const std::string id = backend.create(0.2);
  EXPECT_TRUE(backend.reaches(id, MeshState::ready));
}

TEST(WantedRace, LetGoAtAnyMoment) {
  Backend backend;
  for (int i = 0; i < 30; ++i) {
    const double size = 0.2 + 0.001 * i;
    const std::string id = backend.catalogue.create(Backend::definition(size), "", "", true).id;
    std::shared_ptr<void> use = backend.catalogue.use(id);
    std::this_thread::sleep_for(std::chrono::milliseconds(5 * (i % 20)));
    use.reset();
    EXPECT_TRUE(eventually([&] {
      const MeshState state = backend.state(id);
      return state == MeshState::pending || state == MeshState::ready ||
             state == MeshState::evicted;
    }));
    EXPECT_NE(backend.prepare(id), nullptr);
  }
}

TEST(DiskRefuses, AMeshGoesOnWhenThereIsRoomAgain) {
  const anticrack::testing::TemporaryFolder folder;
  BackendOptions options;
  options.data_folder = (folder / "data").string();
  Backend backend(options);
  const std::filesystem::path meshes = folder / "data/meshes", away = folder / "away";
  std::filesystem::rename(meshes, away);
  const std::string id = backend.create(0.2);
  ASSERT_TRUE(eventually(
      [&] { return backend.catalogue.meshings() >= 1 && backend.catalogue.pending() == 0; }));
  EXPECT_EQ(backend.state(id), MeshState::pending);
  std::filesystem::rename(away, meshes);
  EXPECT_TRUE(backend.reaches(id, MeshState::ready));
}

TEST(DamagedUpload, FailsItsMeshWithTheCause) {
  Backend backend;
  const std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n9";
  for (const bool cut : {false, true}) {
    SCOPED_TRACE(cut);
    const std::string content = text + (cut ? "8" : "7");
    const records::UploadRef upload = backend.upload(content);
    const std::string path = backend.store->upload_path(upload.sha256, "").value();
    if (cut)
      std::filesystem::resize_file(path, content.size() - 3);
    else
      anticrack::testing::flip(path, content.size() - 1);
    const std::string id = backend.catalogue.create(upload, "", "").id;
    ASSERT_TRUE(backend.reaches(id, MeshState::failed));
    const records::MeshRecord record = backend.catalogue.get(id);
    EXPECT_EQ(record.error.value().reason(), Reason::not_found);
    EXPECT_THAT(record.error->what(), ::testing::HasSubstr("is damaged"));
    EXPECT_THAT(record.error->what(), ::testing::HasSubstr("upload it again"));
    backend.upload(content);
    EXPECT_EQ(backend.catalogue.create(upload, "", "").id, id);
    EXPECT_TRUE(eventually([&] {
      const records::MeshRecord now = backend.catalogue.get(id);
      return now.error && now.error->reason() == Reason::mesh_invalid;
    })) << "of its content, which is whole again";
  }
}

TEST(Progress, IsToldWhileAMeshIsMade) {
  Backend backend;
  records::GeometrySource source{anticrack::testing::paper_geometry(), {mesh::Preset::uniform}};
  source.geometry.boundary = {
      {-1, -3e-4}, {1, -3e-4}, {1, 1}, {-1, 1}};  // a thin strip: long in gmsh
  const std::string id = backend.catalogue.create(source, "", "").id;
  std::vector<records::MeshProgress> heard;
  std::stop_source enough;
  EXPECT_TRUE(throws(
      [&] {
        backend.prepare(id, enough.get_token(), [&](const MeshNews& news) {
          if (!news.progress) return;
          EXPECT_EQ(backend.state(id), MeshState::meshing);
          if (heard.empty()) {
            EXPECT_TRUE(backend.catalogue.get(id).progress);
          }
          heard.push_back(*news.progress);
          if (news.progress->triangles > 0) enough.request_stop();
        });
      },
      Reason::cancelled));
  ASSERT_FALSE(heard.empty());
  EXPECT_FALSE(heard.back().doing.empty());
  EXPECT_GT(heard.back().triangles, 0U);
  backend.catalogue.erase(id);
}

}  // namespace
}  // namespace anticrack::meshes
