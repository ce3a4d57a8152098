// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/sqlite.hpp"

#include <array>
#include <cerrno>
#include <new>
#include <span>
#include <utility>

#include "digest/digest.hpp"
#include "store/disk_errors.hpp"

namespace anticrack::store {

using errors::Error;
using errors::Reason;

namespace {

/// The SQL function crc32c(...): CRC-32C of all arguments, each with its type and its length.
void crc32c_of(sqlite3_context* context, int count, sqlite3_value** values) {
  std::uint32_t sum = 0;
  for (sqlite3_value* value : std::span(values, static_cast<std::size_t>(count))) {
    const int type = sqlite3_value_type(value);
    std::array<std::int64_t, 4> parts{sum, type, 0, 0};
    if (type == SQLITE_INTEGER) {
      parts[2] = sqlite3_value_int64(value);
    } else if (type != SQLITE_NULL) {
      const auto* bytes = static_cast<const std::byte*>(sqlite3_value_blob(value));
      parts[2] = sqlite3_value_bytes(value);
      parts[3] = digest::crc32c({bytes, static_cast<std::size_t>(parts[2])});
    }
    sum = digest::crc32c(std::as_bytes(std::span(parts)));
  }
  sqlite3_result_int64(context, sum);
}

}  // namespace

Statement::~Statement() {
  sqlite3_reset(_statement);
  sqlite3_clear_bindings(_statement);
}

void Statement::check(int code) {
  if (code != SQLITE_OK) throw _connection.error(code);
}

void Statement::bind_next(std::int64_t value) {
  check(sqlite3_bind_int64(_statement, ++_bound, value));
}

void Statement::bind_next(const std::optional<std::int64_t>& value) {
  if (value) return bind_next(*value);
  check(sqlite3_bind_null(_statement, ++_bound));
}

void Statement::bind_next(std::string_view text) {
  check(sqlite3_bind_text64(_statement, ++_bound, text.data(), text.size(), nullptr, SQLITE_UTF8));
}

void Statement::bind_next(Blob blob) {
  const char* const bytes = blob.bytes.empty() ? nullptr : blob.bytes.data();
  check(sqlite3_bind_blob64(_statement, ++_bound, bytes, blob.bytes.size(), nullptr));
}

bool Statement::step() {
  const int code = sqlite3_step(_statement);
  if (code != SQLITE_ROW && code != SQLITE_DONE) throw _connection.error(code);
  return code == SQLITE_ROW;
}

void Statement::run() {
  while (step()) {
  }
}

std::int64_t Statement::integer(int column) { return sqlite3_column_int64(_statement, column); }

std::string Statement::text(int column) {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(_statement, column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(_statement, column));
  return bytes == nullptr ? std::string() : std::string(bytes, size);
}

Connection::Connection(std::string path) : _path(std::move(path)) {
  sqlite3* database = nullptr;
  // SQLite's own mutex is off, as a connection belongs to one thread at a time.
  const int code =
      sqlite3_open_v2(_path.c_str(), &database,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
  _database.reset(database);
  if (database == nullptr) throw std::bad_alloc();
  sqlite3_extended_result_codes(database, 1);
  if (code != SQLITE_OK) throw error(code);
  if (sqlite3_db_readonly(database, "main") != 0) {
    // SQLite opens a file read-only if it may not, or just now cannot, open it for writing.
    throw error(SQLITE_READONLY);
  }
  sqlite3_busy_timeout(database, 5000);  // for a backup tool, or the other connection's checkpoint
  sqlite3_create_function_v2(database, "crc32c", -1, SQLITE_UTF8 | SQLITE_DETERMINISTIC, nullptr,
                             crc32c_of, nullptr, nullptr, nullptr);
}

Statement Connection::prepare(const std::string& sql) {
  auto& statement = _statements[sql];
  if (!statement) {
    sqlite3_stmt* compiled = nullptr;
    const int code =
        sqlite3_prepare_v3(_database.get(), sql.c_str(), static_cast<int>(sql.size()) + 1,
                           SQLITE_PREPARE_PERSISTENT, &compiled, nullptr);
    statement.reset(compiled);
    if (code != SQLITE_OK) throw error(code);
  }
  return {*this, statement.get()};
}

void Connection::execute(const std::string& sql) {
  const int code = sqlite3_exec(_database.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) throw error(code);
}

std::int64_t Connection::integer(const std::string& sql) {
  Statement statement = prepare(sql);
  return statement.step() ? statement.integer(0) : 0;
}

bool Connection::in_transaction() const noexcept {
  return sqlite3_get_autocommit(_database.get()) == 0;
}

int Connection::changes() const noexcept { return sqlite3_changes(_database.get()); }

std::int64_t Connection::total_changes() const noexcept {
  return sqlite3_total_changes64(_database.get());
}

Error Connection::error(int code) const {
  // The errno of the system call that failed; SQLite keeps it for some of its errors only.
  const int of_system = errno;
  // The error of the last call, more exact than what it returned.
  const std::string what = "the database " + _path + ": " + sqlite3_errmsg(_database.get()) + " (" +
                           sqlite3_errstr(code) + ")";
  switch (code & 0xff) {
    case SQLITE_NOMEM:
      throw std::bad_alloc();
    case SQLITE_FULL:
      return disk_full(what);
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
      if (no_space(of_system) || no_space(sqlite3_system_errno(_database.get())))
        return disk_full(what);
      return {Reason::storage, what + "; check that the data folder is there, writable and sound"};
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_PROTOCOL:
      return {Reason::storage, what + "; another program holds it: end that program"};
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return {Reason::storage, what + "; make it writable for the server's user"};
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
    case SQLITE_FORMAT:
      return {Reason::storage, what +
                                   "; it is damaged: stop the server and restore the data "
                                   "folder from a backup, or move it away to start anew"};
    default:
      return {Reason::internal, what};
  }
}

Transaction::Transaction(Connection& connection) : _connection(connection) {
  _connection.execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  if (_connection.in_transaction()) {
    try {
      _connection.execute("ROLLBACK");
    } catch (...) {  // SQLite has rolled back by itself, or will when the connection is used next
    }
  }
}

void Transaction::commit() { _connection.execute("COMMIT"); }

}  // namespace anticrack::store
