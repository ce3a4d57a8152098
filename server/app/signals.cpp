// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/signals.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <thread>

namespace anticrack::app {
namespace {

std::atomic<int> signal_writer{-1};
static_assert(std::atomic<int>::is_always_lock_free, "used in a signal handler");

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

void set_action(int number, void (*action)(int)) {
  struct sigaction with {};
  with.sa_handler = action;
  with.sa_flags = SA_RESTART;
  if (::sigaction(number, &with, nullptr) != 0) fail("cannot handle signals");
}

}  // namespace

extern "C" {
static void anticrack_note_signal(int number) {
  const int before = errno;
  const auto byte = static_cast<unsigned char>(number);
  // A full pipe loses nothing, as a signal is already waiting to be read.
  [[maybe_unused]] const ssize_t written = ::write(signal_writer, &byte, 1);
  errno = before;
}
}

Signals::Signals() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("cannot make a pipe");
  ::fcntl(ends[1], F_SETFL, O_NONBLOCK);
  _reader = ends[0];
  signal_writer = ends[1];
  set_action(SIGPIPE, SIG_IGN);
  set_action(SIGHUP, anticrack_note_signal);
  set_action(SIGTERM, anticrack_note_signal);
  set_action(SIGINT, anticrack_note_signal);
}

Signals::~Signals() {
  set_action(SIGHUP, SIG_DFL);
  set_action(SIGTERM, SIG_DFL);
  set_action(SIGINT, SIG_DFL);
  ::close(signal_writer.exchange(-1));
  ::close(_reader);
}

int Signals::wait() const {
  unsigned char number = 0;
  while (::read(_reader, &number, 1) != 1)
    if (errno != EINTR) fail("cannot read signals");
  return number;
}

std::optional<int> Signals::wait_for(std::chrono::milliseconds time) const {
  pollfd descriptor{_reader, POLLIN, 0};
  const int ready = ::poll(&descriptor, 1, static_cast<int>(time.count()));
  if (ready < 0 && errno != EINTR) fail("cannot wait for signals");
  if (ready <= 0 || (descriptor.revents & POLLIN) == 0) return std::nullopt;
  return wait();
}

void Signals::run_unless_interrupted(const std::function<void()>& work) const {
  const int done = ::eventfd(0, EFD_CLOEXEC);
  if (done < 0) fail("cannot make an event");
  std::thread thread;
  try {
    thread = std::thread([&] {
      work();
      ::eventfd_write(done, 1);
    });
  } catch (const std::system_error&) {  // without another thread, nothing can interrupt the work
    work();
    ::close(done);
    return;
  }
  std::array<pollfd, 2> descriptors{pollfd{done, POLLIN, 0}, pollfd{_reader, POLLIN, 0}};
  while ((descriptors[0].revents & POLLIN) == 0) {
    ::poll(descriptors.data(), descriptors.size(), -1);
    if ((descriptors[1].revents & POLLIN) == 0) continue;
    if (const int number = wait(); number != SIGHUP) std::_Exit(128 + number);
  }
  thread.join();
  ::close(done);
}

}  // namespace anticrack::app
