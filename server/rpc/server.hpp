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
  std::string certificate;  ///< certificate of the server, with those between it and the root
  std::string key;
  std::string client_roots;  ///< empty: clients need no certificate; else mutual TLS
};

/// Who may call. Without tokens and client certificates everybody is an administrator, which is
/// right for one's own machine only. Health and reflection are open to all.
struct Security {
  std::optional<Tls> tls;           ///< if empty, nothing is encrypted
  access::TokenTable tokens;        ///< "authorization: Bearer TOKEN"
  std::vector<std::string> admins;  ///< common names of client certificates with that role
};

/// Called for every call that ended, with its method like "/anticrack.v1.SolveService/GetJob" and
/// its gRPC code.
using CallListener =
    std::function<void(const std::string& method, int code, std::chrono::duration<double>)>;

struct ServerOptions {
  std::string listen = "127.0.0.1:7433";  ///< HOST:PORT (port 0 picks one) or unix:PATH
  Security security;
  CallListener call_ended;  ///< must be quick and not throw
  Limits limits;
  std::chrono::milliseconds heartbeat{10'000};  ///< interval of a watch's signs of life
  std::chrono::milliseconds stall{60'000};  ///< when to cut off a peer that does not read or send
};

/// Thread-safe, except the destructor.
class Server {
 public:
  /// Begins to listen and serve. Throws errors::Error (invalid_argument, field "listen") if it
  /// cannot, and as require_usable() does (rpc/tls.hpp).
  Server(const ServerOptions& options, const Backend& backend);
  /// Calls drain(0s).
  ~Server();

  /// HOST:PORT with the real port, or unix:PATH.
  const std::string& address() const noexcept;

  /// Replaces certificates and tokens by others of the same kinds; new handshakes and new calls use
  /// them. Throws as require_usable() does (rpc/tls.hpp), and then changes nothing.
  void replace(const Security& security);

  /// Makes health report NOT_SERVING, or SERVING again, while all else goes on. This is for
  /// balancers, which take a moment to stop sending calls.
  void announce(bool serving);
  /// Stops gently. Health reports NOT_SERVING; new meshes, jobs, watches and transfers are refused
  /// (UNAVAILABLE); the engine is stopped: running jobs, and watches of them, go on for at most
  /// `grace`. Then watches and transfers end with UNAVAILABLE and a retry delay (a watch whose job
  /// has ended sends the rest first), streams that do not take their end are broken off, and the
  /// server shuts down, three seconds later at the latest. Idempotent: a second call waits for the
  /// first.
  void drain(std::chrono::milliseconds grace);

  struct Metrics {
    int watchers = 0;
    int transfers = 0;
    std::uint64_t largest_lag = 0;  ///< by how many events the slowest watcher is behind
    int connections = 0;            ///< open connections
    std::uint64_t connections_accepted = 0;
    std::uint64_t connections_refused = 0;  ///< connections refused beyond a limit
  };
  /// The present values.
  Metrics metrics() const;

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::rpc
