// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bytes that have changed on the disk: what they belong to is refused by name, all else is served.
#include "store/files.hpp"
#include "store/operations.hpp"
#include "store/record_fields.hpp"
#include "store/rows.hpp"
#include "store/store_fixture.hpp"
#include "support/flip.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::flip;
using anticrack::testing::Listing;
using anticrack::testing::places_of;
using anticrack::testing::throws;
using errors::Reason;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Damage : public StoreTest {
 protected:
  std::string database() const { return (folder / "anticrack.db").string(); }
  void change(const std::string& sql) {
    store.reset();
    Connection(database()).execute(sql);
    reopen();
  }
  template <class Record>
  static void expect_refused(const Record& record, const std::string& name) {
    EXPECT_EQ(record.state, decltype(record.state)::failed) << name;
    ASSERT_TRUE(record.error) << name;
    EXPECT_EQ(record.error->reason(), Reason::storage);
    EXPECT_THAT(record.error->what(),
                AllOf(HasSubstr(name), HasSubstr("damaged"), HasSubstr("backup")));
  }
  std::string only_file(const std::string& kind) const {
    for (const auto& entry : std::filesystem::directory_iterator(folder / kind)) {
      return entry.path().string();
    }
    return {};
  }
};

TEST_F(Damage, OfAJobRefusesThatJobAndNoOther) {
  for (const std::string id : {"a", "b", "c"}) {
    records::JobRecord record = job_record(id, "ann");
    record.spec.title = "the title of " + id;
    store->create(record, "");
  }
  const std::string first = Listing::of(*store->job("a"));
  store.reset();
  const auto places = places_of("the title of b", database());
  ASSERT_EQ(places.size(), 1U);
  flip(database(), places[0], 20);
  reopen();
  expect_refused(*store->job("b"), "jobs/b");
  EXPECT_EQ(store->job("b")->owner, "ann");
  EXPECT_EQ(store->job("b")->spec.title, "");
  EXPECT_EQ(Listing::of(*store->job("a")), first);
  EXPECT_THAT(jobs({"", 9, {}}), ElementsAre("c", "b", "a"));
  EXPECT_THAT(jobs({"", 2, "ann"}), ElementsAre("c", "b"));
  expect_refused(store->jobs({"", 9, {}})[1], "jobs/b");
  const auto unfinished = store->unfinished();
  ASSERT_EQ(unfinished.size(), 2U);
  EXPECT_EQ(unfinished[1].id, "c");
  EXPECT_TRUE(throws([&] { store->result("b"); }, Reason::storage));
  EXPECT_TRUE(
      throws([&] { store->expire("b", records::Clock::time_point(std::chrono::seconds(9))); },
             Reason::storage));
  store->erase_job("b");
  EXPECT_FALSE(store->job("b"));
}

TEST_F(Damage, OfAnyColumnOfAJobIsSeen) {
  for (const std::string change_of : {"fingerprint = 'x'", "ended = 5", "result_bytes = 7",
                                      "result = 'x'", "record = x'0a0161'", "request = 'x'"}) {
    end("j", block(1));
    EXPECT_EQ(store->job("j")->state, records::JobState::succeeded);
    change("UPDATE jobs SET " + change_of);
    expect_refused(*store->job("j"), "jobs/j");
    store->erase_job("j");
  }
}

TEST_F(Damage, OfAMeshRefusesThatMeshUntilItIsMadeAgain) {
  const records::MeshRecord record = meshed_record("m", strip(3));
  for (const std::string change_of : {"sha256 = 'x'", "upload = 'x'", "record = x'0a0161'"}) {
    store->put(record, strip(3));
    store->put(mesh_record("other"));
    change("UPDATE meshes SET " + change_of + " WHERE id = 'm'");
    expect_refused(*store->mesh("m"), "meshes/m");
    EXPECT_THAT(meshes({"", 9, {}}), ElementsAre("other", "m"));
    EXPECT_EQ(store->mesh("other")->state, records::MeshState::pending);
    store->put(record, strip(3));
    EXPECT_EQ(store->mesh("m")->sha256, record.sha256);
  }
}

