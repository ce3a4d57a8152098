// SPDX-License-Identifier: GPL-3.0-or-later
//
// The gRPC server: services, health, reflection, listening, draining.
//
//   rpc::Server server({.listen = "127.0.0.1:0"}, {engine, catalogue, cache, store});
//   std::cout << server.address();
//   ... wait for a signal ...
//   server.drain(3s);
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "rpc/backend.hpp"

namespace anticrack::rpc {

struct ServerOptions {
  std::string listen = "127.0.0.1:7433";  ///< HOST:PORT (port 0 picks one) or unix:PATH
  Limits limits;
  std::chrono::milliseconds heartbeat{10'000};  ///< of a watch where nothing happens
  std::chrono::milliseconds stall{60'000};  ///< then a peer that does not read or send is cut off
};

/// Thread-safe but for the destructor.
class Server {
 public:
  /// Listens and serves when it returns. Throws errors::Error (invalid_argument, field "listen")
  /// when it cannot.
  Server(const ServerOptions& options, const Backend& backend);
  /// drain(0s).
  ~Server();

  /// HOST:PORT with the real port, or unix:PATH.
  const std::string& address() const noexcept;

  /// Health says NOT_SERVING; new meshes, jobs, watches and transfers are refused (UNAVAILABLE);
  /// running jobs go on for at most `grace`, watched; then watches and transfers end with
  /// UNAVAILABLE and a retry delay (a watch whose job ended sends the rest first), whoever does not
  /// take it is broken off, and the server shuts down, three seconds later at the latest.
  /// Idempotent: a second call waits for the first.
  void drain(std::chrono::milliseconds grace);

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::rpc
