// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whose files are in a folder: nothing is removed for a database that is not theirs.
#include "store/sqlite.hpp"
#include "store/store_fixture.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::TemporaryFolder;
using errors::Reason;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Identity : public StoreTest {
 protected:
  /// A mesh, a result and an upload.
  void fill() {
    store->put(meshed_record("m", strip(3)), strip(3));
    end("j", block(1, many));
    upload("text");
  }

  void remove_database() {
    store.reset();
    for (const char* name : {"anticrack.db", "anticrack.db-wal", "anticrack.db-shm"}) {
      std::filesystem::remove(folder / name);
    }
  }

  /// Opening says that the database `is` so, and the cure; all files are there still.
  void expect_refused(const std::string& is) {
    std::vector<std::size_t> before;
    for (const char* name : folders) before.push_back(files(name));
    const auto error = error_of([&] { open({folder.path(), 0}); });
    ASSERT_TRUE(error) << is;
    EXPECT_EQ(error->reason(), Reason::storage);
    EXPECT_THAT(error->what(), AllOf(HasSubstr(folder.path()), HasSubstr(is), HasSubstr("backup"),
                                     HasSubstr("move the folder away")));
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(files(folders[i]), before[i]);
  }

  void expect_whole() {
    store = open({folder.path(), 0});
    EXPECT_EQ(files("meshes"), 1U);
    EXPECT_EQ(values(*store->result("j")), std::vector<double>(many, 1.0));
    EXPECT_EQ(files("uploads"), 1U);
  }

  /// Of a version whose databases had no identity.
  void make_older() {
    store.reset();
    Connection database((folder / "anticrack.db").string());
    database.execute("DROP TABLE store; PRAGMA user_version = 2");
    std::filesystem::remove(folder / "identity");
  }

  static constexpr const char* folders[] = {"meshes", "results", "uploads"};
};

TEST_F(Identity, RefusesFilesWithoutTheirDatabase) {
  fill();
  store.reset();
  std::filesystem::copy(folder / "anticrack.db", folder / "backup.db");
  remove_database();
  expect_refused("(meshes: 1, results: 1, uploads: 1)");
  expect_refused("is missing");
  EXPECT_FALSE(std::filesystem::exists(folder / "anticrack.db")) << "it was made anew";
  std::filesystem::rename(folder / "backup.db", folder / "anticrack.db");
  expect_whole();
}

TEST_F(Identity, RefusesFilesWithAnEmptyDatabase) {
  fill();
  remove_database();
  std::ofstream(folder / "anticrack.db").flush();
  expect_refused("is empty");
  Connection((folder / "anticrack.db").string()).execute("PRAGMA journal_mode = WAL");
  ASSERT_GT(std::filesystem::file_size(folder / "anticrack.db"), 0U);
  expect_refused("is empty");
}

TEST_F(Identity, RefusesTheDatabaseOfAnotherFolder) {
  fill();
  remove_database();
  const TemporaryFolder other;
  open({other.path(), 0})->put(meshed_record("m", strip(3)), strip(3));
  std::filesystem::copy(other / "anticrack.db", folder / "anticrack.db");
  expect_refused("another store's");
}

TEST_F(Identity, RefusesToForgetRecordsThatHadNoFiles) {
  create("j");
  remove_database();
  expect_refused("is missing");
}

TEST_F(Identity, LeavesAFolderOfAnOlderVersionAsItIs) {
  fill();
  make_older();
  const auto error = error_of([&] { open({folder.path(), 0}); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr("version 2"));
  for (const char* name : folders) EXPECT_EQ(files(name), 1U) << name;
  EXPECT_FALSE(std::filesystem::exists(folder / "identity"));
}

TEST_F(Identity, RefusesADatabaseThatNamesNoneOfTheFilesWhereTheFolderHasNoIdentity) {
  create("j");
  store.reset();
  std::filesystem::remove(folder / "identity");
  std::ofstream(folder / ("results/" + std::string(64, 'a'))) << "x";
  expect_refused("refers to none of them");
}

TEST_F(Identity, TakesADatabaseWithoutTheFoldersFileWhereItNamesTheFiles) {
  fill();
  store.reset();
  std::filesystem::remove(folder / "identity");  // not in the backup
  expect_whole();
  EXPECT_TRUE(std::filesystem::exists(folder / "identity"));
}

TEST_F(Identity, GoesOnWhereTheFirstStartWasCutShort) {
  remove_database();
  std::filesystem::remove(folder / "identity");
  std::ofstream(folder / "anticrack.db").flush();
  store = open({folder.path(), 0});
  create("j");
  store.reset();
  std::filesystem::remove(folder / "identity");
  EXPECT_TRUE(open({folder.path(), 0})->job("j"));
}

}  // namespace
}  // namespace anticrack::store
