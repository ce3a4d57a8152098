// SPDX-License-Identifier: GPL-3.0-or-later
//
// One connection to PostgreSQL, over libpq. It never blocks without a deadline: libpq sends and
// receives without waiting, and poll() waits, looking at the thread's stop token (stop/stop.hpp).
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>

#include "postgres/address.hpp"
#include "postgres/failure.hpp"
#include "postgres/value.hpp"

struct pg_conn;
struct pg_result;

namespace anticrack::postgres {

struct Settings {
  Address address;
  std::string name = "anticrackd";  ///< application_name: how the database lists its connections
  std::size_t connections = 8;      ///< of a pool, at most
  std::chrono::milliseconds connect_time{3'000};  ///< for an attempt to connect to one server
  std::chrono::milliseconds call_time{10'000};    ///< for a statement, its waits for locks included
  /// How long a transaction is tried again before its error is reported.
  std::chrono::milliseconds patience{5'000};
  /// Told how long each transaction and statement took that was done; may be empty.
  std::function<void(std::chrono::duration<double>)> answered{};
};

/// The rows of a statement, in binary format. Rows and columns count from 0.
class Result {
 public:
  explicit Result(pg_result* result) noexcept : _result(result, clear) {}
  std::size_t rows() const noexcept;
  bool empty() const noexcept { return rows() == 0; }
  std::size_t affected() const noexcept;  ///< rows that the statement changed
  bool is_null(std::size_t row, int column) const noexcept;
  /// An integer of any size, or a boolean; 0 for null. Throws errors::Error (internal) for others.
  std::int64_t integer(std::size_t row, int column) const;
  /// A text or a bytea; empty for null. The view lives as long as the result.
  std::string_view view(std::size_t row, int column) const noexcept;
  std::string text(std::size_t row, int column) const { return std::string(view(row, column)); }
  /// An integer that is not negative.
  std::uint64_t count(std::size_t row, int column) const {
    return static_cast<std::uint64_t>(integer(row, column));
  }
  /// What make(row) returns for each row, in their order; the texts of the first column.
  template <class Make>
  auto each(const Make& make) const {
    std::vector<decltype(make(std::size_t{}))> made;
    for (std::size_t row = 0; row < rows(); ++row) made.push_back(make(row));
    return made;
  }
  std::vector<std::string> texts() const {
    return each([this](std::size_t row) { return text(row, 0); });
  }
  const pg_result* get() const noexcept { return _result.get(); }

 private:
  static void clear(pg_result* result) noexcept;
  std::unique_ptr<pg_result, void (*)(pg_result*)> _result;
};

/// Belongs to one thread at a time. Calls throw Failure, and errors::Error (cancelled) where the
/// thread is to stop; after a lost connection, a passed deadline or a stop it is broken(). The
/// schema of the names in statements is `anticrack`.
class Connection {
 public:
  /// Connects to one of the servers that can be written to. O(a round trip of some messages); the
  /// lookup of a host's name is the system's and has no deadline of ours.
  Connection(const Settings& settings, const Options& server);

  /// Runs one statement with parameters $1, $2, ...; it is prepared once. `sql` must be the same
  /// text each time, not one made of values.
  Result run(const std::string& sql, Values values = {});
  /// Runs statements without parameters; several are one transaction.
  void execute(const std::string& sql);
  /// Runs a statement that ends a transaction, which no stop interrupts.
  void commit();

  bool broken() const noexcept;
  int socket() const noexcept;
  /// The next notification (channel and payload) that has arrived; false if there is none. Reads
  /// what the socket has; does not wait.
  bool notification(std::string& channel, std::string& payload);

 private:
  using Clock = std::chrono::steady_clock;
  struct Finish {
    void operator()(pg_conn* connection) const noexcept;
  };

  void connect(const Options& server);
  void wait(short events, Clock::time_point deadline);
  Result finish(Clock::time_point deadline);
  Clock::time_point begin();
  [[noreturn]] void fail(const std::string& what);
  [[noreturn]] void fail(const pg_result* result);
  const std::string& prepared(const std::string& sql, Values values);

  const Settings& _settings;
  std::string _place;
  std::unique_ptr<pg_conn, Finish> _connection;
  std::unordered_map<std::string, std::string> _prepared;
  bool _broken = false;
  bool _stoppable = true;
};

}  // namespace anticrack::postgres
