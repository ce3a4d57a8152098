// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/signals.hpp"

#include <pthread.h>
#include <signal.h>

#include <cstdlib>

#include "cli/exit_codes.hpp"

namespace anticrack::cli {
namespace {

constexpr int end_of_listening = SIGUSR1;

sigset_t listened_set() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, end_of_listening}) {
    sigaddset(&set, number);
  }
  return set;
}

}  // namespace

Signals::Signals() {
  const sigset_t set = listened_set();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  // A reader that goes away (| head) shall not end a command that still has results to save.
  signal(SIGPIPE, SIG_IGN);
  _thread = std::thread([this] { listen(); });
}

Signals::~Signals() {
  pthread_kill(_thread.native_handle(), end_of_listening);
  _thread.join();
  const sigset_t set = listened_set();
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  signal(SIGPIPE, SIG_DFL);
}

bool Signals::second_within(std::chrono::milliseconds time) {
  std::unique_lock lock(_mutex);
  if (!_interactive) {
    return _count > 1;
  }
  return _came.wait_for(lock, time, [this] { return _count > 1; });
}

void Signals::listen() {
  const sigset_t set = listened_set();
  while (true) {
    int number = 0;
    if (sigwait(&set, &number) != 0 || number == end_of_listening) {
      return;
    }
    int count = 0;
    {
      const std::lock_guard lock(_mutex);
      count = ++_count;
      _interactive = _interactive && number == SIGINT;
    }
    _came.notify_all();
    if (count == 1) {
      _first.request_stop();
    } else if (count == 2) {
      _second.request_stop();
    } else {
      std::_Exit(exit_interrupted);
    }
  }
}

}  // namespace anticrack::cli
