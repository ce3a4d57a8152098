// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/surroundings.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <linux/magic.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <system_error>
#include <thread>

#include "app/options.hpp"

namespace anticrack::app {
namespace {

constexpr rlim_t mib = 1 << 20;
constexpr rlim_t usual_stack = 8 * mib;
constexpr rlim_t least_stack = mib;
/// The least limit of a file's size: room for a database with its log, and for a result.
constexpr rlim_t least_file = 64 * mib;

void open_standard_descriptors() {
  // open() takes the lowest free number, so this fills them in order.
  for (int number = STDIN_FILENO; number <= STDERR_FILENO; ++number)
    if (::fcntl(number, F_GETFD) < 0) ::open("/dev/null", O_RDWR);
}

void settle_signals() {
  struct sigaction with {};
  with.sa_handler = SIG_DFL;
  ::sigaction(SIGCHLD, &with, nullptr);  // if it were ignored, children would leave no status
  with.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &with, nullptr);
  ::sigaction(SIGXFSZ, &with, nullptr);
  sigset_t none;
  sigemptyset(&none);
  ::pthread_sigmask(SIG_SETMASK, &none, nullptr);
}

void settle_stacks() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur < usual_stack) {
    limit.rlim_cur = std::min(usual_stack, limit.rlim_max);
    ::setrlimit(RLIMIT_STACK, &limit);
  }
  // Stacks of threads have the size of that limit at the start of the process, whatever it is.
  pthread_attr_t attributes;
  if (::pthread_attr_init(&attributes) != 0) return;
  ::pthread_attr_setstacksize(&attributes, usual_stack);
  ::pthread_setattr_default_np(&attributes);
  ::pthread_attr_destroy(&attributes);
}

rlim_t soft_limit(decltype(RLIMIT_AS) resource) {
  rlimit limit{};
  return ::getrlimit(resource, &limit) == 0 ? limit.rlim_cur : RLIM_INFINITY;
}

/// The threads of gRPC, of the engine and of the store, and some to spare.
int threads_needed(const Config& config) { return 40 + 2 * config.jobs.threads; }

/// Starts all threads at once for a moment, as gRPC would abort if it could not start one.
void require_threads(int count) {
  std::mutex mutex;
  std::condition_variable woken;
  bool enough = false;
  std::vector<std::thread> threads;
  const auto wait = [&] {
    std::unique_lock lock(mutex);
    woken.wait(lock, [&] { return enough; });
  };
  std::string problem;
  try {
    while (static_cast<int>(threads.size()) < count) threads.emplace_back(wait);
  } catch (const std::system_error& error) {
    problem = error.code().message();
  }
  {
    const std::lock_guard lock(mutex);
    enough = true;
  }
  woken.notify_all();
  for (std::thread& thread : threads) thread.join();
  if (problem.empty()) return;
  throw ConfigError(fmt::format(
      "threads: the server needs about {} threads and can start {}: {}; raise the limit of "
      "processes (ulimit -u; TasksMax= of systemd; pids of the container) or of memory (ulimit -v) "
      "or lower threads",
      count, threads.size(), problem));
}

bool is_set(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0';
}

/// The reason why a file system is unfit for a server's data; empty if it is fit.
std::string unfit(const std::string& folder) {
  struct statfs found {};
  if (::statfs(folder.c_str(), &found) != 0) return "";
  constexpr auto cifs = 0xFF534D42U;
  switch (static_cast<unsigned>(found.f_type)) {
    case TMPFS_MAGIC:
    case RAMFS_MAGIC:
      return " lies in memory: what is in it is gone after a restart of the machine";
    case NFS_SUPER_MAGIC:
    case SMB_SUPER_MAGIC:
    case SMB2_SUPER_MAGIC:
    case cifs:
      return " lies on a file system of the network, whose locks and writes are not those of a "
             "disk: what was acknowledged may be lost; use a local one";
    default:
      return "";
  }
}

void add_folder(const std::string& folder, std::vector<std::string>& odd) {
  struct stat found {};
  if (::stat(folder.c_str(), &found) != 0) return;
  if (found.st_uid != ::geteuid()) {
    odd.push_back(fmt::format("data-dir: {} belongs to user {}, and the server runs as user {}",
                              folder, found.st_uid, ::geteuid()));
  }
  // This is not refused, as the volumes of some containers are like this.
  if ((found.st_mode & S_IWOTH) != 0) {
    odd.push_back("data-dir: every user of this machine may write in " + folder +
                  "; run chmod o-w on it");
  }
  if (const std::string why = unfit(folder); !why.empty())
    odd.push_back("data-dir: " + folder + why);
}

}  // namespace

void settle() {
  open_standard_descriptors();
  settle_signals();
  ::umask(0077);
  settle_stacks();
}

void require_usable_surroundings(const Config& config) {
  require_mesher(config);
  if (const rlim_t stack = soft_limit(RLIMIT_STACK); stack < least_stack) {
    throw ConfigError(fmt::format(
        "the stack of this process may have {} KiB, and the server and its mesher need {}; raise "
        "the limit (ulimit -s {}; LimitSTACK= of systemd)",
        stack >> 10, least_stack >> 10, usual_stack >> 10));
  }
  if (const rlim_t file = soft_limit(RLIMIT_FSIZE); file < least_file) {
    throw ConfigError(
        fmt::format("data-dir: files of this process may have {} KiB, too little for a database "
                    "and results; raise the limit (ulimit -f unlimited; LimitFSIZE= of systemd)",
                    file >> 10));
  }
  require_threads(threads_needed(config));
}

std::vector<std::string> odd_surroundings(const Config& config) {
  std::vector<std::string> odd;
  add_folder(config.store.folder, odd);
  if (const rlim_t file = soft_limit(RLIMIT_FSIZE); file != RLIM_INFINITY)
    odd.push_back(fmt::format(
        "files of this process may have {} MiB (ulimit -f): larger results are refused as if the "
        "disk were full",
        file >> 20));
  if (const rlim_t time = soft_limit(RLIMIT_CPU); time != RLIM_INFINITY)
    odd.push_back(fmt::format(
        "the process may take {} s of processor time (ulimit -t): then the system kills it", time));
  constexpr std::time_t release = 1'767'225'600;  // 2026-01-01
  if (const std::time_t now = std::time(nullptr); now < release)
    odd.push_back(fmt::format(
        "the clock says {} s since 1970, which is before this version was made: set it, as the "
        "expiry of results, tokens and certificates goes by it",
        now));
  if (::access("/proc/self/fd", X_OK) != 0)
    odd.emplace_back(
        "/proc is not mounted: the metrics have neither memory nor descriptors of the process");
  if (const char* process = std::getenv("LISTEN_PID");
      process != nullptr && process == std::to_string(::getpid()))
    odd.emplace_back(
        "systemd passes sockets (LISTEN_FDS), which the server does not use: remove the .socket "
        "unit, and give listen");
  if (is_set("LD_PRELOAD"))
    odd.emplace_back("LD_PRELOAD is set: what it loads runs in the server too");
  return odd;
}

}  // namespace anticrack::app
