// SPDX-License-Identifier: GPL-3.0-or-later
//
// A PostgreSQL of its own, in a temporary folder, on a Unix socket.
#pragma once

#include <memory>
#include <string>

#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::testing {

class Postgres {
 public:
  /// Whether Debian's postgresql is installed.
  static bool installed();

  /// Runs and answers when it returns. Throws what it said when it does not.
  Postgres();
  ~Postgres();

  /// The URL of a new empty database.
  std::string new_database();
  /// What psql prints for a statement, without the last line feed.
  std::string ask(const std::string& url, const std::string& sql) const;
  /// Ends it at once, so that it has to recover, and starts it again.
  void crash();

 private:
  void start();

  TemporaryFolder _folder;
  std::unique_ptr<Process> _server;
  int _databases = 0;
};

}  // namespace anticrack::testing
