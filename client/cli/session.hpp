// SPDX-License-Identifier: GPL-3.0-or-later
//
// What all commands use: global options, output, the connection to a server.
#pragma once

#include <cstdio>
#include <functional>
#include <initializer_list>
#include <mutex>
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
  bool quiet = false;  ///< print only errors and the requested output
  /// Whether standard output is a file of the command, as with -o -; text for users then goes to
  /// standard error.
  bool output_taken = false;
};

/// The globals for a command that writes to these paths; empty paths do not count. Throws
/// UsageError if standard output would get two things.
Globals with_outputs(const Globals& globals, std::initializer_list<std::string> paths);

/// The stream for messages: standard output, or standard error if standard output is for programs.
std::FILE* people(const Globals& globals);
/// Whether messages are frames drawn over each other instead of lines.
bool shows_frames(const Globals& globals);
/// Prints a message; nothing with --quiet.
void say(const Globals& globals, std::string_view line);
/// The same for a message that --quiet does not silence; it then goes to standard error.
void say_always(const Globals& globals, std::string_view line);
/// Prints an error to standard error.
void complain(std::string_view line);
/// Prints the document of --json, or the answer of a command. As with `say`, a failure of standard
/// output is reported at the end of the command, by output::print_failure.
void print_document(std::string_view text);
/// Prints the answer of a command that also writes files, for users.
void print_answer(const Globals& globals, std::string_view text);

/// Says that a resource was deleted.
void tell_deleted(const Globals& globals, const std::string& name);

class Session {
 public:
  /// Throws LocalServerError, and client::Error for credentials that cannot be used.
  explicit Session(const Globals& globals);

  client::Connection& connection() noexcept { return *_connection; }
  Signals& signals() noexcept { return _signals; }
  /// To be called when nothing more is asked of the server: a private one ends meanwhile.
  void leave_server() noexcept {
    if (_local) _local->ask_to_end();
  }
  /// The token that the first signal requests.
  std::stop_token stop() const noexcept { return _signals.first(); }
  const Globals& globals() const noexcept { return _globals; }
  /// The flags that lead to this server, for the end of a command line; may be empty.
  std::string server_option() const;

  /// Sets the receiver of messages about retries; empty: standard error, each message once.
  void tell(std::function<void(const std::string&)> listener) {
    const std::lock_guard lock(_mutex);
    _listener = std::move(listener);
  }

 private:
  void notice(const std::string& message);

  Globals _globals;
  Signals _signals;  // first, as all threads inherit its mask
  std::optional<LocalServer> _local;
  std::optional<client::Connection> _connection;
  std::mutex _mutex;  ///< guards the next two, as calls are made on several threads
  std::function<void(const std::string&)> _listener;
  std::string _last_notice;
};

}  // namespace anticrack::cli
