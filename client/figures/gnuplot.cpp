// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/gnuplot.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
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

/// gnuplot repeats the failing line, which may be a long one.
constexpr std::size_t kept_output = 4000;

[[noreturn]] void fail(const std::string& what, int error) {
  throw Error("gnuplot: " + what + ": " + std::generic_category().message(error));
}

class Descriptor {
 public:
  explicit Descriptor(int number = -1) : _number(number) {}
  Descriptor(Descriptor&& other) noexcept : _number(std::exchange(other._number, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(_number, other._number);
    return *this;
  }
  ~Descriptor() { reset(); }

  int get() const noexcept { return _number; }
  void reset() noexcept {
    if (_number >= 0) close(std::exchange(_number, -1));
  }

 private:
  int _number;
};

/// As pidfd_open of <sys/pidfd.h>, which glibc 2.36 declares without C linkage.
int open_pidfd(pid_t pid) {
  return static_cast<int>(syscall(SYS_pidfd_open, pid, 0));
}

/// Keeps SIGPIPE from this thread until the end of the scope; a write to a child that has stopped
/// reading then only fails.
class NoBrokenPipeSignal {
 public:
  NoBrokenPipeSignal() {
    sigemptyset(&_pipe);
    sigaddset(&_pipe, SIGPIPE);
    sigset_t pending;
    sigpending(&pending);
    _was_pending = sigismember(&pending, SIGPIPE) == 1;
    pthread_sigmask(SIG_BLOCK, &_pipe, &_before);
  }
  NoBrokenPipeSignal(const NoBrokenPipeSignal&) = delete;
  NoBrokenPipeSignal& operator=(const NoBrokenPipeSignal&) = delete;
  ~NoBrokenPipeSignal() {
    const timespec at_once{};
    if (!_was_pending) {
      while (sigtimedwait(&_pipe, nullptr, &at_once) < 0 && errno == EINTR) {
      }
    }
    pthread_sigmask(SIG_SETMASK, &_before, nullptr);
  }

 private:
  sigset_t _pipe, _before;
  bool _was_pending = false;
};

/// A child that does not outlive its owner.
class Child {
 public:
  explicit Child(pid_t pid) : _pid(pid), _ended(open_pidfd(pid)) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (_pid < 0) return;
    kill(_pid, SIGKILL);
    wait();
  }

  /// Readable once the child has ended.
  int descriptor() const noexcept { return _ended.get(); }

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
  for (char** each = environ; *each != nullptr; ++each) {
    if (!std::string_view(*each).starts_with("LC_ALL=")) variables.push_back(*each);
  }
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
  // Named, gnuplot reads it through a buffer; by default byte by byte, which takes three times as
  // long as drawing.
  std::string input = "/dev/stdin";
  std::array<char*, 4> arguments{program.data(), no_startup_files.data(), input.data(), nullptr};
  std::string locale = "LC_ALL=C.UTF-8";
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, program.c_str(), &actions, &attributes, arguments.data(),
                                 environment(locale).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT && std::filesystem::is_directory(folder)) {
    throw Error("gnuplot is not installed; install the package gnuplot-nox and try again");
  }
  if (error != 0) fail("cannot be started", error);
  return pid;
}

/// Feeds the script and collects standard error until the child has ended.
class Conversation {
 public:
  Conversation(std::string_view script, Descriptor to, Descriptor from)
      : _script(script), _to(std::move(to)), _from(std::move(from)) {}

  /// False when the deadline passed first.
  bool hold(const Child& child, Clock::time_point deadline) {
    for (;;) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
      if (left <= 0) return false;
      std::array<pollfd, 3> waits{
          {{_to.get(), POLLOUT, 0}, {_from.get(), POLLIN, 0}, {child.descriptor(), POLLIN, 0}}};
      const int wait = static_cast<int>(std::min<long>(left, 1000));
      if (poll(waits.data(), waits.size(), wait) < 0 && errno != EINTR) fail("poll", errno);
      if (waits[0].revents != 0) feed();
      if (waits[1].revents != 0) collect();
      if (waits[2].revents != 0) {
        while (collect()) {
        }
        return true;
      }
    }
  }

  const std::string& output() const noexcept { return _output; }

 private:
  void feed() {
    const ssize_t sent = ::write(_to.get(), _script.data(), _script.size());
    if (sent >= 0) {
      _script.remove_prefix(static_cast<std::size_t>(sent));
    } else if (errno != EINTR && errno != EAGAIN) {
      _script = {};  // it has stopped reading; its exit status and standard error say why
    }
    if (_script.empty()) _to.reset();
  }

  /// True if there was something.
  bool collect() {
    std::array<char, 4096> buffer{};
    const ssize_t count = ::read(_from.get(), buffer.data(), buffer.size());
    if (count == 0) _from.reset();
    if (count <= 0) return false;
    _output.append(buffer.data(), static_cast<std::size_t>(count));
    if (_output.size() > kept_output) _output.erase(0, _output.size() - kept_output);
    return true;
  }

  std::string_view _script;
  Descriptor _to, _from;
  std::string _output;
};

}  // namespace

void run_gnuplot(const std::string& script, const std::filesystem::path& folder,
                 std::chrono::milliseconds limit) {
  const NoBrokenPipeSignal quiet;
  std::array<int, 2> in{}, err{};
  if (pipe2(in.data(), O_CLOEXEC) != 0) fail("pipe", errno);
  Descriptor childs_in(in[0]), to(in[1]);
  if (pipe2(err.data(), O_CLOEXEC) != 0) fail("pipe", errno);
  Descriptor from(err[0]), childs_err(err[1]);
  fcntl(to.get(), F_SETFL, O_NONBLOCK);
  fcntl(from.get(), F_SETFL, O_NONBLOCK);

  Child child(spawn(folder, childs_in.get(), childs_err.get()));
  if (child.descriptor() < 0) fail("cannot be watched", errno);
  childs_in.reset();
  childs_err.reset();
  Conversation conversation(script, std::move(to), std::move(from));
  if (!conversation.hold(child, Clock::now() + limit)) {
    throw Error("gnuplot took longer than " + std::to_string(limit.count()) +
                " ms and was stopped; draw a coarser mesh or allow more time");
  }
  const int status = child.wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw Error("gnuplot failed (" +
                (WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                                   : "signal " + std::to_string(WTERMSIG(status))) +
                "): " + conversation.output());
  }
}

}  // namespace anticrack::figures