TEST_F(Damage, OfARequestIsToldToWhoAsksAgain) {
  create("j", "ann", "request", "print");
  change("UPDATE jobs SET fingerprint = 'other'");
  expect_refused(create("k", "ann", "request", "print"), "jobs/j");
}

TEST_F(Damage, OfARowRemovesNoFile) {
  end("j", block(1, many));
  upload("text");
  change("UPDATE jobs SET result = '" + std::string(64, 'a') + "'");
  EXPECT_EQ(files("results"), 1U);
  change("UPDATE uploads SET sha256 = '" + std::string(64, 'a') + "'");
  EXPECT_EQ(files("uploads"), 1U);
  EXPECT_EQ(store->expire_uploads(records::Clock::time_point::max()), 0U);
  EXPECT_EQ(files("results"), 1U);
}

TEST_F(Damage, OfAnIndexRemovesNoFile) {
  end("j", block(1, many));
  const std::string name = std::filesystem::path(only_file("results")).filename().string();
  store.reset();
  for (const std::size_t place : places_of(name, database())) {
    flip(database(), place);
    Connection connection(database());
    const bool row = !is_referenced(connection, FileKind::result, name, true);
    const bool index = !is_referenced(connection, FileKind::result, name);
    EXPECT_NE(row, index);
    open({folder.path(), 0});
    EXPECT_EQ(files("results"), 1U) << (row ? "row" : "index");
    flip(database(), place);
  }
  reopen();
  EXPECT_EQ(values(*store->result("j")), std::vector<double>(many, 1.0));
}

TEST_F(Damage, OfASmallResultIsSeen) {
  end("j", block(1));
  store.reset();
  const double value = 1;
  const std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
  const auto places = places_of(bytes, database());
  ASSERT_FALSE(places.empty());
  flip(database(), places.back());
  reopen();
  EXPECT_TRUE(throws([&] { store->result("j"); }, Reason::storage));
  change("UPDATE jobs SET small_result = NULL");
  EXPECT_TRUE(throws([&] { store->result("j"); }, Reason::storage));
  EXPECT_EQ(store->job("j")->state, records::JobState::succeeded);
}

TEST_F(Damage, OfAResultsNameIsSeen) {
  end("j", block(1, many));
  const std::filesystem::path first = only_file("results");
  std::filesystem::rename(first, folder / "first");
  end("k", block(2, many));
  std::filesystem::rename(only_file("results"), first);
  EXPECT_TRUE(throws([&] { store->result("j"); }, Reason::storage));
}

TEST_F(Damage, OfAnUploadIsCuredByAnother) {
  const std::string hash = upload("text", "ann");
  change("UPDATE uploads SET created = 5");
  EXPECT_TRUE(throws([&] { store->upload_path(hash, "ann"); }, Reason::storage));
  upload("text", "ann");
  const std::string path = store->upload_path(hash, "ann").value();
  EXPECT_NO_THROW(require_intact_upload(path, hash));
  flip(path, 2);
  EXPECT_TRUE(throws([&] { require_intact_upload(path, hash); }, Reason::storage));
  upload("text", "ann");
  EXPECT_NO_THROW(require_intact_upload(path, hash));
  EXPECT_EQ(store->usage().uploads, 4U);
  EXPECT_EQ(files("uploads"), 1U);
  std::filesystem::remove(path);
  EXPECT_TRUE(throws([&] { require_intact_upload(path, hash); }, Reason::storage));
}

TEST_F(Damage, IsNotWhatTheStoreWrites) {
  for (const Operation& operation : operations()) {
    operation(*store);
    Connection connection(database());
    ASSERT_TRUE(all_intact(connection));
  }
}

}  // namespace
}  // namespace anticrack::store
