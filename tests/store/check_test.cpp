// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/check.hpp"

#include <map>

#include "store/files.hpp"
#include "store/operations.hpp"
#include "store/sqlite.hpp"
#include "store/store_fixture.hpp"
#include "support/flip.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::content_of;
using anticrack::testing::error_of;
using anticrack::testing::flip;
using anticrack::testing::places_of;
using errors::Reason;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class StoreCheck : public StoreTest {
 protected:
  /// Two of each, and a job with a small result.
  void fill() {
    for (const int i : {1, 2}) {
      const std::string id = std::to_string(i);
      store->put(meshed_record("m" + id, strip(i)), strip(i));
      end("j" + id, block(i, many));
      texts.push_back(upload("text" + id));
    }
    end("small", block(3));
    store.reset();
  }

  std::string database() const { return (folder / "anticrack.db").string(); }
  std::string file(const std::string& kind, const std::string& name) const {
    return (folder / (kind + "/" + name)).string();
  }
  std::string text(const std::string& sql) const {
    Connection connection(database());
    Statement select = connection.prepare(sql);
    return select.step() ? select.text(0) : std::string();
  }
  /// Flips a byte of the result's name in the row of a job, or in the index of it.
  void flip_result_of(const std::string& job, bool in_row) {
    const std::string name = text("SELECT result FROM jobs WHERE id = '" + job + "'");
    for (const std::size_t place : places_of(name, database())) {
      flip(database(), place);
      const bool row = text("SELECT 1 FROM jobs NOT INDEXED WHERE result = '" + name + "'").empty();
      if (row == in_row) return;
      flip(database(), place);
    }
    FAIL() << name << " is not there";
  }
  /// Of all but the database's log, which SQLite may write and take away as it reads.
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
      const std::string path = entry.path().string();
      if (entry.is_regular_file() && path.find(".db-") == std::string::npos) {
        found[path] = content_of(path);
      }
    }
    return found;
  }

  /// A check finds this and changes nothing; a repair sets aside so many files, and then all is
  /// sound and can be opened.
  void expect_repaired(const std::string& flaw, std::size_t files_aside) {
    SCOPED_TRACE(flaw);
    const auto before = contents();
    const CheckedStore found = store::check(folder.path());
    EXPECT_THAT(found.flaws, Contains(HasSubstr(flaw)));
    EXPECT_EQ(contents(), before);
    aside = repair(folder.path(), found);
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(aside)) {
      count +=
          entry.is_regular_file() && digest::is_sha256(entry.path().filename().string()) ? 1U : 0U;
    }
    EXPECT_EQ(count, files_aside);
    EXPECT_THAT(store::check(folder.path()).flaws, IsEmpty());
    store = open({folder.path(), 0});
  }

  std::vector<std::string> texts;
  std::string aside;
};

TEST_F(StoreCheck, FindsNothingInASoundStore) {
  for (const Operation& operation : operations()) {
    operation(*store);
    EXPECT_THAT(store::check(folder.path()).flaws, IsEmpty());
  }
  store.reset();
  const CheckedStore found = store::check(folder.path());
  EXPECT_GT(found.records, 3U);
  EXPECT_GT(found.files, 0U);
}

TEST_F(StoreCheck, FindsNothingInAnEmptyFolder) {
  store.reset();
  const anticrack::testing::TemporaryFolder empty;
  EXPECT_THAT(store::check(empty.path()).flaws, IsEmpty());
}

TEST_F(StoreCheck, TakesADamagedRecordOutWithItsFile) {
  fill();
  Connection(database()).execute("UPDATE jobs SET owner = 'x' WHERE id = 'j1'");
  expect_repaired("jobs/j1: its record", 1);
  EXPECT_THAT(jobs({"", 9, {}}), ElementsAre("small", "j2"));
  EXPECT_EQ(values(*store->result("j2")), std::vector<double>(many, 2.0));
  EXPECT_EQ(values(*store->result("small")), std::vector<double>(5, 3.0));
  EXPECT_THAT(meshes({"", 9, {}}), ElementsAre("m2", "m1"));
  EXPECT_EQ(Connection(aside + "/anticrack.db").integer("SELECT count(*) FROM jobs"), 3);
}

TEST_F(StoreCheck, TakesADamagedRowOutThatDoesNotAgreeWithItsIndex) {
  fill();
  flip_result_of("j1", true);
  expect_repaired("jobs/j1: its record", 1);
  EXPECT_THAT(jobs({"", 9, {}}), ElementsAre("small", "j2"));
}

