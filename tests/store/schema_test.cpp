// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/schema.hpp"

#include <array>

#include "store/record_codec.hpp"
#include "store/store_fixture.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::TemporaryFolder;
using anticrack::testing::throws;
using errors::Reason;

class Schema : public ::testing::Test {
 protected:
  bool copies_left() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      if (entry.path().filename().string().find(".before-") != std::string::npos) return true;
    }
    return false;
  }
  TemporaryFolder folder;
  const std::string path = (folder / "anticrack.db").string();
};

TEST_F(Schema, IsMadeInAnEmptyDatabase) {
  Connection connection(path);
  migrate(connection, schema_steps());
  EXPECT_EQ(connection.integer("PRAGMA user_version"),
            static_cast<std::int64_t>(schema_steps().size()));
  EXPECT_EQ(connection.integer("SELECT count(*) FROM jobs"), 0);
  migrate(connection, schema_steps());
  require_sound(connection);
}

TEST_F(Schema, OfTheFirstVersionIsBroughtUpToDateWithItsRecords) {
  {
    Connection connection(path);
    migrate(connection, schema_steps().first(1));
    const std::string bytes = encode(job_record("j"));
    connection
        .prepare(
            "INSERT INTO jobs (id, owner, request, fingerprint, result, result_bytes, record)"
            " VALUES ('j', '', '', '', '', 0, ?)")
        .bind_blob(bytes)
        .run();
  }
  const auto store = open({folder.path(), 0});
  ASSERT_TRUE(store->job("j"));
  EXPECT_EQ(store->unfinished().size(), 1U);
  EXPECT_FALSE(copies_left());
}

TEST_F(Schema, TakesOnlyTheStepsThatAreMissing) {
  const std::array<const char*, 3> steps{
      "CREATE TABLE things (name TEXT)", "INSERT INTO things VALUES ('second')",
      "ALTER TABLE things ADD COLUMN size INTEGER NOT NULL DEFAULT 7"};
  Connection connection(path);
  migrate(connection, std::span(steps).first(2));
  connection.execute("INSERT INTO things VALUES ('mine')");
  migrate(connection, steps);
  EXPECT_EQ(connection.integer("PRAGMA user_version"), 3);
  EXPECT_EQ(connection.integer("SELECT count(*) FROM things"), 2);
  EXPECT_EQ(connection.integer("SELECT size FROM things WHERE name = 'mine'"), 7);
  EXPECT_FALSE(copies_left());
}

TEST_F(Schema, StaysAsItIsWhenAStepFailsAndKeepsTheCopy) {
  const std::array<const char*, 3> steps{"CREATE TABLE things (name TEXT)",
                                         "INSERT INTO things VALUES ('second')", "NO SUCH THING"};
  Connection connection(path);
  migrate(connection, std::span(steps).first(1));
  EXPECT_TRUE(throws([&] { migrate(connection, steps); }, Reason::internal));
  EXPECT_EQ(connection.integer("PRAGMA user_version"), 1);
  EXPECT_EQ(connection.integer("SELECT count(*) FROM things"), 0);
  ASSERT_TRUE(copies_left());
  EXPECT_EQ(Connection(path + ".before-3").integer("PRAGMA user_version"), 1);
  migrate(connection, std::span(steps).first(2));  // and once more, with what is left over there
  EXPECT_EQ(connection.integer("SELECT count(*) FROM things"), 1);
}

TEST_F(Schema, OfANewerAnticrackIsRefused) {
  open({folder.path(), 0})->put(mesh_record("m"));
  const auto newer = static_cast<std::int64_t>(schema_steps().size()) + 1;
  Connection(path).execute("PRAGMA user_version = " + std::to_string(newer));
  const auto error = error_of([&] { open({folder.path(), 0}); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::storage);
  EXPECT_THAT(error->what(), ::testing::HasSubstr("newer"));
  EXPECT_EQ(Connection(path).integer("SELECT count(*) FROM meshes"), 1);
}

}  // namespace
}  // namespace anticrack::store
