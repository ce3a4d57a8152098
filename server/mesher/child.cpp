// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/child.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

namespace anticrack::mesher {
namespace {

void check_spawn(int error, const std::string& what) {
  if (error != 0) throw std::system_error(error, std::system_category(), what);
}

template <class Value, auto initialise, auto destroy>
struct Owned {
  Value value;
  Owned() { check_spawn(initialise(&value), "posix_spawn"); }
  ~Owned() { destroy(&value); }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
};
using FileActions = Owned<posix_spawn_file_actions_t, posix_spawn_file_actions_init,
                          posix_spawn_file_actions_destroy>;
using Attributes = Owned<posix_spawnattr_t, posix_spawnattr_init, posix_spawnattr_destroy>;

/// Moves a descriptor out of 0 to 2, which it may get if the parent has closed these: dup2 to 0 and
/// 1 would overwrite it.
base::Descriptor above_standard(base::Descriptor descriptor) {
  if (descriptor.get() > STDERR_FILENO) return descriptor;
  base::Descriptor moved(fcntl(descriptor.get(), F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
  check_spawn(moved.get() < 0 ? errno : 0, "fcntl");
  return moved;
}

/// Environment with one thread per library, no message catalogues, none of the server's secrets.
std::vector<std::string> environment() {
  std::vector<std::string> variables{"LC_ALL=C", "OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1"};
  for (const char* name :
       {"LD_LIBRARY_PATH", "ASAN_OPTIONS", "LSAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS"})
    if (const char* value = std::getenv(name)) variables.push_back(std::string(name) + "=" + value);
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> list;
  list.reserve(strings.size() + 1);
  for (std::string& s : strings) list.push_back(s.data());
  list.push_back(nullptr);
  return list;
}

}  // namespace

Child::Child(const std::string& executable, const std::vector<std::string>& arguments,
             base::Descriptor file) {
  int ends[2] = {-1, -1};
  // close-on-exec from the start, as a spawn in another thread must not inherit them
  check_spawn(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0 ? errno : 0,
              "socketpair");
  base::Descriptor ours(ends[0]);
  base::Descriptor theirs(ends[1]);
  ours = above_standard(std::move(ours));
  theirs = above_standard(std::move(theirs));
  const bool has_file = static_cast<bool>(file);
  if (has_file) file = above_standard(std::move(file));
  check_spawn(fcntl(ours.get(), F_SETFL, O_NONBLOCK) != 0 ? errno : 0, "fcntl");

  FileActions actions;
  check_spawn(posix_spawn_file_actions_adddup2(&actions.value, theirs.get(), STDIN_FILENO), "dup2");
  check_spawn(posix_spawn_file_actions_adddup2(&actions.value, theirs.get(), STDOUT_FILENO),
              "dup2");
  int first_closed = STDERR_FILENO + 1;
  if (has_file) {
    // this comes last, as it may replace `theirs`; dup2 of a number to itself clears close-on-exec
    check_spawn(posix_spawn_file_actions_adddup2(&actions.value, file.get(), file_descriptor),
                "dup2");
    first_closed = file_descriptor + 1;
  }
  check_spawn(posix_spawn_file_actions_addclosefrom_np(&actions.value, first_closed), "closefrom");

  Attributes attributes;
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  check_spawn(posix_spawnattr_setsigmask(&attributes.value, &none), "sigmask");
  check_spawn(posix_spawnattr_setsigdefault(&attributes.value, &all), "sigdefault");
  check_spawn(posix_spawnattr_setpgroup(&attributes.value, 0), "pgroup");
  check_spawn(
      posix_spawnattr_setflags(&attributes.value, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF |
                                                      POSIX_SPAWN_SETPGROUP),
      "flags");

  std::vector<std::string> words{executable};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = environment();
  check_spawn(posix_spawn(&_pid, executable.c_str(), &actions.value, &attributes.value,
                          pointers(words).data(), pointers(variables).data()),
              executable);
  _socket = std::move(ours);
}

Child::~Child() {
  if (_ended) return;
  kill();
  while (waitpid(_pid, &_status, 0) < 0 && errno == EINTR) {
  }
}

std::size_t Child::send(std::span<const std::byte> bytes) {
  const ssize_t n = ::send(_socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  return n > 0 ? static_cast<std::size_t>(n) : 0;
}

void Child::end_input() noexcept { shutdown(_socket.get(), SHUT_WR); }

void Child::kill() noexcept {
  if (!_ended) ::kill(-_pid, SIGKILL);
}

bool Child::ended() noexcept {
  if (!_ended) _ended = waitpid(_pid, &_status, WNOHANG) == _pid;
  return _ended;
}

}  // namespace anticrack::mesher
