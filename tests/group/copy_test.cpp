// SPDX-License-Identifier: GPL-3.0-or-later
//
// A data folder moves to PostgreSQL whole or not at all, and a check finds what is damaged there.
#include "group/copy.hpp"

#include <map>
#include <thread>

#include "group/check.hpp"
#include "group/store.hpp"
#include "store/contract_fixture.hpp"
#include "store/record_codec.hpp"
#include "store/records.pb.h"
#include "support/flip.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::error_of;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class GroupCopy : public StoreTest {
 protected:
  /// Two of each kind and owner; small and large results, one that expired; jobs that wait and run.
  void SetUp() override {
    for (const int i : {1, 2}) {
      const std::string id = std::to_string(i);
      store->put(meshed_record("m" + id, strip(i)), strip(i));
      end("large" + id, block(i, many), i);
      end("small" + id, block(i), i);
      uploads.push_back(upload("$MeshFormat" + id, "ann\xc3\xa9"));
    }
    upload("$MeshFormat1", "ben");
    store->put(mesh_record("undone", "ben"));
    store->expire("small2", records::Clock::time_point(std::chrono::seconds(5)));
    end("large3", block(1, many), 3);  // shares its result
    create("waits1", "ann", "request", "fingerprint");
    create("waits2", "ann");
    records::JobRecord running = store->create(job_record("runs", "ben"), "");
    running.state = records::JobState::running;
    running.attempt = 3;
    running.crashes = 1;
    store->put(running);
    store.reset();
  }

  void copy() {
    group::copy(folder.path(), pool, [](std::size_t, std::uint64_t) {});
  }
  std::vector<std::string> flaws() { return group::check(pool).flaws; }
  std::unique_ptr<Store> opened() {
    return std::make_unique<group::Store>(StoreOptions{other.path(), 0, database});
  }

  const std::string database = fresh_database();
  postgres::Pool pool{postgres::Settings{postgres::Address(database), "test"}};
  anticrack::testing::TemporaryFolder other;
  std::vector<std::string> uploads;
};

TEST_F(GroupCopy, HasAllThatWasThere) {
  group::require_empty(pool);
  EXPECT_EQ(ask(database, "SELECT 1 WHERE to_regclass('anticrack.jobs') IS NULL").rows(), 1U)
      << "who only asks changes nothing";
  const CheckedStore source = check(folder.path());
  ASSERT_THAT(source.flaws, IsEmpty());
  copy();
  const CheckedStore there = group::check(pool);
  EXPECT_EQ(there.records, source.records);
  EXPECT_EQ(there.files, source.files + 1) << "a small result is in its row";
  EXPECT_THAT(flaws(), IsEmpty());

  const std::unique_ptr<Store> before = open({folder.path()}), after = opened();
  const Page all{{}, 100, {}};
  const auto texts = [](const auto& records) {
    std::vector<std::string> bytes;
    for (const auto& record : records) bytes.push_back(encode(record));
    return bytes;
  };
  EXPECT_EQ(texts(after->jobs(all)), texts(before->jobs(all)));
  EXPECT_EQ(texts(after->meshes(all)), texts(before->meshes(all)));
  EXPECT_EQ(after->ended().size(), before->ended().size());
  for (const records::JobRecord& job : before->jobs(all)) {
    const auto was = before->result(job.id), is = after->result(job.id);
    ASSERT_EQ(was == nullptr, is == nullptr) << job.id;
    EXPECT_TRUE(was == nullptr || values(*is) == values(*was)) << job.id;
  }
  for (const records::MeshRecord& mesh : before->meshes(all))
    EXPECT_EQ(before->triangulation(mesh.sha256) == nullptr,
              after->triangulation(mesh.sha256) == nullptr);
  for (const char* owner : {"ann\xc3\xa9", "ben"}) {
    const auto was = before->uploads(owner, "", 10), is = after->uploads(owner, "", 10);
    ASSERT_EQ(is.size(), was.size());
    for (std::size_t i = 0; i < was.size(); ++i) {
      EXPECT_EQ(std::tuple(is[i].id, is[i].created, is[i].bytes, is[i].array),
                std::tuple(was[i].id, was[i].created, was[i].bytes, was[i].array));
      require_intact_upload(*after->upload_path(is[i].id, owner), is[i].id);
    }
  }
  EXPECT_EQ(after->created_before("ann", "request", "fingerprint")->id, "waits1");
}

TEST_F(GroupCopy, GoesOnWithWhatHadNotEnded) {
  copy();
  const std::unique_ptr<Store> store = opened();
  std::this_thread::sleep_for(std::chrono::milliseconds(250));  // for servers that hold the meshes
  std::map<std::string, std::pair<int, int>> attempts;
  for (const Queue::Claim& claim : store->queue()->claim(10, {}, {}))
    attempts[claim.record.id] = {claim.record.attempt, claim.record.crashes};
  EXPECT_EQ(attempts, (std::map<std::string, std::pair<int, int>>{
                          {"waits1", {1, 0}}, {"waits2", {1, 0}}, {"runs", {4, 1}}}));
}