TEST_F(StoreCheck, CuresADamagedIndex) {
  fill();
  flip_result_of("j1", false);
  expect_repaired("index", 0);
  EXPECT_EQ(jobs({"", 9, {}}).size(), 3U);
}

TEST_F(StoreCheck, TakesDamagedFilesOutWithTheirRecords) {
  fill();
  flip(file("meshes", text("SELECT sha256 FROM meshes WHERE id = 'm1'")), 30);
  const std::string result = file("results", text("SELECT result FROM jobs WHERE id = 'j1'"));
  flip(result, std::filesystem::file_size(result) - 5);
  flip(file("uploads", texts[0]), 1);
  expect_repaired("results/" + std::filesystem::path(result).filename().string() + " is damaged",
                  3);
  EXPECT_THAT(jobs({"", 9, {}}), ElementsAre("small", "j2"));
  EXPECT_THAT(meshes({"", 9, {}}), ElementsAre("m2"));
  EXPECT_FALSE(store->upload_path(texts[0], ""));
  EXPECT_TRUE(store->upload_path(texts[1], ""));
}

TEST_F(StoreCheck, TakesRecordsOutWhoseFilesAreGone) {
  fill();
  std::filesystem::remove(file("results", text("SELECT result FROM jobs WHERE id = 'j2'")));
  std::filesystem::remove(file("uploads", texts[1]));
  expect_repaired("of jobs/j2 is missing", 0);
  EXPECT_THAT(jobs({"", 9, {}}), ElementsAre("small", "j1"));
  EXPECT_FALSE(store->upload_path(texts[1], ""));
}

TEST_F(StoreCheck, SeesADamagedSmallResult) {
  fill();
  Connection(database()).execute("UPDATE jobs SET small_result = NULL WHERE id = 'small'");
  expect_repaired("the row of jobs/small", 0);
  EXPECT_THAT(jobs({"", 9, {}}), ElementsAre("j2", "j1"));
}

TEST_F(StoreCheck, SetsAsideWhatNoRecordNames) {
  fill();
  std::ofstream(file("results", std::string(64, 'a'))) << "x";
  expect_repaired(std::string(64, 'a') + " belongs to no record", 1);
  EXPECT_EQ(jobs({"", 9, {}}).size(), 3U);
}

TEST_F(StoreCheck, SetsEverythingAsideWhereThereIsNoDatabase) {
  fill();
  std::filesystem::remove(database());
  expect_repaired("is missing", 6);
  EXPECT_THAT(jobs({"", 9, {}}), IsEmpty());
  end("new", block(1, many));
}

TEST_F(StoreCheck, SetsAsideWhatIsNoDatabase) {
  fill();
  std::ofstream(database()) << std::string(10'000, 'x');
  expect_repaired("damaged", 6);
  EXPECT_EQ(content_of(aside + "/anticrack.db"), std::string(10'000, 'x'));
}

TEST_F(StoreCheck, TakesTheDatabaseOfAnotherFolder) {
  fill();
  const anticrack::testing::TemporaryFolder other;
  open({other.path(), 0})->create(job_record("theirs"), "");
  std::filesystem::copy_file(other / "anticrack.db", database(),
                             std::filesystem::copy_options::overwrite_existing);
  expect_repaired("another store's", 6);
  EXPECT_THAT(jobs({"", 9, {}}), ElementsAre("theirs"));
}

TEST_F(StoreCheck, RefusesToRepairADatabaseDamagedBeyondItsRecords) {
  for (int i = 0; i < 200; ++i) create("job " + std::to_string(i));
  fill();
  for (std::size_t page = 1; page < std::filesystem::file_size(database()) / 4096; ++page) {
    flip(database(), page * 4096, 600);
  }
  const auto before = contents();
  const CheckedStore found = store::check(folder.path());
  EXPECT_FALSE(found.flaws.empty());
  const auto error = error_of([&] { repair(folder.path(), found); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr(".recover"));
  EXPECT_EQ(contents(), before);
}

TEST_F(StoreCheck, IsOfItsVersionOnly) {
  fill();
  Connection(database()).execute("PRAGMA user_version = 2");
  EXPECT_THAT(error_of([&] { store::check(folder.path()); }).value().what(), HasSubstr("older"));
  Connection(database()).execute("PRAGMA user_version = 99");
  EXPECT_THAT(error_of([&] { store::check(folder.path()); }).value().what(), HasSubstr("newer"));
}

}  // namespace
}  // namespace anticrack::store
