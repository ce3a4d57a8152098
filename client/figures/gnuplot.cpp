// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/drawing.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "figures/figures.hpp"

namespace anticrack::figures {
namespace {

using Clock = std::chrono::steady_clock;

/// Bytes of standard error in messages: gnuplot repeats the failing line, which may be long.
constexpr off_t kept_output = 4000;

[[noreturn]] void fail(const std::string& what, int error) {
  throw Error("gnuplot: " + what + ": " + std::generic_category().message(error));
}

/// A file descriptor, closed once.
class Descriptor {
 public:
  explicit Descriptor(int number) : _number(number) {}
  Descriptor(Descriptor&& other) noexcept : _number(std::exchange(other._number, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (_number >= 0) close(_number);
  }

  int get() const noexcept { return _number; }

 private:
  int _number;
};

/// A file in memory that holds `content`.
Descriptor memory_file(std::string_view content) {
  Descriptor file(memfd_create("anticrack-gnuplot", MFD_CLOEXEC));
  if (file.get() < 0) fail("memfd_create", errno);
  while (!content.empty()) {
    const ssize_t written = ::write(file.get(), content.data(), content.size());
    if (written < 0 && errno != EINTR) fail("write", errno);
    content.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
  return file;
}

/// The last `most` bytes of a file.
std::string tail_of(const Descriptor& file, off_t most) {
  const off_t size = lseek(file.get(), 0, SEEK_END);
  const off_t begin = std::max<off_t>(size - most, 0);
  std::string text(static_cast<std::size_t>(std::max<off_t>(size - begin, 0)), '\0');
  const ssize_t count = pread(file.get(), text.data(), text.size(), begin);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  return text;
}

/// A child that does not outlive its owner.
class Child {
 public:
  // Not pidfd_open: glibc 2.36 declares it without C linkage.
  explicit Child(pid_t pid)
      : _pid(pid), _ended(static_cast<int>(syscall(SYS_pidfd_open, pid, 0))) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (_pid < 0) return;
    kill(_pid, SIGKILL);
    wait();
  }

  bool ends_before(Clock::time_point deadline) const {
    if (_ended.get() < 0) fail("cannot be watched", errno);
    for (;;) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
      if (left.count() <= 0) return false;
      pollfd waiting{_ended.get(), POLLIN, 0};
      const int found = poll(&waiting, 1, static_cast<int>(std::min<long>(left.count(), 1000)));
      if (found > 0) return true;
      if (found < 0 && errno != EINTR) fail("poll", errno);
    }
  }

  int wait() {
    int status = 0;
    while (waitpid(_pid, &status, 0) < 0 && errno == EINTR) {
    }
    _pid = -1;
    return status;
  }

 private:
  pid_t _pid;
  Descriptor _ended;
};

/// The environment with a locale in which numbers have a point and text is UTF-8.
std::vector<char*> environment(std::string& locale) {
  std::vector<char*> variables{locale.data()};
  for (char** each = environ; *each != nullptr; ++each)
    if (!std::string_view(*each).starts_with("LC_ALL=")) variables.push_back(*each);
  variables.push_back(nullptr);
  return variables;
}

pid_t spawn(const std::filesystem::path& folder, int in, int err) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, err, STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());

  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

  std::string program = "gnuplot";
  std::string no_startup_files = "-d";
  // Named, gnuplot reads it through a buffer; standard input it reads byte by byte, which takes
  // three times as long as drawing.
  std::string input = "/dev/stdin";
  std::array<char*, 4> arguments{program.data(), no_startup_files.data(), input.data(), nullptr};
  std::string locale = "LC_ALL=C.UTF-8";
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, program.c_str(), &actions, &attributes, arguments.data(),
                                 environment(locale).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT && std::filesystem::is_directory(folder))
    throw Error("gnuplot is not installed; install the package gnuplot-nox and try again");
  if (error != 0) fail("cannot be started", error);
  return pid;
}

}  // namespace

void run_gnuplot(const std::string& script, const std::filesystem::path& folder,
                 std::chrono::milliseconds limit) {
  const Descriptor in = memory_file(script);
  const Descriptor err = memory_file({});
  Child child(spawn(folder, in.get(), err.get()));
  if (!child.ends_before(Clock::now() + limit)) {
    throw Error("gnuplot took longer than " + std::to_string(limit.count()) +
                " ms and was stopped; draw a coarser mesh or allow more time");
  }
  const int status = child.wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw Error("gnuplot failed (" +
                (WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                                   : "signal " + std::to_string(WTERMSIG(status))) +
                "): " + tail_of(err, kept_output));
  }
}

}  // namespace anticrack::figures