TEST_F(GroupCopy, IsAllOrNothing) {
  // Another byte, after the folder was found sound: what is read again from the database differs.
  const std::string file = folder_of(folder.path(), FileKind::upload) + "/" + uploads.front();
  anticrack::testing::flip(file, 0);
  EXPECT_THAT(error_of([&] { copy(); })->what(), HasSubstr(uploads.front()));
  EXPECT_EQ(ask(database, "SELECT FROM jobs UNION ALL SELECT FROM blobs").rows(), 0U);
  anticrack::testing::flip(file, 0);
  std::filesystem::rename(file, file + "x");
  EXPECT_THAT(error_of([&] { copy(); })->what(), HasSubstr("is missing"));
  EXPECT_EQ(ask(database, "SELECT FROM jobs UNION ALL SELECT FROM blobs").rows(), 0U);
  std::filesystem::rename(file + "x", file);
  copy();
  EXPECT_THAT(flaws(), IsEmpty());
}

TEST_F(GroupCopy, RefusesADatabaseThatHasRecords) {
  copy();
  EXPECT_THAT(error_of([&] { copy(); })->what(), HasSubstr("give an empty one"));
  EXPECT_THAT(error_of([&] { group::require_empty(pool); })->what(), HasSubstr("an empty one"));
}

TEST_F(GroupCopy, ChecksFindEachDamage) {
  copy();
  disk::SolvedPortion portion;
  for (const int rows : {3, 1}) portion.add_chunks()->mutable_answer()->set_converged(rows);
  postgres::query(
      pool,
      "INSERT INTO portions SELECT 'runs', n, 4 * n, least(4, 10 - 4 * n), NULL, CASE n "
      "WHEN 1 THEN $1::bytea END FROM generate_series(0, 2) n",
      {postgres::Value::bytes(portion.SerializeAsString())});
  disk::PositionRequest request;
  for (const double t : {1.0, 0.5}) request.add_loads(t);
  disk::SolvedPosition position;
  for (int i = 0; i < request.loads_size(); ++i) position.add_energy()->set_upper(1);
  postgres::query(pool, "INSERT INTO portions VALUES ('waits1', 5, 5, 1, NULL, $1, $2)",
                  {postgres::Value::bytes(position.SerializeAsString()),
                   postgres::Value::bytes(request.SerializeAsString())});
  ASSERT_THAT(flaws(), IsEmpty());
  const std::string some = "(SELECT min(sha256) FROM blobs WHERE kind = ";
  std::vector<std::string> damages{
      "UPDATE meshes SET checksum = checksum + 1 WHERE id = 'm1'",
      "UPDATE jobs SET record = record || 'x' WHERE id = 'runs'",
      "UPDATE jobs SET result = NULL WHERE id = 'large1'",
      "UPDATE meshes SET blob = NULL WHERE id = 'm2'",
      "DELETE FROM queue WHERE job = 'waits1'",
      "INSERT INTO blobs VALUES (repeat('0', 64), 2, 0)",
      "UPDATE portions SET count = count - 1 WHERE n = 0",
      "UPDATE portions SET first = first + 1 WHERE n = 2",
      "UPDATE portions SET n = 7 WHERE n = 2",
      "UPDATE portions SET job = 'unknown'",
      "UPDATE portions SET first = 0 WHERE n = 5",
      "UPDATE portions SET body = substr(body, 1, octet_length(body) / 2) WHERE n = 5",
      "UPDATE portions SET request = substr(request, 1, octet_length(request) / 2) WHERE n = 5",
      "UPDATE portions SET body = substr(body, 1, octet_length(body) - 1) WHERE n = 1",
      "UPDATE portions SET body = substr(body, 1, octet_length(body) / 2) WHERE n = 1",
  };
  for (const char* kind : {"0", "1", "2"}) {
    const std::string one = "sha256 = " + some + kind + ")";
    damages.push_back("DELETE FROM pieces WHERE " + one);
    damages.push_back("UPDATE pieces SET body = body || 'x' WHERE " + one);
    damages.push_back(
        "UPDATE pieces SET body = set_byte(body, octet_length(body) - 1, "
        "get_byte(body, octet_length(body) - 1) # 1) WHERE " +
        one);
    damages.push_back("UPDATE blobs SET bytes = bytes + 1048576 WHERE " + one);
  }
  for (const std::string& damage : damages) {
    std::vector<std::string> found;
    EXPECT_ANY_THROW(postgres::transact(pool, [&](postgres::Transaction& transaction) {
      transaction.execute("ALTER TABLE portions DROP CONSTRAINT portions_job_fkey");
      EXPECT_NE(transaction.run(damage).affected(), 0U) << damage;
      found = group::check(transaction).flaws;
      throw std::runtime_error("undone");
    }));
    EXPECT_FALSE(found.empty()) << damage;
  }
  EXPECT_THAT(flaws(), IsEmpty());
}

}  // namespace
}  // namespace anticrack::store
