// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/drawing.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "figures/figures.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

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

/// `env` sets a locale in which numbers have a point and text is UTF-8; `timeout` kills gnuplot at
/// the limit. gnuplot reads a named file through a buffer, but standard input byte by byte, which
/// takes three times as long as drawing.
std::vector<std::string> command(std::chrono::milliseconds limit) {
  const std::string seconds = number(std::chrono::duration<double>(limit).count());
  return {"/usr/bin/env",  "LC_ALL=C.UTF-8", "/usr/bin/timeout", "--foreground",
          "--signal=KILL", seconds,          "gnuplot",          "-d",
          "/dev/stdin"};
}

// Exit codes of `timeout`: the program is not installed; killed at the limit.
constexpr int not_found = 127, killed = 128 + SIGKILL;

/// Starts the command in the folder with default signals.
pid_t spawn(std::vector<std::string> words, const std::filesystem::path& folder, int in, int err) {
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

  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t pid = -1;
  const int error =
      posix_spawn(&pid, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) fail("cannot be started", error);
  return pid;
}

}  // namespace

void run_gnuplot(const std::string& script, const std::filesystem::path& folder,
                 std::chrono::milliseconds limit) {
  const Descriptor in = memory_file(script);
  const Descriptor err = memory_file({});
  const pid_t pid = spawn(command(limit), folder, in.get(), err.get());
  int status = 0;
  while (waitpid(pid, &status, 0) < 0)
    if (errno != EINTR) fail("cannot be waited for", errno);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == not_found)
    throw Error("gnuplot is not installed; install the package gnuplot-nox and try again");
  if (code == killed) {
    throw Error("gnuplot took longer than " + std::to_string(limit.count()) +
                " ms and was stopped; draw a coarser mesh or allow more time");
  }
  if (code != 0) {
    throw Error("gnuplot failed (" +
                (code > 0 ? "exit code " + std::to_string(code)
                          : "signal " + std::to_string(WTERMSIG(status))) +
                "): " + tail_of(err, kept_output));
  }
}

}  // namespace anticrack::figures
