// SPDX-License-Identifier: GPL-3.0-or-later
//
// A process with which the parent speaks over one socket.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace anticrack::mesher {

/// Closes on destruction.
class Descriptor {
 public:
  explicit Descriptor(int value = -1) noexcept : _value(value) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : _value(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  /// -1 where it is empty.
  int get() const noexcept { return _value; }
  /// Whether there is nothing to close.
  bool empty() const noexcept { return _value < 0; }
  /// Closes it now.
  void reset() noexcept;

 private:
  int release() noexcept;
  int _value;
};

/// A child process in its own process group, its standard input and output on the other end of
/// socket(); its standard error is the parent's. It inherits at most one other descriptor and a
/// minimal environment. Killed and reaped on destruction at the latest.
///
/// A socket and not a pair of pipes: MSG_NOSIGNAL keeps a helper that died from raising SIGPIPE in
/// the server.
class Child {
 public:
  /// Where the child finds its file.
  static constexpr int file_descriptor = 3;

  /// `file`: becomes the child's `file_descriptor`; the parent may close its own right after. An
  /// empty one: the child gets none. Throws std::system_error, for a missing executable too.
  Child(const std::string& executable, const std::vector<std::string>& arguments, Descriptor file);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int socket() const noexcept { return _socket.get(); }
  /// Sends what the socket takes now; how much. 0 also when the child no longer reads.
  std::size_t send(std::span<const std::byte> bytes);
  /// Tells the child that nothing more comes.
  void end_input() noexcept;
  /// SIGKILL to its whole process group.
  void kill() noexcept;
  /// Reaps it: true once it has ended, then status() is what waitpid gave.
  bool ended() noexcept;
  int status() const noexcept { return _status; }

 private:
  Descriptor _socket;
  pid_t _pid = -1;
  bool _ended = false;
  int _status = 0;
};

}  // namespace anticrack::mesher
