// SPDX-License-Identifier: GPL-3.0-or-later
//
// A connection to PostgreSQL with a deadline for every statement.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "errors/errors.hpp"

struct pg_conn;
struct pg_result;

namespace anticrack::postgres {

/// The connection broke, or did not answer in time: nobody knows whether the statement was done.
class Lost : public errors::Error {
 public:
  explicit Lost(const std::string& why);
};

/// The database asks to do the transaction again: SQLSTATE 40001, 40P01, 55P03.
class Conflict : public errors::Error {
 public:
  explicit Conflict(const std::string& why) : Error(errors::Reason::busy, "{}", why) {}
};

/// A parameter of a statement: text, or bytes as they are.
struct Value {
  Value(std::string_view text) : bytes(text) {}    // NOLINT(google-explicit-constructor)
  Value(const std::string& text) : bytes(text) {}  // NOLINT(google-explicit-constructor)
  Value(const char* text) : bytes(text) {}         // NOLINT(google-explicit-constructor)
  Value(std::int64_t number) : bytes(std::to_string(number)) {}   // NOLINT
  Value(std::uint64_t number) : bytes(std::to_string(number)) {}  // NOLINT
  Value(int number) : bytes(std::to_string(number)) {}            // NOLINT
  static Value blob(std::string_view bytes);
  /// An array of texts.
  static Value list(const std::vector<std::string>& texts);

  std::string bytes;
  bool binary = false;
};

/// The rows that a statement gave.
class Rows {
 public:
  explicit Rows(pg_result* result);
  int size() const;
  bool empty() const { return size() == 0; }
  bool is_null(int row, int column) const;
  /// Text, or the bytes of a bytea.
  std::string text(int row, int column) const;
  std::int64_t integer(int row, int column) const;  ///< of any width; a boolean is 0 or 1
  std::uint64_t affected() const;                   ///< rows that the statement changed

 private:
  std::shared_ptr<pg_result> _result;
};

/// Not thread-safe.
class Connection {
 public:
  /// `url`: as libpq takes it. Throws Lost, with the server's message.
  explicit Connection(const std::string& url);

  /// Runs one statement with $1, $2, ...; its results come in binary. Throws Lost, Conflict or
  /// errors::Error (disk_full, storage).
  Rows run(const std::string& sql, const std::vector<Value>& values = {});
  /// Several statements without values.
  void script(const std::string& sql);
  /// Waits at most this long for a notification; its channel, empty if none came.
  std::string notification(std::chrono::milliseconds time);

 private:
  Rows result();
  bool wait(short events, std::chrono::steady_clock::time_point until);

  std::shared_ptr<pg_conn> _connection;
};

}  // namespace anticrack::postgres
