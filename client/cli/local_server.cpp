// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/local_server.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <fstream>
#include <thread>

#include "cli/programs.hpp"
#include "cli/text.hpp"
#include "client/error.hpp"

namespace anticrack::cli {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds start_limit{30'000};
constexpr milliseconds stop_limit{10'000};
/// Time between the end of a connection and that of the process, which closes its files first.
constexpr milliseconds dying_time{1'000};

[[noreturn]] void fail(const std::string& what, int error) {
  throw LocalServerError(what + ": " + std::strerror(error));
}

void close_once(int& descriptor) noexcept {
  if (descriptor >= 0) close(descriptor);
  descriptor = -1;
}

/// The text that says how the server ended. `when`: "", or " before ...".
std::string how_it_ended(int status, const std::string& when = "") {
  if (WIFEXITED(status)) return fmt::format("ended with exit code {}{}", WEXITSTATUS(status), when);
  const int number = WTERMSIG(status);
  const std::string signal =
      fmt::format("died of signal {} ({}){}", number, strsignal(number), when);
  switch (number) {
    case SIGKILL:
      return signal + ", perhaps because memory ran out: a coarser mesh takes less";
    case SIGXCPU:
      return signal + ", the limit of processor time: raise it with ulimit -t";
    default:
      return signal;
  }
}

/// Removes the files of a server that died before it could remove them.
void remove_left(const std::string& address) noexcept {
  constexpr std::string_view scheme = "unix:";
  if (!address.starts_with(scheme)) return;
  const fs::path folder = fs::path(address.substr(scheme.size())).parent_path();
  std::error_code error;
  if (folder.filename().string().starts_with("anticrack-private-")) fs::remove_all(folder, error);
}

}  // namespace

LocalServer::LocalServer(const std::stop_token& stop) {
  const fs::path program = find_program("anticrackd");
  if (program.empty()) {
    throw LocalServerError(
        "--local needs anticrackd beside this program or on PATH, and it is in neither place");
  }
  try {
    start(program);
    wait_until_ready(stop);
  } catch (...) {
    end();
    throw;
  }
}

LocalServer::~LocalServer() { end(); }

void LocalServer::start(const fs::path& program) {
  std::array<int, 2> ends{-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    fail("cannot make a pair of sockets", errno);
  _lifeline = ends[0];
  _log = memfd_create("anticrackd-log", MFD_CLOEXEC);
  int error = _log < 0 ? errno : 0;
  if (error == 0) {
    fcntl(_log, F_SETFL, O_APPEND);
    // In a session of its own: Ctrl-C and the end of the terminal are for the client, with which it
    // ends.
    const int descriptors[] = {ends[1], ends[1], _log};
    _process = spawn({program.string(), "--private", "--log-level", "warn"}, descriptors, environ,
                     POSIX_SPAWN_SETSID, error);
  }
  close(ends[1]);
  if (error != 0) fail("cannot start " + program.string(), error);
}

void LocalServer::wait_until_ready(const std::stop_token& stop) {
  constexpr int poll_milliseconds = 50;
  const auto limit = steady_clock::now() + start_limit;
  std::string said;
  while (said.find('\n') == std::string::npos) {
    if (stop.stop_requested()) throw client::Interrupted();
    if (steady_clock::now() > limit) {
      throw LocalServerError(fmt::format("anticrackd did not get ready within {} s{}",
                                         start_limit.count() / 1000, last_words()));
    }
    pollfd waiting{_lifeline, POLLIN, 0};
    if (poll(&waiting, 1, poll_milliseconds) <= 0) continue;
    std::array<char, 512> buffer{};
    const ssize_t count = read(_lifeline, buffer.data(), buffer.size());
    if (count <= 0) {
      const bool ended = has_ended(dying_time);
      const std::string when = " before it was ready";
      throw LocalServerError("anticrackd " +
                             (ended ? how_it_ended(*_status, when) : "closed its output" + when) +
                             last_words());
    }
    said.append(buffer.data(), static_cast<std::size_t>(count));
  }
  const std::string_view words = "listening on ";
  const std::size_t at = said.find(words);
  if (at == std::string::npos)
    throw LocalServerError("anticrackd said no address: " + sanitise(said));
  _address = said.substr(at + words.size(), said.find('\n') - at - words.size());
}

bool LocalServer::has_ended(milliseconds patience) noexcept {
  const std::lock_guard lock(_mutex);
  const auto limit = steady_clock::now() + patience;
  while (!_status) {
    int status = 0;
    const pid_t got = waitpid(_process, &status, WNOHANG);
    if (got == _process) _status = status;
    if (got != 0 || steady_clock::now() > limit) break;
    std::this_thread::sleep_for(milliseconds(5));
  }
  return _status.has_value();
}

void LocalServer::require_alive() {
  if (has_ended(dying_time))
    throw LocalServerError("the server of --local " + how_it_ended(*_status) + last_words());
}

void LocalServer::ask_to_end() noexcept { close_once(_lifeline); }

void LocalServer::end() noexcept {
  ask_to_end();
  if (_process > 0 && !has_ended(stop_limit)) {
    kill(_process, SIGKILL);
    has_ended(stop_limit);
  }
  if (_status && *_status != 0) remove_left(_address);
  close_once(_log);
}

std::string LocalServer::last_words() const {
  constexpr std::size_t kept_lines = 5;
  std::ifstream log(fmt::format("/proc/self/fd/{}", _log));
  std::deque<std::string> lines;
  for (std::string line; std::getline(log, line);) {
    lines.push_back("\n  " + sanitise(line));
    if (lines.size() > kept_lines) lines.pop_front();
  }
  return lines.empty() ? "" : fmt::format(":{}", fmt::join(lines, ""));
}

}  // namespace anticrack::cli
