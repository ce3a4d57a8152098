// SPDX-License-Identifier: GPL-3.0-or-later
//
// --local: an anticrackd for one command.
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

/// The server could not be started, or has ended.
class LocalServerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An anticrackd --private, found beside this executable or on PATH: it lives in temporary folders
/// of its own, which it removes when it ends, and ends when this process does, however that ends.
class LocalServer {
 public:
  /// Returns once the server listens. Throws LocalServerError with the end of the server's log, and
  /// client::Interrupted on `stop`.
  explicit LocalServer(const std::stop_token& stop);
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  const std::string& address() const noexcept { return _address; }
  /// For who has lost the connection: throws LocalServerError if the server has ended, with how it
  /// did and what it said last. Thread-safe.
  void require_alive();

 private:
  void start(const std::filesystem::path& program);
  void wait_until_ready(const std::stop_token& stop);
  bool has_ended(std::chrono::milliseconds patience) noexcept;
  void end() noexcept;
  std::string last_words() const;

  std::string _address;
  std::mutex _mutex;  ///< of the two below
  pid_t _process = -1;
  std::optional<int> _status;  ///< as of waitpid, once it has ended
  int _lifeline = -1;          ///< the server's standard input, which ends with this process
  int _output = -1;
  int _log = -1;  ///< a file in memory
};

}  // namespace anticrack::cli
