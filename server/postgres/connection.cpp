// SPDX-License-Identifier: GPL-3.0-or-later
#include "postgres/connection.hpp"

#include <libpq-fe.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <new>
#include <utility>
#include <vector>

#include "stop/stop.hpp"

namespace anticrack::postgres {

namespace {

using errors::Error;
using errors::Reason;

constexpr std::chrono::milliseconds look_every{100};

/// The first line of a message of libpq, without "FATAL:  28P01: ", and the SQLSTATE in it.
/// Errors of a connection that is being made have no field for it, but the verbose text has.
std::pair<std::string, std::string> parts_of(const std::string& message) {
  std::string line = message.substr(0, message.find('\n'));
  std::string sqlstate;
  for (const char* severity : {"FATAL:  ", "ERROR:  ", "PANIC:  "}) {
    const std::size_t at = line.find(severity);
    if (at == std::string::npos || line.size() < at + 15 || line[at + 13] != ':') continue;
    sqlstate = line.substr(at + 8, 5);
    line = line.substr(at + 15);
    break;
  }
  return {std::move(line), std::move(sqlstate)};
}

}  // namespace

void Result::clear(pg_result* result) noexcept { PQclear(result); }

std::size_t Result::rows() const noexcept {
  return static_cast<std::size_t>(PQntuples(_result.get()));
}

std::size_t Result::affected() const noexcept {
  return static_cast<std::size_t>(std::strtoull(PQcmdTuples(_result.get()), nullptr, 10));
}

bool Result::is_null(std::size_t row, int column) const noexcept {
  return PQgetisnull(_result.get(), static_cast<int>(row), column) != 0;
}

std::string_view Result::view(std::size_t row, int column) const noexcept {
  const char* const value = PQgetvalue(_result.get(), static_cast<int>(row), column);
  const int size = PQgetlength(_result.get(), static_cast<int>(row), column);
  return value == nullptr ? std::string_view()
                          : std::string_view(value, static_cast<std::size_t>(size));
}

std::int64_t Result::integer(std::size_t row, int column) const {
  const std::string_view bytes = view(row, column);
  if (bytes.empty()) return 0;
  if (bytes.size() > sizeof(std::int64_t))
    throw Error(Reason::internal, "a column of {} bytes is no integer", bytes.size());
  auto number = static_cast<std::uint64_t>(
      static_cast<std::int64_t>(static_cast<signed char>(bytes.front())));  // with its sign
  for (const char byte : bytes.substr(1))
    number = (number << 8U) | static_cast<unsigned char>(byte);
  return static_cast<std::int64_t>(number);
}

void Connection::Finish::operator()(pg_conn* connection) const noexcept { PQfinish(connection); }

Connection::Connection(const Settings& settings, const Options& server)
    : _settings(settings), _place(settings.address.shown()) {
  connect(server);
  const auto milliseconds = settings.call_time.count();
  // A transaction whose client has gone silent must not hold its locks; and what was committed must
  // be on the disk, whatever the database's default.
  execute(fmt::format(
      "SET search_path = anticrack; SET default_transaction_isolation = 'read committed'; "
      "SET idle_in_transaction_session_timeout = {0}; SET statement_timeout = {0}; "
      "SET lock_timeout = {1}; SET client_min_messages = error; "
      "SELECT set_config('synchronous_commit', 'on', false) "
      "WHERE current_setting('synchronous_commit') = 'off'",
      milliseconds, milliseconds / 2));
}

void Connection::connect(const Options& server) {
  Options options{{"target_session_attrs", "read-write"}, {"keepalives_idle", "5"},
                  {"keepalives_interval", "2"},           {"keepalives_count", "3"},
                  {"application_name", _settings.name},   {"client_encoding", "UTF8"}};
  for (const auto& [key, value] : server) options[key] = value;
  std::vector<const char*> keys, values;
  for (const auto& [key, value] : options) {
    keys.push_back(key.c_str());
    values.push_back(value.c_str());
  }
  keys.push_back(nullptr);
  values.push_back(nullptr);
  _connection.reset(PQconnectStartParams(keys.data(), values.data(), 0));
  if (!_connection) throw std::bad_alloc();
  PQsetErrorVerbosity(_connection.get(), PQERRORS_VERBOSE);
  PQsetNoticeProcessor(
      _connection.get(), [](void*, const char*) {}, nullptr);
  const Clock::time_point deadline = Clock::now() + _settings.connect_time;
  PostgresPollingStatusType status = PGRES_POLLING_WRITING;
  if (PQstatus(_connection.get()) == CONNECTION_BAD) status = PGRES_POLLING_FAILED;
  while (status != PGRES_POLLING_OK) {
    if (status == PGRES_POLLING_FAILED) fail(PQerrorMessage(_connection.get()));
    wait(status == PGRES_POLLING_READING ? POLLIN : POLLOUT, deadline);
    status = PQconnectPoll(_connection.get());
  }
  if (PQsetnonblocking(_connection.get(), 1) != 0) fail(PQerrorMessage(_connection.get()));
}

bool Connection::broken() const noexcept {
  return _broken || PQstatus(_connection.get()) != CONNECTION_OK;
}

int Connection::socket() const noexcept { return PQsocket(_connection.get()); }

/// Waits until the socket is ready.
void Connection::wait(short events, Clock::time_point deadline) {
  for (;;) {
    if (_stoppable) {
      try {
        stop::look("talking to the database");
      } catch (...) {
        _broken = true;  // the reply is still to come
        throw;
      }
    }
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) fail("it does not answer in time");
    pollfd one{socket(), events, 0};
    const int ready = ::poll(&one, 1, static_cast<int>(std::min(left, look_every).count()) + 1);
    if (ready > 0) return;
    if (ready < 0 && errno != EINTR) fail(std::strerror(errno));
  }
}

