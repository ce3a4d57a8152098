// SPDX-License-Identifier: GPL-3.0-or-later
//
// Ctrl-C, SIGTERM and SIGHUP as stop tokens, and what a terminal tells by signals.
#pragma once

#include <signal.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace anticrack::cli {

/// Takes the signals over for as long as it lives, but those that were ignored before (nohup). Make
/// it before any other thread: threads inherit that the signals are blocked. The third signal that
/// asks for an end ends the process at once. SIGPIPE is ignored.
class Signals {
 public:
  /// What may have come over a frame on the terminal.
  enum class Screen {
    leaving,  ///< this process is about to be stopped (Ctrl-Z) or ended
    back,     ///< it goes on, perhaps after others have written
    resized,
  };

  /// Begins to wait for them, on a thread of its own.
  Signals();
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// Requested when that signal comes.
  std::stop_token first() const noexcept { return _first.get_token(); }
  /// Waits for the first signal, or for `stop`; whether the signal came.
  bool wait_for_first(const std::stop_token& stop);
  /// Waits for the second signal, or for `stop`; whether the signal came. No wait where the first
  /// one was not Ctrl-C: nobody is there to send another.
  bool second_within(std::chrono::milliseconds time, const std::stop_token& stop = {});
  /// Whether all that came was Ctrl-C.
  bool interactive();

  /// Who is told of the screen, on the thread of the signals. Once another one is named, or none,
  /// the one before is not called any more.
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
