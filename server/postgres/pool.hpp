// SPDX-License-Identifier: GPL-3.0-or-later
//
// A bounded number of connections that threads share, and transactions on them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "postgres/connection.hpp"

namespace anticrack::postgres {

/// Thread-safe. Connections are made when they are needed, one attempt after another with growing
/// delays where that fails, and each attempt goes to the next of the address's servers.
class Pool {
 public:
  explicit Pool(Settings settings) : _settings(std::move(settings)) {}
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// A connection for one thread, until the end of the scope.
  class Lease {
   public:
    Lease(Pool& pool, std::unique_ptr<Connection> connection) noexcept
        : _pool(pool), _connection(std::move(connection)) {}
    ~Lease() { _pool.give_back(std::move(_connection)); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    Connection* operator->() const noexcept { return _connection.get(); }
    Connection& operator*() const noexcept { return *_connection; }

   private:
    Pool& _pool;
    std::unique_ptr<Connection> _connection;
  };
  /// Waits for a free connection, at most Settings::call_time. Throws Failure.
  Lease take();

  /// How long the database has been out of reach; 0: it answered last time.
  std::chrono::milliseconds unreachable() const;
  const Settings& settings() const noexcept { return _settings; }

 private:
  using Clock = std::chrono::steady_clock;

  std::unique_ptr<Connection> connect();
  void give_back(std::unique_ptr<Connection> connection) noexcept;

  const Settings _settings;
  mutable std::mutex _mutex;
  std::condition_variable _given_back;
  std::vector<std::unique_ptr<Connection>> _idle;
  std::size_t _open = 0;
  std::size_t _server = 0;  ///< index of the server to try
  unsigned _failures = 0;   ///< attempts to connect that failed since the last that did not
  Clock::time_point _next_try{};
  std::optional<Clock::time_point> _lost_since;
};

/// What the work of transact() is given.
class Transaction {
 public:
  Transaction(Connection& connection, bool repeated)
      : _connection(connection), _repeated(repeated) {}
  Result run(const std::string& sql, Values values = {}) { return _connection.run(sql, values); }
  /// Runs statements without parameters.
  void execute(const std::string& sql) { _connection.execute(sql); }
  /// Whether this work may have been committed before, by a commit whose reply was lost: what it
  /// would make may be there, and what it would remove may be gone.
  bool repeated() const noexcept { return _repeated; }

 private:
  Connection& _connection;
  const bool _repeated;
};

/// Runs `work` in a transaction (read committed) and commits. Where another transaction was in the
/// way or the connection was lost, all of it is done again, for Settings::patience at most; so
/// `work` changes nothing but the database and variables that it sets anew. It must not catch
/// errors of statements. Throws what the last attempt threw; then nothing was written, or, where a
/// commit's reply was lost, all or nothing.
void transact(Pool& pool, const std::function<void(Transaction&)>& work);

/// Runs one statement, which is its own transaction, in the same way.
Result query(Pool& pool, const std::string& sql, Values values = {});

}  // namespace anticrack::postgres