Connection::Clock::time_point Connection::begin() {
  if (broken()) fail("the connection was lost");
  return Clock::now() + _settings.call_time;
}

void Connection::fail(const std::string& what) {
  _broken = true;
  auto [line, sqlstate] = parts_of(what);
  throw Failure(std::move(sqlstate), _place, line);
}

void Connection::fail(const pg_result* result) {
  const char* const sqlstate = PQresultErrorField(result, PG_DIAG_SQLSTATE);
  const char* const message = PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY);
  if (sqlstate == nullptr) fail(PQerrorMessage(_connection.get()));  // of libpq itself
  Failure failure(sqlstate, _place, message == nullptr ? "" : message);
  _broken = _broken || failure.policy() == Policy::reconnect;
  throw failure;
}

/// Sends what is to be sent and reads until the server is ready for the next statement; the last
/// result counts, or the first error.
Result Connection::finish(Clock::time_point deadline) {
  pg_conn* const connection = _connection.get();
  for (int left = PQflush(connection); left != 0; left = PQflush(connection)) {
    if (left < 0) fail(PQerrorMessage(connection));
    // The server may be waiting until we read.
    wait(POLLIN | POLLOUT, deadline);
    if (PQconsumeInput(connection) == 0) fail(PQerrorMessage(connection));
  }
  Result last(nullptr);
  Result error(nullptr);
  bool failed = false;
  for (;;) {
    while (PQisBusy(connection) != 0) {
      wait(POLLIN, deadline);
      if (PQconsumeInput(connection) == 0) fail(PQerrorMessage(connection));
    }
    pg_result* const next = PQgetResult(connection);
    if (next == nullptr) break;
    Result result(next);
    const ExecStatusType status = PQresultStatus(next);
    if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK && !failed) {
      failed = true;
      error = std::move(result);
    } else {
      last = std::move(result);
    }
  }
  if (failed) fail(error.get());
  return last;
}

const std::string& Connection::prepared(const std::string& sql, Values values) {
  if (const auto found = _prepared.find(sql); found != _prepared.end()) return found->second;
  const std::string name = fmt::format("s{}", _prepared.size());
  std::vector<Oid> types;
  for (const Value& value : values) types.push_back(value.type());
  const Clock::time_point deadline = begin();
  if (PQsendPrepare(_connection.get(), name.c_str(), sql.c_str(), static_cast<int>(types.size()),
                    types.data()) == 0)
    fail(PQerrorMessage(_connection.get()));
  finish(deadline);
  return _prepared.emplace(sql, name).first->second;
}

Result Connection::run(const std::string& sql, Values values) {
  const std::string& name = prepared(sql, values);
  std::vector<const char*> data;
  std::vector<int> sizes;
  for (const Value& value : values) {
    if (value.size() > std::size_t{std::numeric_limits<int>::max()})
      throw Error(Reason::limit_exceeded, "{} bytes are too many for one value of the database",
                  value.size());
    data.push_back(value.data());
    sizes.push_back(static_cast<int>(value.size()));
  }
  const std::vector<int> formats(values.size(), 1);
  const Clock::time_point deadline = begin();
  if (PQsendQueryPrepared(_connection.get(), name.c_str(), static_cast<int>(values.size()),
                          data.data(), sizes.data(), formats.data(), 1) == 0)
    fail(PQerrorMessage(_connection.get()));
  return finish(deadline);
}

void Connection::execute(const std::string& sql) {
  const Clock::time_point deadline = begin();
  if (PQsendQuery(_connection.get(), sql.c_str()) == 0) fail(PQerrorMessage(_connection.get()));
  finish(deadline);
}

void Connection::commit() {
  if (PQtransactionStatus(_connection.get()) == PQTRANS_INERROR) {
    _broken = true;
    throw Error(Reason::internal, "a transaction is to be committed that has failed");
  }
  _stoppable = false;
  try {
    execute("COMMIT");
  } catch (...) {
    _stoppable = true;
    throw;
  }
  _stoppable = true;
}

bool Connection::notification(std::string& channel, std::string& payload) {
  if (broken() || PQconsumeInput(_connection.get()) == 0) fail(PQerrorMessage(_connection.get()));
  const std::unique_ptr<PGnotify, void (*)(void*)> notify(PQnotifies(_connection.get()), PQfreemem);
  if (!notify) return false;
  channel = notify->relname;
  payload = notify->extra;
  return true;
}

}  // namespace anticrack::postgres
