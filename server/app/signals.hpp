// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <functional>
#include <optional>

namespace anticrack::app {

/// Waits for SIGTERM, SIGINT and SIGHUP and ignores SIGPIPE. Uses handlers that write to a pipe:
/// the signals cannot be blocked, as OpenBLAS starts threads before main. One object at a time.
class Signals {
 public:
  /// Throws std::system_error if the system refuses a pipe or a handler.
  Signals();
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// Waits for a signal and returns its number.
  int wait() const;
  /// The same, but waits at most `time`; none if there was no signal.
  std::optional<int> wait_for(std::chrono::milliseconds time) const;
  /// Runs `work` on another thread. A signal other than SIGHUP ends the process at once with status
  /// 128 + number.
  void run_unless_interrupted(const std::function<void()>& work) const;

 private:
  int _reader = -1;
};

}  // namespace anticrack::app
