// SPDX-License-Identifier: GPL-3.0-or-later
//
// A connection to anticrackd. The first call connects.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "credentials.hpp"
#include "retry.hpp"

namespace anticrack::client {

inline constexpr std::string_view default_address = "127.0.0.1:7433";

struct ConnectionOptions {
  std::string address{default_address};        ///< HOST:PORT or unix:PATH
  Credentials credentials;                     ///< empty: unencrypted and anonymous
  std::chrono::milliseconds deadline{30'000};  ///< time limit of one try of a unary call
  RetryPolicy retry;                           ///< policy once the server has answered
  /// Time limit of retries before the first answer: a wrong address should fail soon.
  std::chrono::milliseconds first_contact{3'000};
  /// Called with a message for the user before a call is retried or a watch restarts. May be empty.
  std::function<void(const std::string&)> notice;
  /// Called when the connection is lost, before a call is retried. An exception that it throws ends
  /// the call, for example if the server is known to be gone for good. May be empty; called on
  /// several threads.
  std::function<void()> lost;
};

/// Thread-safe if `notice` is; must outlive the calls made with it. Bulk reads have a separate
/// channel, so that events are not queued behind them.
class Connection {
 public:
  /// Does not check the address; the first call does.
  explicit Connection(ConnectionOptions options);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// The address as it was given.
  const std::string& address() const noexcept;

  struct State;  ///< the gRPC part, for this library only
  State& state() noexcept { return *_state; }

 private:
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::client
