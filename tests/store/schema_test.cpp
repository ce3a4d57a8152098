// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/schema.hpp"

#include <utility>

#include "store/store_fixture.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::TemporaryFolder;
using errors::Reason;

class Schema : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  const std::string path = (folder / "anticrack.db").string();
};

TEST_F(Schema, IsMadeInAnEmptyDatabase) {
  Connection connection(path);
  make_tables(connection);
  EXPECT_GT(connection.integer("PRAGMA user_version"), 2);
  EXPECT_EQ(connection.integer("SELECT count(*) FROM jobs"), 0);
  make_tables(connection);
  require_sound(connection);
}

TEST_F(Schema, OfAnotherVersionIsRefusedAndLeftAsItIs) {
  open({folder.path(), 0})->put(mesh_record("m"));
  const std::int64_t own = Connection(path).integer("PRAGMA user_version");
  for (const auto& [version, word] : {std::pair{own + 1, "newer"}, {own - 2, "older"}}) {
    Connection(path).execute("PRAGMA user_version = " + std::to_string(version));
    const auto error = error_of([&] { open({folder.path(), 0}); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->reason(), Reason::storage);
    EXPECT_THAT(error->what(), ::testing::HasSubstr(word));
    EXPECT_THAT(error->what(), ::testing::HasSubstr("version " + std::to_string(version)));
    EXPECT_EQ(Connection(path).integer("SELECT count(*) FROM meshes"), 1);
    EXPECT_EQ(Connection(path).integer("PRAGMA user_version"), version);
  }
}

}  // namespace
}  // namespace anticrack::store
