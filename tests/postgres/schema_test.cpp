// SPDX-License-Identifier: GPL-3.0-or-later
#include "postgres/schema.hpp"

#include <gmock/gmock.h>

#include <array>
#include <thread>

#include "support/database.hpp"
#include "support/errors.hpp"

namespace anticrack::postgres {
namespace {

using anticrack::testing::Database;
using anticrack::testing::error_of;
using errors::Reason;

constexpr std::array steps{"CREATE TABLE a (n bigint); INSERT INTO a VALUES (1)",
                           "ALTER TABLE a ADD b bigint NOT NULL DEFAULT 5"};

class DatabaseTables : public ::testing::Test {
 protected:
  Database database;
  Pool pool{{Address(database.address()), "test"}};
};

TEST_F(DatabaseTables, AreMadeOnceByManyServers) {
  std::vector<std::jthread> servers;
  for (int i = 0; i < 5; ++i)
    servers.emplace_back([&] {
      Pool own{{Address(database.address()), "test"}};
      make_tables(own, {steps, 1});
    });
  servers.clear();
  EXPECT_EQ(query(pool, "SELECT n, b FROM a").rows(), 1U);
}

TEST_F(DatabaseTables, GoOnFromAnOlderVersion) {
  make_tables(pool, {std::span(steps).first(1), 1});
  make_tables(pool, {steps, 1});
  EXPECT_EQ(query(pool, "SELECT b FROM a").integer(0, 0), 5);
}

TEST_F(DatabaseTables, OfANewerVersionAreRefusedUnlessTheOlderProgramCanUseThem) {
  make_tables(pool, {steps, 1});
  make_tables(pool, {std::span(steps).first(1), 1});
  query(pool, "UPDATE tables SET oldest = 2");
  const auto error = error_of([&] { make_tables(pool, {std::span(steps).first(1), 1}); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::storage);
  EXPECT_THAT(error->what(), ::testing::HasSubstr("newer anticrack"));
}

TEST_F(DatabaseTables, AreMadeWholeOrNotAtAll) {
  constexpr std::array broken{steps[0], "CREATE TABLE a (again bigint)"};
  EXPECT_TRUE(error_of([&] { make_tables(pool, {broken, 1}); }));
  EXPECT_TRUE(query(pool, "SELECT 1 FROM pg_namespace WHERE nspname = 'anticrack'").empty());
  make_tables(pool, {steps, 1});
}

}  // namespace
}  // namespace anticrack::postgres
