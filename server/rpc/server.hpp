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
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "access/tokens.hpp"
#include "rpc/backend.hpp"

namespace anticrack::rpc {

/// PEM texts.
struct Tls {
  std::string certificate;  ///< of the server, with those between it and the root
  std::string key;
  std::string client_roots;  ///< empty: clients need no certificate; else mutual TLS
};

/// Who is let in. Without tokens and client certificates everybody is an administrator: right for
/// one's own machine only. Health and reflection are open to all.
struct Security {
  std::optional<Tls> tls;           ///< none: nothing is encrypted
  access::TokenTable tokens;        ///< "authorization: Bearer TOKEN"
  std::vector<std::string> admins;  ///< common names of client certificates with that role
};

/// Reported for every call that ended: "/anticrack.v1.SolveService/GetJob", its gRPC code.
using CallListener =
    std::function<void(const std::string& method, int code, std::chrono::duration<double>)>;

struct ServerOptions {
  std::string listen = "127.0.0.1:7433";  ///< HOST:PORT (port 0 picks one) or unix:PATH
  Security security;
  CallListener call_ended;  ///< quick, does not throw
  Limits limits;
  std::chrono::milliseconds heartbeat{10'000};  ///< of a watch where nothing happens
  std::chrono::milliseconds stall{60'000};  ///< then a peer that does not read or send is cut off
};

/// Thread-safe but for the destructor.
class Server {
 public:
  /// Listens and serves when it returns. Throws errors::Error (invalid_argument, field "listen")
  /// when it cannot, and as require_usable() does (rpc/tls.hpp).
  Server(const ServerOptions& options, const Backend& backend);
  /// drain(0s).
  ~Server();

  /// HOST:PORT with the real port, or unix:PATH.
  const std::string& address() const noexcept;

  /// Takes other certificates and tokens, of the same kinds as before: new handshakes and new calls
  /// use them. Throws as require_usable() does (rpc/tls.hpp), and then nothing has changed.
  void replace(const Security& security);

  /// Health says NOT_SERVING from now on; all else goes on. For balancers, which take a moment to
  /// send no more.
  void announce_stop();
  /// Health says NOT_SERVING; new meshes, jobs, watches and transfers are refused (UNAVAILABLE);
  /// the engine is stopped: running jobs go on for at most `grace`, watched; then watches and
  /// transfers end with UNAVAILABLE and a retry delay (a watch whose job ended sends the rest
  /// first), whoever does not take it is broken off, and the server shuts down, three seconds later
  /// at the latest. Idempotent: a second call waits for the first.
  void drain(std::chrono::milliseconds grace);

  struct Metrics {
    int watchers = 0;
    int transfers = 0;
    std::uint64_t largest_lag = 0;  ///< events the slowest watcher is behind
    int connections = 0;            ///< that are open
    std::uint64_t connections_accepted = 0;
    std::uint64_t connections_refused = 0;  ///< beyond a limit
  };
  /// Now.
  Metrics metrics() const;

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::rpc
