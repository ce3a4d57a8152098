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

/// Handles the signals while it lives, except those ignored before (nohup). Create it before any
/// other thread: threads inherit the blocked signals. The third Ctrl-C, SIGTERM or SIGHUP ends the
/// process at once. SIGPIPE is ignored.
class Signals {
 public:
  /// Events that affect a frame on the terminal.
  enum class Screen {
    leaving,  ///< the process is about to be stopped (Ctrl-Z) or ended
    back,     ///< it continues; others may have written meanwhile
    resized,
  };

  /// Starts a thread that waits for them.
  Signals();
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// From here on a closed pipe ends the process, as it does other programs: for a command that has
  /// nothing to save.
  void end_on_closed_output() noexcept;

  /// Requested by the first Ctrl-C, SIGTERM or SIGHUP.
  std::stop_token first() const noexcept { return _first.get_token(); }
  /// Waits for the first signal, or for `stop`; whether the signal came.
  bool wait_for_first(const std::stop_token& stop);
  /// Waits for the second signal, or for `stop`; whether the signal came. Does not wait if the
  /// first was not Ctrl-C.
  bool second_within(std::chrono::milliseconds time, const std::stop_token& stop = {});
  /// Whether all that came was Ctrl-C.
  bool interactive();

  /// Sets the function to call on the thread of the signals, in place of the last one; may be
  /// empty.
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
