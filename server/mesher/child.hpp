// SPDX-License-Identifier: GPL-3.0-or-later
//
// A child process that communicates over one socket.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/descriptor.hpp"

namespace anticrack::mesher {

/// A child process in its own process group. socket() is its standard input and output; its
/// standard error is the parent's. It inherits at most one other descriptor and a minimal
/// environment. The destructor kills and reaps it. A socket instead of pipes allows MSG_NOSIGNAL:
/// no SIGPIPE in the server when the helper dies.
class Child {
 public:
  /// The number that the file has in the child.
  static constexpr int file_descriptor = 3;

  /// Starts the child. `file`, unless empty, becomes its `file_descriptor`. Throws
  /// std::system_error, also for a missing executable.
  Child(const std::string& executable, const std::vector<std::string>& arguments,
        base::Descriptor file);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int socket() const noexcept { return _socket.get(); }
  /// Sends what the socket takes now, and returns its size; 0 also if the child no longer reads.
  std::size_t send(std::span<const std::byte> bytes);
  /// Ends the child's input.
  void end_input() noexcept;
  /// Sends SIGKILL to its whole process group.
  void kill() noexcept;
  /// Reaps the child if it has ended; then returns true, and status() is that of waitpid.
  bool ended() noexcept;
  int status() const noexcept { return _status; }

 private:
  base::Descriptor _socket;
  pid_t _pid = -1;
  bool _ended = false;
  int _status = 0;
};

}  // namespace anticrack::mesher
