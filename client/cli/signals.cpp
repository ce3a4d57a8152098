// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/signals.hpp"

#include <pthread.h>

#include <cstdlib>
#include <utility>

#include "cli/report.hpp"

namespace anticrack::cli {
namespace {

constexpr int end_of_listening = SIGUSR1;

bool is_ignored(int number) {
  struct sigaction action {};
  return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

sigset_t listened_set() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, end_of_listening);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGCONT, SIGWINCH})
    if (!is_ignored(number)) sigaddset(&set, number);
  return set;
}

}  // namespace

Signals::Signals() : _set(listened_set()) {
  pthread_sigmask(SIG_BLOCK, &_set, nullptr);
  // A closed pipe (| head) must not end a command that still has results to save.
  signal(SIGPIPE, SIG_IGN);
  _thread = std::thread([this] { listen(); });
}

Signals::~Signals() {
  pthread_kill(_thread.native_handle(), end_of_listening);
  _thread.join();
  pthread_sigmask(SIG_UNBLOCK, &_set, nullptr);
  signal(SIGPIPE, SIG_DFL);
}

void Signals::end_on_closed_output() noexcept { signal(SIGPIPE, SIG_DFL); }

bool Signals::wait_for_first(const std::stop_token& stop) {
  std::unique_lock lock(_mutex);
  return _came.wait(lock, stop, [this] { return _count > 0; });
}

bool Signals::second_within(std::chrono::milliseconds time, const std::stop_token& stop) {
  std::unique_lock lock(_mutex);
  if (!_interactive) return _count > 1;
  return _came.wait_for(lock, stop, time, [this] { return _count > 1; });
}

bool Signals::interactive() {
  const std::lock_guard lock(_mutex);
  return _interactive;
}

void Signals::tell_screen(std::function<void(Screen)> listener) {
  const std::lock_guard lock(_screen_mutex);
  _screen = std::move(listener);
}

void Signals::screen(Screen event) {
  const std::lock_guard lock(_screen_mutex);
  if (_screen) _screen(event);
}

void Signals::listen() {
  while (true) {
    int number = 0;
    if (sigwait(&_set, &number) != 0 || number == end_of_listening) return;
    switch (number) {
      case SIGTSTP:
        stop_as_asked();
        break;
      case SIGCONT:
        screen(Screen::back);
        break;
      case SIGWINCH:
        screen(Screen::resized);
        break;
      default:
        end_asked_for(number);
    }
  }
}

// Stops the process by the signal itself, which does nothing if there is no shell to continue it.
void Signals::stop_as_asked() {
  screen(Screen::leaving);
  sigset_t stopping;
  sigemptyset(&stopping);
  sigaddset(&stopping, SIGTSTP);
  raise(SIGTSTP);
  pthread_sigmask(SIG_UNBLOCK, &stopping, nullptr);  // here the process stops
  pthread_sigmask(SIG_BLOCK, &stopping, nullptr);
  screen(Screen::back);
}

void Signals::end_asked_for(int number) {
  int count = 0;
  {
    const std::lock_guard lock(_mutex);
    count = ++_count;
    _interactive = _interactive && number == SIGINT;
  }
  _came.notify_all();
  if (count == 1) {
    _first.request_stop();
  } else if (count > 2) {
    screen(Screen::leaving);
    std::_Exit(exit_interrupted);
  }
}

}  // namespace anticrack::cli
