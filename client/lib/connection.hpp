// SPDX-License-Identifier: GPL-3.0-or-later
//
// A connection to anticrackd. Made at once, without a word on the wire: the first call connects.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "credentials.hpp"
#include "retry.hpp"

namespace anticrack::client {

inline constexpr std::string_view default_address = "localhost:7433";

struct ConnectionOptions {
  std::string address{default_address};        ///< HOST:PORT or unix:PATH
  Credentials credentials;                     ///< none: unencrypted, as nobody
  std::chrono::milliseconds deadline{30'000};  ///< of one try of a unary call
  RetryPolicy retry;                           ///< once the server has answered
  /// Patience before the first answer: a wrong address should not take a minute to say so.
  std::chrono::milliseconds first_contact{3'000};
  /// Told, for people, when a call is about to be tried again, or a watch begins anew. May be
  /// empty.
  std::function<void(const std::string&)> notice;
};

/// Thread-safe, as far as `notice` is; must outlive the calls made with it. Bulk reads have a
/// channel of their own, so that events are not queued behind them.
class Connection {
 public:
  /// Throws nothing of its own: an address where nobody answers is found out by the first call.
  explicit Connection(ConnectionOptions options);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// As it was given.
  const std::string& address() const noexcept;

  struct State;  ///< gRPC's side, for the sources of this library only
  State& state() noexcept { return *_state; }

 private:
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::client
