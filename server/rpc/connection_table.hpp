// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>

namespace anticrack::rpc {

struct ConnectionLimits {
  int all = 0;
  int an_address = 0;
};

enum class Admitted { yes, full, address_full };

/// The open connections and their addresses. gRPC does not tell when it closes one, so closed ones
/// are found by asking the system when no room is left, at most every `patience`. Not thread-safe.
class ConnectionTable {
 public:
  using Clock = std::chrono::steady_clock;
  /// Whether the descriptor still is the socket with this number of the system.
  using IsOpen = std::function<bool(int descriptor, std::uint64_t socket)>;

  static constexpr std::chrono::milliseconds patience{20};

  ConnectionTable(ConnectionLimits limits, IsOpen is_open)
      : _limits(limits), _is_open(std::move(is_open)) {}

  /// Notes a connection of `address`, if there is room. One address has at most
  /// ConnectionLimits::an_address and as many as stay free (access/share.hpp), so that a newcomer
  /// finds room. O(1), or O(connections) if no room is left.
  Admitted add(const std::string& address, int descriptor, std::uint64_t socket,
               Clock::time_point now);
  /// The number of open connections. O(connections).
  int open();

 private:
  struct Connection {
    std::uint64_t socket;
    std::string address;
  };

  Admitted judge(const std::string& address) const;
  void forget(int descriptor);
  void forget_closed();

  ConnectionLimits _limits;
  IsOpen _is_open;
  std::unordered_map<int, Connection> _connections;  ///< by descriptor
  std::unordered_map<std::string, int> _by_address;
  Clock::time_point _asked{};
};

}  // namespace anticrack::rpc
