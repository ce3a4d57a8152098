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

/// Accepts connections on a thread of its own, as many as the limits allow, and passes them on.
/// Further ones are closed at once. If the system has no descriptor left, connections are closed,
/// or wait, until it has.
class Acceptor {
 public:
  /// Takes a connection, which it owns from then on, and the socket that listened.
  using Take = std::function<void(int listener, int connection)>;

  /// Begins to listen; throws as Listener does. Accepts nothing before start().
  Acceptor(const std::string& listen, ConnectionLimits limits);
  /// Calls stop().
  ~Acceptor();
  Acceptor(const Acceptor&) = delete;
  Acceptor& operator=(const Acceptor&) = delete;

  /// Begins to accept. To be called once.
  void start(Take take);
  /// Stops listening; connections stay open. Idempotent.
  void stop();
  /// HOST:PORT with the real port, or unix:PATH.
  const std::string& address() const noexcept { return _address; }

  struct Counts {
    int open = 0;
    std::uint64_t accepted = 0;
    std::uint64_t refused = 0;
  };
  /// The numbers of connections. Thread-safe. O(connections).
  Counts counts();

 private:
  void run();
  bool accept_one(int listener);
  bool refuse_one(int listener);
  void note_refusal(const std::string& address, const char* why);

  std::optional<Listener> _listener;
  const std::string _address;
  const base::Descriptor _wake;
  std::optional<base::Descriptor> _spare;  ///< closed to refuse if there is no other one
  Take _take;

  std::mutex _mutex;  ///< guards the next two
  ConnectionTable _table;
  Counts _counts;

  std::uint64_t _unsaid = 0;  ///< refusals not logged yet
  ConnectionTable::Clock::time_point _next_word{};
  std::thread _thread;  ///< declared last: it uses the others
};

}  // namespace anticrack::rpc
