// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is said of databases that cannot be used, and where PostgreSQL's store differs.
#include "store/contract_fixture.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::throws;
using errors::Reason;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class GroupStore : public StoreTest {
 protected:
  GroupStore() : StoreTest(fresh_database()) {}
  std::string refused(const std::string& address) const {
    const auto error = error_of([&] { open_any({folder.path(), 0, address}); });
    return error ? error->what() : "";
  }
};

TEST_F(GroupStore, SaysWhyItDoesNotStart) {
  const std::string host = url.substr(url.find("?host="));
  EXPECT_THAT(refused("postgresql://test@/nowhere" + host), HasSubstr("createdb"));
  EXPECT_THAT(refused("postgresql://eve@/postgres" + host), HasSubstr("pg_hba.conf"));
  EXPECT_THAT(refused("postgresql://test:secret@/x?host=" + folder.path()),
              AllOf(HasSubstr("check that it runs"), Not(HasSubstr("secret"))));
  ask(url, "UPDATE tables SET version = 9, oldest = 9");
  EXPECT_THAT(refused(url), HasSubstr("newer anticrack"));
}

TEST_F(GroupStore, HasEverythingInTheDatabase) {
  const std::string hash = upload("$MeshFormat", "ann");
  const mesh::Mesh mesh = strip(4);
  store->put(meshed_record("m", mesh), mesh);
  end("j", block(1, many));
  store.reset();
  const anticrack::testing::TemporaryFolder other;
  store = open_any({other.path(), 0, url});
  EXPECT_EQ(values(*store->result("j")), std::vector<double>(many, 1.0));
  EXPECT_NE(store->triangulation(meshed_record("m", mesh).sha256), nullptr);
  const auto path = store->upload_path(hash, "ann");
  ASSERT_TRUE(path);
  require_intact_upload(*path, hash);
}

TEST_F(GroupStore, DropsCopiesOfUploadsThatAnotherServerErased) {
  const std::string hash = upload("$MeshFormat", "ann");
  ASSERT_EQ(files("uploads"), 1U);
  const anticrack::testing::TemporaryFolder other;
  open_any({other.path(), 0, url})->erase_upload(hash, "ann");
  EXPECT_EQ(store->expire_uploads(records::Clock::time_point{}), 0U);
  EXPECT_EQ(files("uploads"), 0U);
}

/// More than one piece, and no whole number of them.
TEST_F(GroupStore, ReadsALargeResultPieceByPiece) {
  std::vector<double> written(300'001);
  for (std::size_t i = 0; i < written.size(); ++i) written[i] = static_cast<double>(i);
  records::BlockBuilder builder;
  builder.add("u", written);
  end("j", records::in_memory(std::make_shared<const records::Block>(builder.finish())));
  EXPECT_EQ(ask(url, "SELECT count(*) FROM pieces").integer(0, 0), 3);
  const auto held = store->result("j");
  EXPECT_EQ(values(*held), written);
  const auto late = store->result("j");
  store->erase_job("j");
  EXPECT_TRUE(throws([&] { values(*late); }, Reason::result_expired));
}

TEST_F(GroupStore, SaysWhenAResultIsDamagedOrLost) {
  const auto damaged = [&](const std::string& sql) {
    end(sql, block(1, many));
    ask(url, sql);
    EXPECT_TRUE(throws([&] { store->result(sql); }, Reason::storage)) << sql;
    EXPECT_TRUE(store->job(sql));
    store->erase_job(sql);
  };
  damaged("UPDATE pieces SET body = substr(body, 1, length(body) - 1)");
  damaged("UPDATE pieces SET body = substr(body, 1, 10)");
  damaged("UPDATE pieces SET body = set_byte(body, 1000, get_byte(body, 1000) # 1)");
  damaged("DELETE FROM pieces");
  damaged("UPDATE jobs SET result = NULL");
}

TEST_F(GroupStore, RefusesADamagedRecordAndNoOther) {
  create("a", "ann");
  create("b", "ann");
  ask(url, "UPDATE jobs SET record = set_byte(record, 2, get_byte(record, 2) # 1) WHERE id = 'a'");
  EXPECT_EQ(store->job("a")->state, records::JobState::failed);
  EXPECT_THAT(store->job("a")->error->what(), HasSubstr("jobs/a"));
  EXPECT_EQ(store->job("a")->owner, "ann");
  EXPECT_EQ(store->job("b")->state, records::JobState::queued);
  EXPECT_EQ(store->unfinished().size(), 1U);
}

TEST_F(GroupStore, TellsHowLongTheDatabaseIsGone) {
  EXPECT_EQ(store->unreachable().count(), 0);
  anticrack::testing::shared_database().stop();
  EXPECT_TRUE(throws([&] { store->queue()->beat({}); }, Reason::storage));
  EXPECT_GT(store->unreachable().count(), 0);
  anticrack::testing::shared_database().start();
  store->queue()->beat({});
  EXPECT_EQ(store->unreachable().count(), 0);
}

/// Which a start would empty.
TEST_F(GroupStore, RefusesAFolderThatIsAStore) {
  const anticrack::testing::TemporaryFolder other;
  open({other.path(), 0})->put(mesh_record("m"));
  const auto error = error_of([&] { open_any({other.path(), 0, url}); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr("--data-dir"));
  EXPECT_TRUE(open({other.path(), 0})->mesh("m"));
}

}  // namespace
}  // namespace anticrack::store
