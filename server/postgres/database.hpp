// SPDX-License-Identifier: GPL-3.0-or-later
//
// A few connections to one database, and what is done when one breaks.
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "postgres/connection.hpp"

namespace anticrack::postgres {

/// Thread-safe.
class Database {
 public:
  /// Connects once. Throws errors::Error (storage) with libpq's reason.
  explicit Database(std::string url);

  /// Calls work(connection) and returns what it returns. It is called again, on another connection
  /// where the first broke, until it succeeds or `retry_for` has passed: `work` must not mind that
  /// an earlier call was done and only its answer lost.
  template <class Work>
  auto run(const Work& work) {
    const auto until = std::chrono::steady_clock::now() + retry_for;
    for (;;) {
      try {
        Connection connection = take();
        try {
          auto result = work(connection);
          give(std::move(connection));
          return result;
        } catch (const Lost&) {
          throw;
        } catch (...) {
          give(std::move(connection));
          throw;
        }
      } catch (const Lost&) {
        if (std::chrono::steady_clock::now() >= until) throw;
      } catch (const Conflict&) {
        if (std::chrono::steady_clock::now() >= until) throw;
      }
      std::this_thread::sleep_for(pause);
    }
  }
  /// The same in a transaction.
  template <class Work>
  auto transact(const Work& work) {
    return run([&](Connection& connection) {
      connection.script("BEGIN");
      try {
        auto result = work(connection);
        connection.script("COMMIT");
        return result;
      } catch (const Lost&) {
        throw;
      } catch (...) {
        connection.script("ROLLBACK");
        throw;
      }
    });
  }
  /// A connection of its own, for a listener.
  Connection another() const { return Connection(_url); }

 private:
  static constexpr std::chrono::milliseconds retry_for{3'000}, pause{20};
  static constexpr std::size_t most_kept = 8;

  Connection take();
  void give(Connection connection);

  const std::string _url;
  std::mutex _mutex;
  std::vector<Connection> _free;
};

}  // namespace anticrack::postgres
