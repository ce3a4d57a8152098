// SPDX-License-Identifier: GPL-3.0-or-later
#include "postgres/connection.hpp"

#include <libpq-fe.h>
#include <poll.h>

#include <algorithm>
#include <utility>

namespace anticrack::postgres {

namespace {

using errors::Error;
using errors::Reason;
using Clock = std::chrono::steady_clock;

/// A network that swallows packets must not hold a thread for longer.
constexpr std::chrono::seconds patience{10};
constexpr std::chrono::milliseconds try_again_in{1'000};

std::string one_line(const char* message) {
  std::string text = message == nullptr ? "" : message;
  std::ranges::replace(text, '\n', ' ');
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

[[noreturn]] void refuse(const PGresult* result) {
  const char* field = PQresultErrorField(result, PG_DIAG_SQLSTATE);
  const std::string state = field == nullptr ? "" : field;
  const std::string message = one_line(PQresultErrorMessage(result));
  if (state == "40001" || state == "40P01" || state == "55P03") throw Conflict(message);
  if (state.starts_with("57P") || state.starts_with("08") || state == "25P03") throw Lost(message);
  if (state.starts_with("53"))
    throw Error(Reason::disk_full, "the database has no room: {}", message)
        .retry_after(try_again_in);
  throw Error(Reason::storage, "the database refused: {} ({})", message, state);
}

}  // namespace

Lost::Lost(const std::string& why)
    : Error(errors::Reason::busy, "the database cannot be reached: {}", why) {
  retry_after(try_again_in);
}

Value Value::blob(std::string_view bytes) {
  Value value(bytes);
  value.binary = true;
  return value;
}

Value Value::list(const std::vector<std::string>& texts) {
  std::string all = "{";
  for (const std::string& text : texts) {
    if (all.size() > 1) all += ',';
    all += '"';
    for (const char c : text) {
      if (c == '"' || c == '\\') all += '\\';
      all += c;
    }
    all += '"';
  }
  return all + "}";
}

Rows::Rows(pg_result* result) : _result(result, PQclear) {}
int Rows::size() const { return PQntuples(_result.get()); }
bool Rows::is_null(int row, int column) const {
  return PQgetisnull(_result.get(), row, column) != 0;
}
std::string Rows::text(int row, int column) const {
  return {PQgetvalue(_result.get(), row, column),
          static_cast<std::size_t>(PQgetlength(_result.get(), row, column))};
}
std::int64_t Rows::integer(int row, int column) const {
  const std::string bytes = text(row, column);
  std::uint64_t number = !bytes.empty() && (bytes[0] & 0x80) != 0 ? ~std::uint64_t{0} : 0;
  for (const char byte : bytes) number = number << 8U | static_cast<unsigned char>(byte);
  return static_cast<std::int64_t>(number);
}
std::uint64_t Rows::affected() const {
  const std::string count = PQcmdTuples(_result.get());
  return count.empty() ? 0 : std::stoull(count);
}

Connection::Connection(const std::string& url)
    : _connection(PQconnectStart(url.c_str()), PQfinish) {
  if (PQstatus(_connection.get()) == CONNECTION_BAD)
    throw Lost(one_line(PQerrorMessage(_connection.get())));
  const auto until = Clock::now() + patience;
  for (PostgresPollingStatusType state = PGRES_POLLING_WRITING; state != PGRES_POLLING_OK;
       state = PQconnectPoll(_connection.get())) {
    if (state == PGRES_POLLING_FAILED) throw Lost(one_line(PQerrorMessage(_connection.get())));
    if (!wait(state == PGRES_POLLING_READING ? POLLIN : POLLOUT, until))
      throw Lost("it does not answer");
  }
  PQsetnonblocking(_connection.get(), 1);
  script(
      "SET synchronous_commit = on; SET idle_in_transaction_session_timeout = '10s'; "
      "SET client_min_messages = warning");
}

bool Connection::wait(short events, Clock::time_point until) {
  const int socket = PQsocket(_connection.get());
  if (socket < 0) throw Lost(one_line(PQerrorMessage(_connection.get())));
  pollfd one{socket, events, 0};
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count();
  return ::poll(&one, 1, static_cast<int>(std::max<std::int64_t>(0, left))) > 0;
}

Rows Connection::run(const std::string& sql, const std::vector<Value>& values) {
  std::vector<const char*> bytes;
  std::vector<int> lengths, formats;
  for (const Value& value : values) {
    bytes.push_back(value.bytes.c_str());
    lengths.push_back(static_cast<int>(value.bytes.size()));
    formats.push_back(value.binary ? 1 : 0);
  }
  constexpr int binary = 1;
  if (PQsendQueryParams(_connection.get(), sql.c_str(), static_cast<int>(values.size()), nullptr,
                        bytes.data(), lengths.data(), formats.data(), binary) == 0)
    throw Lost(one_line(PQerrorMessage(_connection.get())));
  return result();
}

void Connection::script(const std::string& sql) {
  if (PQsendQuery(_connection.get(), sql.c_str()) == 0)
    throw Lost(one_line(PQerrorMessage(_connection.get())));
  result();
}

Rows Connection::result() {
  const auto until = Clock::now() + patience;
  Rows last(nullptr);
  for (;;) {
    int unsent = PQflush(_connection.get());
    while (unsent > 0 || PQisBusy(_connection.get()) != 0) {
      if (!wait(static_cast<short>(unsent > 0 ? POLLIN | POLLOUT : POLLIN), until))
        throw Lost("it does not answer");
      if (PQconsumeInput(_connection.get()) == 0)
        throw Lost(one_line(PQerrorMessage(_connection.get())));
      if (unsent > 0) unsent = PQflush(_connection.get());
    }
    if (unsent < 0) throw Lost(one_line(PQerrorMessage(_connection.get())));
    PGresult* const next = PQgetResult(_connection.get());
    if (next == nullptr) break;
    last = Rows(next);
    const ExecStatusType status = PQresultStatus(next);
    if (status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK) continue;
    if (PQstatus(_connection.get()) == CONNECTION_BAD)
      throw Lost(one_line(PQresultErrorMessage(next)));
    while (PGresult* const rest = PQgetResult(_connection.get())) PQclear(rest);
    refuse(next);
  }
  return last;
}

std::string Connection::notification(std::chrono::milliseconds time) {
  const auto until = Clock::now() + time;
  for (;;) {
    if (PGnotify* const came = PQnotifies(_connection.get())) {
      std::string channel = came->relname;
      PQfreemem(came);
      return channel;
    }
    if (!wait(POLLIN, until)) return {};
    if (PQconsumeInput(_connection.get()) == 0)
      throw Lost(one_line(PQerrorMessage(_connection.get())));
  }
}

}  // namespace anticrack::postgres
