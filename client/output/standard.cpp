// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/standard.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <mutex>

namespace anticrack::output {
namespace {

std::mutex printing;
int failure = 0;

}  // namespace

void prepare_process() noexcept {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(number, F_GETFD) >= 0 || errno != EBADF) continue;
    // open() takes the lowest free number, which is this one.
    if (open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY) != number) return;
  }
  signal(SIGXFSZ, SIG_IGN);
  signal(SIGCHLD, SIG_DFL);
}

int write_all(int descriptor, std::span<const std::byte> bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    } else if (errno == EAGAIN) {
      pollfd waiting{descriptor, POLLOUT, 0};
      ::poll(&waiting, 1, -1);
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

void print(std::span<const std::byte> bytes) noexcept {
  const std::lock_guard lock(printing);
  if (failure != 0) return;
  // Text that others left in the buffer of stdout goes first.
  failure = std::fflush(stdout) != 0 ? errno : write_all(STDOUT_FILENO, bytes);
}

void print(std::string_view text) noexcept { print(std::as_bytes(std::span(text))); }

int print_failure() noexcept {
  const std::lock_guard lock(printing);
  // Some network file systems report a full disk only when a file is closed.
  if (const int copy = failure == 0 ? dup(STDOUT_FILENO) : -1; copy >= 0 && close(copy) != 0)
    failure = errno;
  return failure;
}

}  // namespace anticrack::output
