// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a command that talks to a server works with.
#pragma once

#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "cli/connection_flags.hpp"
#include "cli/local_server.hpp"
#include "cli/signals.hpp"
#include "client/connection.hpp"

namespace anticrack::cli {

/// Options of every command.
struct Globals {
  ConnectionFlags connection;
  bool local = false;
  bool json = false;
  bool quiet = false;  ///< plain lines also on a terminal
};

/// Where people are told what goes on: standard output, with --json standard error.
std::FILE* people(const Globals& globals);
/// Whether people see frames that are drawn over each other there, rather than lines.
bool shows_frames(const Globals& globals);
/// A line for people.
void say(const Globals& globals, std::string_view line);
/// The one document of --json, or what a command was asked to show.
void print_document(std::string_view text);

/// That a resource is gone.
void tell_deleted(const Globals& globals, const std::string& name);

class Session {
 public:
  /// Throws LocalServerError, and client::Error for credentials that cannot be used.
  explicit Session(const Globals& globals);

  client::Connection& connection() noexcept { return *_connection; }
  Signals& signals() noexcept { return _signals; }
  /// Requested by the first signal.
  std::stop_token stop() const noexcept { return _signals.first(); }
  const Globals& globals() const noexcept { return _globals; }
  /// What leads to this server at the end of a command line; empty where not needed.
  std::string server_option() const;

  /// Who is told of retries; empty: standard error, each message once.
  void tell(std::function<void(const std::string&)> listener) { _listener = std::move(listener); }

 private:
  void notice(const std::string& message);

  Globals _globals;
  Signals _signals;                   // first: all threads shall inherit its mask
  std::optional<LocalServer> _local;  // second: it forks, and gRPC starts threads
  std::optional<client::Connection> _connection;
  std::function<void(const std::string&)> _listener;
  std::string _last_notice;
};

}  // namespace anticrack::cli
