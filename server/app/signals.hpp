// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <functional>
#include <optional>

namespace anticrack::app {

/// SIGTERM and SIGINT as something to wait for; SIGPIPE and SIGHUP ignored: nothing is read anew
/// while the server runs, and a closed terminal is no reason to stop. By handlers that write into a
/// pipe: blocking the signals would not do, OpenBLAS starts threads before main which do not
/// inherit that. One object at a time.
class Signals {
 public:
  /// Throws std::runtime_error where the system refuses a pipe or a handler.
  Signals();
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// Waits for a signal and returns its number.
  int wait() const;
  /// The same for at most this long; none: there was no signal.
  std::optional<int> wait_for(std::chrono::milliseconds time) const;
  /// Runs `work` on a thread of its own; a signal meanwhile ends the process at once, with
  /// 128 + its number.
  void run_unless_interrupted(const std::function<void()>& work) const;

 private:
  int _reader = -1;
};

}  // namespace anticrack::app
