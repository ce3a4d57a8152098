// SPDX-License-Identifier: GPL-3.0-or-later
//
// SQLite with scopes instead of calls to remember. A connection belongs to one thread at a time.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>

#include "errors/errors.hpp"

namespace anticrack::store {

class Connection;

/// Bytes as a parameter; null where there are none.
struct Blob {
  std::string_view bytes;
};

/// A statement of a connection, which keeps it compiled. Reset at the end of the scope: a statement
/// left in the middle would keep its transaction, and an error of the disk, alive.
class Statement {
 public:
  Statement(Connection& connection, sqlite3_stmt* statement) noexcept
      : _connection(connection), _statement(statement) {}
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  /// Binds the next parameters, beginning with the first. Texts must outlive the statement.
  template <class... Values>
  Statement& bind(const Values&... values) {
    (bind_next(values), ...);
    return *this;
  }

  /// Goes to the next row; false if there is none.
  bool step();
  /// Runs the statement to its end.
  void run();

  /// A column of the present row; columns count from 0.
  std::int64_t integer(int column);
  std::string text(int column);  ///< of a text or of a blob

 private:
  void bind_next(std::int64_t value);
  void bind_next(const std::optional<std::int64_t>& value);
  void bind_next(std::string_view text);
  void bind_next(Blob bytes);
  void check(int code);

  Connection& _connection;
  sqlite3_stmt* _statement;
  int _bound = 0;
};

/// Every call may throw errors::Error: disk_full if there is no space, storage for any other
/// failure of the disk and for a damaged file, internal for a bug; or std::bad_alloc.
class Connection {
 public:
  /// Opens or makes the file. SQL gets an additional function crc32c(...).
  explicit Connection(std::string path);

  /// A statement; each text is compiled once.
  Statement prepare(const std::string& sql);
  /// Runs a statement with these parameters to its end.
  template <class... Values>
  void run(const std::string& sql, const Values&... values) {
    prepare(sql).bind(values...).run();
  }
  /// Whether the statement with these parameters has a row.
  template <class... Values>
  bool any(const std::string& sql, const Values&... values) {
    return prepare(sql).bind(values...).step();
  }
  /// Runs statements without parameters and without rows.
  void execute(const std::string& sql);
  /// The first column of the first row of a query.
  std::int64_t integer(const std::string& sql);

  /// Whether a transaction has begun and has not ended.
  bool in_transaction() const noexcept;
  int changes() const noexcept;  ///< rows the last statement changed
  std::int64_t total_changes() const noexcept;
  const std::string& path() const noexcept { return _path; }
  errors::Error error(int code) const;

 private:
  struct Close {
    void operator()(sqlite3* database) const noexcept { sqlite3_close_v2(database); }
  };
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const noexcept { sqlite3_finalize(statement); }
  };

  std::string _path;
  std::unique_ptr<sqlite3, Close> _database;
  std::unordered_map<std::string, std::unique_ptr<sqlite3_stmt, Finalize>> _statements;
};

/// A transaction; the end of the scope rolls it back unless it was committed.
class Transaction {
 public:
  /// Begins a transaction for writing.
  explicit Transaction(Connection& connection);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  /// Commits; the changes are on the disk when it returns.
  void commit();

 private:
  Connection& _connection;
};

}  // namespace anticrack::store
