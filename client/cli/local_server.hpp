// SPDX-License-Identifier: GPL-3.0-or-later
//
// The option --local: an anticrackd for one command.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>

namespace anticrack::cli {

/// The error if the server could not be started, or has ended.
class LocalServerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An anticrackd --private, found beside this executable or on PATH. It uses its own temporary
/// folders, which it removes when it ends, and it ends when this process does, however that ends.
class LocalServer {
 public:
  /// Starts the server and returns once it listens. Throws LocalServerError with the end of the
  /// server's log, and client::Interrupted on `stop`.
  explicit LocalServer(const std::stop_token& stop);
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  const std::string& address() const noexcept { return _address; }
  /// To be called after a lost connection: throws LocalServerError, with the cause of its end and
  /// its last messages, if the server has ended. Thread-safe.
  void require_alive();
  /// Asks the server to end; the destructor waits until it has.
  void ask_to_end() noexcept;

 private:
  void start(const std::filesystem::path& program);
  void wait_until_ready(const std::stop_token& stop);
  bool has_ended(std::chrono::milliseconds patience) noexcept;
  void end() noexcept;
  std::string last_words() const;

  std::string _address;
  std::mutex _mutex;  ///< guards the next two
  pid_t _process = -1;
  std::optional<int> _status;  ///< status of waitpid, once the server has ended
  int _lifeline = -1;  ///< the server's standard input and output; it ends with this process
  int _log = -1;       ///< a file in memory
};

}  // namespace anticrack::cli
