// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/drawing.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>
#include <vector>

#include "figures/figures.hpp"
#include "figures/memory_file.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

/// Bytes of standard error in messages: gnuplot repeats the failing line, which may be long.
constexpr off_t kept_output = 4000;

[[noreturn]] void fail(const std::string& what, int error) {
  throw Error("gnuplot: " + what + ": " + std::generic_category().message(error));
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

/// Starts the command in the folder with default signals; it inherits `kept`.
pid_t spawn(std::vector<std::string> words, const std::filesystem::path& folder, int in, int err,
            std::span<const int> kept) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, err, STDERR_FILENO);
  for (const int number : kept) posix_spawn_file_actions_adddup2(&actions, number, number);
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
                 std::chrono::milliseconds limit, std::span<const int> kept) {
  const MemoryFile in(script);
  const MemoryFile err;
  const pid_t pid = spawn(command(limit), folder, in.descriptor(), err.descriptor(), kept);
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
                "): " + err.tail(kept_output));
  }
}

}  // namespace anticrack::figures
