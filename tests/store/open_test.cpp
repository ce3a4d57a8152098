// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/stat.h>

#include "store/store_fixture.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::throws;
using errors::Reason;

class OpenStore : public StoreTest {};
class StoreBudget : public StoreTest {};

TEST_F(OpenStore, MakesAFolderForItsOwnerAlone) {
  const std::string path = (folder / "deep/er").string();
  open({path, 0})->put(mesh_record("m"));
  for (const char* name : {"", "/meshes", "/results", "/uploads"}) {
    struct stat status {};
    ASSERT_EQ(::stat((path + name).c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0700U) << name;
  }
  EXPECT_TRUE(open({path, 0})->mesh("m"));
}

TEST_F(OpenStore, RefusesWhatIsNoFolder) {
  std::ofstream(folder / "file") << "x";
  EXPECT_TRUE(throws([&] { open({(folder / "file").string(), 0}); }, Reason::storage));
}

TEST_F(OpenStore, RemovesWhatNothingRefersTo) {
  const mesh::Mesh mesh = strip(3);
  const records::MeshRecord record = meshed_record("m", mesh);
  store->put(record, mesh);
  end("j", block(1, many));
  const std::string hash = upload("text");
  const std::string stranger(64, 'a');
  for (const char* name : {"meshes", "results", "uploads"}) {
    std::ofstream(folder / (std::string(name) + "/part-abcdef")) << "x";
    std::ofstream(folder / (std::string(name) + "/" + stranger)) << "x";
  }
  const Usage before = store->usage();
  reopen();
  for (const char* name : {"meshes", "results", "uploads"}) EXPECT_EQ(files(name), 1U) << name;
  EXPECT_NE(store->triangulation(record.sha256), nullptr);
  EXPECT_NE(store->result("j"), nullptr);
  EXPECT_TRUE(store->upload_path(hash, ""));
  EXPECT_EQ(store->usage().meshes, before.meshes);
  EXPECT_EQ(store->usage().results, before.results);
  EXPECT_EQ(store->usage().uploads, before.uploads);
  EXPECT_GT(store->usage().database, 0U);
  EXPECT_EQ(store->usage().total(), store->usage().meshes + store->usage().results +
                                        store->usage().uploads + store->usage().database);
}

TEST_F(OpenStore, RefusesADamagedDatabase) {
  for (int i = 0; i < 200; ++i) create("job " + std::to_string(i));
  store.reset();
  const auto path = folder / "anticrack.db";
  const auto size = std::filesystem::file_size(path);
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    for (std::streamoff page = 1; page < static_cast<std::streamoff>(size / 4096); ++page) {
      file.seekp(page * 4096);
      file << std::string(600, '\xff');
    }
  }
  const auto error = error_of([&] { open({folder.path(), 0}); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::storage);
  EXPECT_THAT(error->what(), ::testing::HasSubstr("backup"));
}

TEST_F(OpenStore, RefusesWhatIsNoDatabase) {
  store.reset();
  std::ofstream(folder / "anticrack.db") << std::string(10000, 'x');
  const auto error = error_of([&] { open({folder.path(), 0}); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::storage);
  EXPECT_THAT(error->what(), ::testing::HasSubstr("backup"));
}

TEST_F(StoreBudget, RefusesFilesThatDoNotFit) {
  reopen(store->usage().total() + 200'000);
  create("small");
  create("large");
  store->finish(ended_record("small"), block(1, many));
  const auto large = block(2, 50'000);
  const auto refused = error_of([&] { store->finish(ended_record("large"), large); });
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->reason(), Reason::disk_full);
  EXPECT_EQ(refused->retry_delay(), std::chrono::seconds(5));
  EXPECT_EQ(store->job("large")->state, records::JobState::queued);
  EXPECT_EQ(files("results"), 1U);
  EXPECT_TRUE(throws([&] { store->new_upload_path(400'000); }, Reason::disk_full));
  const mesh::Mesh mesh = strip(5000);
  EXPECT_TRUE(throws([&] { store->put(meshed_record("m", mesh), mesh); }, Reason::disk_full));
  EXPECT_FALSE(store->mesh("m"));
  create("another");  // a record is small, and the refusal must be kept somewhere
}

TEST_F(StoreBudget, CountsUploadsThatAreOnTheirWay) {
  reopen(store->usage().total() + 200'000);
  const std::string part = store->new_upload_path(80'000);
  EXPECT_TRUE(throws([&] { store->new_upload_path(180'000); }, Reason::disk_full));
  std::filesystem::remove(part);  // given up
  store->new_upload_path(180'000);
}

TEST_F(StoreBudget, HasRoomAgainWhenResultsExpire) {
  reopen(store->usage().total() + 600'000);
  end("a", block(1, 40'000));
  create("b");
  EXPECT_TRUE(
      throws([&] { store->finish(ended_record("b"), block(2, 40'000)); }, Reason::disk_full));
  store->expire("a", records::Clock::time_point(std::chrono::seconds(9)));
  store->finish(ended_record("b"), block(2, 40'000));
  EXPECT_EQ(values(*store->result("b")).size(), 40'000U);
}

}  // namespace
}  // namespace anticrack::store
