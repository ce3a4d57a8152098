// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/local_server.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <fstream>
#include <numeric>
#include <sstream>
#include <thread>
#include <vector>

#include "cli/text.hpp"
#include "client/error.hpp"

namespace anticrack::cli {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds start_limit{30'000};
constexpr milliseconds stop_limit{10'000};

fs::path make_folder() {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  std::string pattern = (parent / "anticrack-XXXXXX").string();
  if (error || mkdtemp(pattern.data()) == nullptr) {
    throw LocalServerError("cannot make a temporary folder in " + parent.string() +
                           "; set TMPDIR to a folder you may write in");
  }
  return pattern;
}

// Between fork and exec: async-signal-safe calls only.
[[noreturn]] void become(const char* const* arguments, int output, int log, pid_t parent) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGPIPE, SIG_DFL);
  // Ctrl-C goes to the client only, which then stops the server.
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  const int null = open("/dev/null", O_RDONLY);
  const bool ready = getppid() == parent && null >= 0 && dup2(null, 0) == 0 &&
                     dup2(output, 1) == 1 && dup2(log, 2) == 2;
  if (ready) execv(arguments[0], const_cast<char* const*>(arguments));
  _exit(127);
}

}  // namespace

fs::path find_server(const fs::path& executable, const std::string& search_path) {
  std::vector<fs::path> folders{executable.parent_path()};
  std::istringstream path(search_path);
  for (std::string folder; std::getline(path, folder, ':');)
    folders.emplace_back(folder.empty() ? "." : folder);
  for (const fs::path& folder : folders) {
    fs::path candidate = folder / "anticrackd";
    std::error_code error;
    if (fs::is_regular_file(candidate, error) && access(candidate.c_str(), X_OK) == 0)
      return candidate;
  }
  return {};
}

LocalServer::LocalServer(const std::stop_token& stop) {
  std::error_code error;
  const char* search_path = std::getenv("PATH");
  const fs::path program =
      find_server(fs::read_symlink("/proc/self/exe", error), search_path ? search_path : "");
  if (program.empty()) {
    throw LocalServerError(
        "--local needs anticrackd beside this program or on PATH, and it is in neither place");
  }
  _folder = make_folder();
  _address = "unix:" + (_folder / "socket").string();
  try {
    start(program);
    wait_until_ready(stop);
  } catch (...) {
    stop_process();
    fs::remove_all(_folder, error);
    throw;
  }
}

LocalServer::~LocalServer() {
  stop_process();
  std::error_code error;
  fs::remove_all(_folder, error);
}

void LocalServer::start(const fs::path& program) {
  const std::string data = (_folder / "data").string();
  const std::array<const char*, 8> arguments{program.c_str(), "--listen",   _address.c_str(),
                                             "--data-dir",    data.c_str(), "--log-level",
                                             "warn",          nullptr};
  std::array<int, 2> pipe_ends{};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0)
    throw LocalServerError(std::string("cannot make a pipe: ") + std::strerror(errno));
  _output = pipe_ends[0];
  const int log = open((_folder / "log").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  const pid_t parent = getpid();
  _process = log < 0 ? -1 : fork();
  if (_process == 0) become(arguments.data(), pipe_ends[1], log, parent);
  const int cause = errno;
  close(pipe_ends[1]);
  if (log >= 0) close(log);
  if (_process < 0)
    throw LocalServerError("cannot start " + program.string() + ": " + std::strerror(cause));
}

void LocalServer::wait_until_ready(const std::stop_token& stop) {
  constexpr int poll_milliseconds = 50;
  const auto limit = steady_clock::now() + start_limit;
  std::string said;
  while (said.find('\n') == std::string::npos) {
    if (stop.stop_requested()) throw client::Interrupted();
    if (steady_clock::now() > limit) {
      throw LocalServerError("anticrackd did not get ready within " +
                             std::to_string(start_limit.count() / 1000) + " s" + last_words());
    }
    pollfd waiting{_output, POLLIN, 0};
    if (poll(&waiting, 1, poll_milliseconds) <= 0) continue;
    std::array<char, 512> buffer{};
    const ssize_t count = read(_output, buffer.data(), buffer.size());
    if (count <= 0) throw LocalServerError("anticrackd ended before it was ready" + last_words());
    said.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

void LocalServer::stop_process() noexcept {
  if (_process > 0) {
    kill(_process, SIGTERM);
    const auto limit = steady_clock::now() + stop_limit;
    while (waitpid(_process, nullptr, WNOHANG) == 0) {
      if (steady_clock::now() > limit) {
        kill(_process, SIGKILL);
        waitpid(_process, nullptr, 0);
        break;
      }
      std::this_thread::sleep_for(milliseconds(5));
    }
    _process = -1;
  }
  if (_output >= 0) {
    close(_output);
    _output = -1;
  }
}

std::string LocalServer::last_words() const {
  constexpr std::size_t kept_lines = 5;
  std::ifstream log(_folder / "log");
  std::deque<std::string> lines;
  for (std::string line; std::getline(log, line);) {
    lines.push_back("\n  " + sanitise(line));
    if (lines.size() > kept_lines) lines.pop_front();
  }
  return std::accumulate(lines.begin(), lines.end(), std::string(lines.empty() ? "" : ":"));
}

}  // namespace anticrack::cli
