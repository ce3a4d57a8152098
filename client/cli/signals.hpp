// SPDX-License-Identifier: GPL-3.0-or-later
//
// Ctrl-C, SIGTERM and SIGHUP as stop tokens, and the signals of a terminal.
#pragma once

#include <signal.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace anticrack::cli {

/// Handles the signals while it lives, except those that were ignored before (nohup). Create it
/// before any other thread, as threads inherit the blocked signals. The third Ctrl-C, SIGTERM or
/// SIGHUP ends the process at once. SIGPIPE is ignored.
class Signals {
 public:
  /// Events that affect a frame on the terminal.
  enum class Screen {
    leaving,  ///< the process is about to be stopped (Ctrl-Z) or ended
    back,     ///< the process continues; others may have written meanwhile
    resized,
  };

  /// Starts a thread that waits for the signals.
  Signals();
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// From now on a closed pipe ends the process, as it ends other programs. For a command that has
  /// nothing to save.
  void end_on_closed_output() noexcept;

  /// The token that the first Ctrl-C, SIGTERM or SIGHUP requests.
  std::stop_token first() const noexcept { return _first.get_token(); }
  /// Waits for the first signal, or for `stop`; returns whether the signal came.
  bool wait_for_first(const std::stop_token& stop);
  /// Waits for the second signal, or for `stop`; returns whether the signal came. Does not wait if
  /// the first was not Ctrl-C.
  bool second_within(std::chrono::milliseconds time, const std::stop_token& stop = {});
  /// Whether all signals so far were Ctrl-C.
  bool interactive();

  /// Replaces the function that is called on the thread of the signals; may be empty.
  void tell_screen(std::function<void(Screen)> listener);

 private:
  void listen();
  void end_asked_for(int number);
  void stop_as_asked();
  void screen(Screen event);

  const sigset_t _set;
  std::stop_source _first;
  std::mutex _mutex;
  std::condition_variable_any _came;
  int _count = 0;
  bool _interactive = true;
  std::mutex _screen_mutex;
  std::function<void(Screen)> _screen;
  std::thread _thread;
};

}  // namespace anticrack::cli
