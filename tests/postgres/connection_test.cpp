// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <limits>
#include <thread>

#include "base/descriptor.hpp"
#include "postgres/connection.hpp"
#include "postgres/listener.hpp"
#include "stop/stop.hpp"
#include "support/database.hpp"
#include "support/errors.hpp"
#include "support/eventually.hpp"

namespace anticrack::postgres {
namespace {

using anticrack::testing::Database;
using anticrack::testing::error_of;
using anticrack::testing::eventually;
using anticrack::testing::throws;
using errors::Reason;
using ::testing::HasSubstr;
using ::testing::Not;

class DatabaseConnection : public ::testing::Test {
 protected:
  Settings settings(const std::string& address) const {
    return {Address(address), "test", 2, std::chrono::seconds(5), std::chrono::seconds(20), {}};
  }
  Database database;
  const Settings given = settings(database.address());
  Connection connection{given, given.address.servers()[0]};
};

TEST_F(DatabaseConnection, BringsValuesBackAsTheyWere) {
  const std::string bytes("\0\x01\xff'\\\"", 6);
  const std::string text = "a \xc3\xa9 ' \\ $1";
  const std::int64_t least = std::numeric_limits<std::int64_t>::min();
  const Result row = connection.run(
      "SELECT $1::bytea, $2::text, $3::bigint, $4::bool, $5::bigint, -7::smallint, $6::bytea",
      {Value::bytes(bytes), text, least, true, std::optional<std::int64_t>(), Value::bytes("")});
  ASSERT_EQ(row.rows(), 1U);
  EXPECT_EQ(row.text(0, 0), bytes);
  EXPECT_EQ(row.text(0, 1), text);
  EXPECT_EQ(row.integer(0, 2), least);
  EXPECT_EQ(row.integer(0, 3), 1);
  EXPECT_TRUE(row.is_null(0, 4));
  EXPECT_EQ(row.integer(0, 5), -7);
  EXPECT_FALSE(row.is_null(0, 6));
  EXPECT_EQ(row.text(0, 6), "");
}

TEST_F(DatabaseConnection, TakesLists) {
  for (const std::vector<std::string>& texts :
       {std::vector<std::string>{}, {"b", "a, {}", ""}, std::vector<std::string>(1000, "x")}) {
    const Result rows = connection.run("SELECT unnest($1::text[])", {texts});
    ASSERT_EQ(rows.rows(), texts.size());
    for (std::size_t i = 0; i < texts.size(); ++i) EXPECT_EQ(rows.text(i, 0), texts[i]);
  }
  const Result sum = connection.run("SELECT sum(n)::bigint FROM unnest($1::bigint[]) n",
                                    {std::vector<std::int64_t>{1, -20, 300}});
  EXPECT_EQ(sum.integer(0, 0), 281);
  EXPECT_EQ(connection
                .run("SELECT length(b) FROM unnest($1::bytea[]) b",
                     {Value::list_of_bytes({std::string(3, '\0')})})
                .integer(0, 0),
            3);
}

TEST_F(DatabaseConnection, MovesMegabytesBothWays) {
  std::string bytes(20'000'000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7 >> 3U);
  EXPECT_EQ(connection.run("SELECT $1::bytea", {Value::bytes(bytes)}).text(0, 0), bytes);
}

TEST_F(DatabaseConnection, GoesOnAfterAnErrorOfAStatement) {
  const auto error = error_of([&] { connection.run("SELECT 1 / $1::bigint", {0}); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr("22012"));
  EXPECT_FALSE(connection.broken());
  EXPECT_EQ(connection.run("SELECT 1 / $1::bigint", {1}).integer(0, 0), 1);
}

TEST_F(DatabaseConnection, EndsAWaitAtItsDeadline) {
  const Settings hasty{
      given.address, "test", 1, std::chrono::seconds(5), std::chrono::milliseconds(300), {}};
  Connection other(hasty, hasty.address.servers()[0]);
  EXPECT_TRUE(throws([&] { other.run("SELECT pg_sleep(60)"); }, Reason::storage));
}

TEST_F(DatabaseConnection, EndsAWaitWhenItsThreadIsToStop) {
  std::stop_source stop;
  const std::jthread stopping([&] {
    EXPECT_TRUE(eventually([&] {
      return database.sql(
                 "SELECT count(*) FROM pg_stat_activity WHERE query LIKE '%pg_sleep(17)' "
                 "AND state = 'active' AND pid <> pg_backend_pid()") == "1\n";
    }));
    stop.request_stop();
  });
  const stop::Scope scope(stop.get_token());
  EXPECT_TRUE(throws([&] { connection.run("SELECT pg_sleep(17)"); }, Reason::cancelled));
  EXPECT_TRUE(connection.broken());
}

/// A server that takes connections and says nothing.
TEST_F(DatabaseConnection, GivesUpAServerThatIsSilent) {
  const anticrack::testing::TemporaryFolder folder;
  const base::Descriptor listening(::socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  const std::string path = folder.path() + "/.s.PGSQL.5432";
  path.copy(name.sun_path, sizeof name.sun_path - 1);
  ASSERT_EQ(::bind(listening.get(), reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  ASSERT_EQ(::listen(listening.get(), 5), 0);
  Settings silent = settings("postgresql://x:secret@/y?host=" + folder.path());
  silent.connect_time = std::chrono::milliseconds(200);
  const auto error = error_of([&] { Connection(silent, silent.address.servers()[0]); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::storage);
  EXPECT_GT(error->retry_delay().count(), 0);
  EXPECT_THAT(error->what(), Not(HasSubstr("secret")));
}

TEST_F(DatabaseConnection, SaysWhatIsWrongWithAnAddress) {
  database.sql("CREATE ROLE ann LOGIN PASSWORD 'right'");
  const auto refused = [&](std::string address) {
    const Settings wrong = settings(address);
    return error_of([&] { Connection(wrong, wrong.address.servers()[0]); });
  };
  const auto missing = refused(database.address("nowhere"));
  ASSERT_TRUE(missing);
  EXPECT_THAT(missing->what(), HasSubstr("createdb"));
  EXPECT_THAT(missing->what(), HasSubstr("nowhere"));
  const auto stranger = refused("postgresql://eve:secret@/postgres?host=" +
                                database.address().substr(database.address().find("host=") + 5));
  ASSERT_TRUE(stranger);
  EXPECT_THAT(stranger->what(), HasSubstr("28000"));
  EXPECT_THAT(stranger->what(), Not(HasSubstr("secret")));
}

TEST_F(DatabaseConnection, HearsNotificationsAndThatItMayHaveMissedSome) {
  std::mutex mutex;
  std::vector<std::string> heard;
  Listener listener(given, {"news"}, [&](const std::string& channel, const std::string& payload) {
    const std::lock_guard lock(mutex);
    heard.push_back(channel + ":" + payload);
  });
  const auto has = [&](const std::string& what, std::ptrdiff_t times) {
    return eventually([&] {
      const std::lock_guard lock(mutex);
      return std::ranges::count(heard, what) >= times;
    });
  };
  ASSERT_TRUE(has("news:", 1));
  connection.run("SELECT pg_notify('news', $1)", {"one"});
  ASSERT_TRUE(has("news:one", 1));
  database.stop();
  database.start();
  ASSERT_TRUE(has("news:", 2));
}

}  // namespace
}  // namespace anticrack::postgres
