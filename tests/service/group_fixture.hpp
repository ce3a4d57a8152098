// SPDX-License-Identifier: GPL-3.0-or-later
//
// Real servers on a real PostgreSQL.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "service/daemon.hpp"
#include "service/processes.hpp"
#include "support/database.hpp"

namespace anticrack::service_test {

constexpr std::uint64_t numbers_of_an_attempt = std::uint64_t{1} << 40U;

class Group : public ::testing::Test {
 protected:
  void SetUp() override { url = database.address(); }

  Daemon& add(std::vector<std::string> more = {}, const char* threads = "1") {
    std::vector<std::string> options{"--store", url, "--threads", threads, "--crashes", "0"};
    options.insert(options.end(), more.begin(), more.end());
    return *servers.emplace_back(std::make_unique<Daemon>(options));
  }

  std::size_t count(const std::string& rows) const {
    return std::stoul(database.sql("SELECT count(*) FROM anticrack." + rows));
  }

  anticrack::testing::Database database;
  std::string url;
  std::vector<std::unique_ptr<Daemon>> servers;
};

/// Two servers solve one job.
class SpreadGroup : public Group {
 protected:
  /// From now on every portion that is solved is noted. The tables must be there.
  void note_portions() const {
    database.sql(
        "CREATE TABLE noted (n integer, runner bigint, helped boolean);"
        "CREATE FUNCTION note() RETURNS trigger LANGUAGE plpgsql AS $$BEGIN INSERT INTO "
        "public.noted SELECT NEW.n, NEW.runner, q.runner IS DISTINCT FROM NEW.runner FROM "
        "anticrack.queue q WHERE q.job = NEW.job; RETURN NEW; END$$;"
        "CREATE TRIGGER note AFTER UPDATE ON anticrack.portions FOR EACH ROW "
        "WHEN (OLD.body IS NULL AND NEW.body IS NOT NULL) EXECUTE FUNCTION note()");
  }
  std::size_t noted(const std::string& which = "true") const {
    return std::stoul(database.sql("SELECT count(*) FROM noted WHERE " + which));
  }
  /// Swaps the two servers if the second runs the job.
  void runner_first() {
    const std::string runner =
        database.sql("SELECT name FROM anticrack.servers JOIN anticrack.queue ON runner = epoch");
    if (!runner.starts_with(read_file(servers[0]->data() + "/server")))
      std::swap(servers[0], servers[1]);
  }
  Daemon& runner() { return *servers[0]; }
  Daemon& helper() { return *servers[1]; }
  /// Drains the helper, which comes back, and then the runner. Neither keeps a portion.
  void drain_both() {
    const std::string of_nobody =
        "portions WHERE body IS NULL AND runner NOT IN (SELECT epoch FROM anticrack.servers)";
    EXPECT_EQ(helper().stop(), 0);
    EXPECT_EQ(count(of_nobody), 0U);
    helper().start();
    EXPECT_EQ(runner().stop(), 0);
    EXPECT_EQ(count(of_nobody), 0U);
  }
  /// Nothing was solved twice.
  void expect_once() const {
    EXPECT_EQ(noted(), std::stoul(database.sql("SELECT count(DISTINCT n) FROM noted")));
  }
};

}  // namespace anticrack::service_test
