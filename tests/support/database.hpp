// SPDX-License-Identifier: GPL-3.0-or-later
//
// A PostgreSQL server of a test's own.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::testing {

/// Makes a cluster in a temporary folder and runs it on a Unix socket there, so that any number may
/// run at once; as the user postgres where the test is root. Nothing is flushed to the disk: what a
/// kill of the server leaves is in the system's cache.
class Database {
 public:
  /// A user who needs a password, which is the name; all others need none.
  static constexpr const char* guarded = "guarded";

  Database();
  /// A hot standby of one that runs, which from now on commits nothing that is not here, too.
  explicit Database(Database* primary);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// "postgresql://..." of the database `name`, as the superuser; empty: one that is there.
  std::string address(const std::string& name = "postgres") const;
  /// As address(), of this one or of its standby, whichever can be written to.
  std::string address_or(const Database& standby) const;
  /// Makes a new empty database and returns its address.
  std::string fresh();
  /// Ends the server at once, as a crash does, and waits until it is gone.
  void stop();
  /// Starts it after stop() and waits until it takes connections.
  void start();
  /// Makes a primary of a standby.
  void promote() const { sql("SELECT pg_promote()"); }
  /// Runs SQL with psql in a database; returns what it prints, one row a line, columns by "|".
  std::string sql(const std::string& text, const std::string& database = "postgres") const;

 private:
  void give_folder() const;
  std::vector<std::string> as_user(std::vector<std::string> command) const;

  TemporaryFolder _folder;
  std::unique_ptr<Process> _server;
  int _made = 0;
};

/// One server for all tests of the process.
Database& shared_database();

}  // namespace anticrack::testing
