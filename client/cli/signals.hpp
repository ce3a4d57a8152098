// SPDX-License-Identifier: GPL-3.0-or-later
//
// Ctrl-C, SIGTERM and SIGHUP as stop tokens.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

namespace anticrack::cli {

/// Takes the signals over for as long as it lives. Make it before any other thread: threads inherit
/// that the signals are blocked. The third signal ends the process at once. SIGPIPE is ignored.
class Signals {
 public:
  /// Begins to wait for them, on a thread of its own.
  Signals();
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// Requested when that signal comes.
  std::stop_token first() const noexcept { return _first.get_token(); }
  std::stop_token second() const noexcept { return _second.get_token(); }
  /// Waits for the second signal; whether it came. No wait where the first one was not Ctrl-C:
  /// nobody is there to send another.
  bool second_within(std::chrono::milliseconds time);

 private:
  void listen();

  std::stop_source _first;
  std::stop_source _second;
  std::mutex _mutex;
  std::condition_variable _came;
  int _count = 0;
  bool _interactive = true;
  std::thread _thread;
};

}  // namespace anticrack::cli
