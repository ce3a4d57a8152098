// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "rpc/connection_table.hpp"
#include "rpc/listener.hpp"

namespace anticrack::rpc {

/// Takes connections on a thread of its own, as many as the limits allow, and passes them on. One
/// beyond them is closed at once. Where the system has no descriptor left, connections are closed,
/// or wait, until it has.
class Acceptor {
 public:
  /// Gets a connection, which it owns from then on, and the socket that listened.
  using Take = std::function<void(int listener, int connection)>;

  /// Listens when it returns; throws as Listener does. Takes nothing before start().
  Acceptor(const std::string& listen, ConnectionLimits limits);
  /// stop().
  ~Acceptor();
  Acceptor(const Acceptor&) = delete;
  Acceptor& operator=(const Acceptor&) = delete;

  /// To be called once.
  void start(Take take);
  /// Listens no more, when it returns; connections stay open. Idempotent.
  void stop();
  /// HOST:PORT with the real port, or unix:PATH.
  const std::string& address() const noexcept { return _address; }

  struct Counts {
    int open = 0;
    std::uint64_t accepted = 0;
    std::uint64_t refused = 0;
  };
  /// Thread-safe. O(connections).
  Counts counts();

 private:
  void run();
  bool accept_one(int listener);
  bool refuse_one(int listener);
  void note_refusal(const std::string& address, const char* why);

  std::optional<Listener> _listener;
  const std::string _address;
  const base::Descriptor _wake;
  std::optional<base::Descriptor> _spare;  ///< given up to refuse where there is no other
  Take _take;

  std::mutex _mutex;  ///< of the two
  ConnectionTable _table;
  Counts _counts;

  std::uint64_t _unsaid = 0;  ///< refusals that the log does not have yet
  ConnectionTable::Clock::time_point _next_word{};
  std::thread _thread;  ///< declared last: it uses the others
};

}  // namespace anticrack::rpc
