// SPDX-License-Identifier: GPL-3.0-or-later
//
// --local: an anticrackd for one command.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <stdexcept>
#include <stop_token>
#include <string>

namespace anticrack::cli {

/// The server could not be started.
class LocalServerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An anticrackd, found beside this executable or on PATH, on a unix socket in a new temporary
/// folder, both removed at the end. The server also stops when this process, or the thread that
/// started it, dies. Create it before gRPC is used (it forks).
class LocalServer {
 public:
  /// Returns once the server listens. Throws LocalServerError with the end of the server's log, and
  /// client::Interrupted on `stop`.
  explicit LocalServer(const std::stop_token& stop);
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  const std::string& address() const noexcept { return _address; }

 private:
  void start(const std::filesystem::path& program);
  void wait_until_ready(const std::stop_token& stop);
  void stop_process() noexcept;
  std::string last_words() const;

  std::filesystem::path _folder;
  std::string _address;
  pid_t _process = -1;
  int _output = -1;
};

/// The anticrackd beside `executable`, else the first on `search_path` (as PATH); empty for none.
std::filesystem::path find_server(const std::filesystem::path& executable,
                                  const std::string& search_path);

}  // namespace anticrack::cli
