// SPDX-License-Identifier: GPL-3.0-or-later
//
// Each test is a process that forbids itself system calls and then does something.
#include "mesher/restrict.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace anticrack {
namespace {

using ::testing::ExitedWithCode;
using ::testing::KilledBySignal;

constexpr int done = 7;

/// In a process that is to end.
template <class Act>
[[noreturn]] void restricted(const Act& act) {
  mesher::forbid_system_calls();
  act();
  _exit(done);
}

class SyscallFilter : public ::testing::Test {
 protected:
  void SetUp() override {
    if (mesher::sanitized) GTEST_SKIP() << "the filter is left out";
  }

  template <class Act>
  static void expect_killed(const char* what, const Act& act) {
    SCOPED_TRACE(what);
    // without the filter the process ends by itself, so that what it does is what kills it
    EXPECT_EXIT((act(), _exit(done)), ExitedWithCode(done), "");
    EXPECT_EXIT(restricted(act), KilledBySignal(SIGSYS), "");
  }
};

TEST_F(SyscallFilter, NoFileIsOpenedOrLookedAt) {
  expect_killed("open", [] { syscall(SYS_open, "/dev/null", O_RDONLY); });
  expect_killed("openat", [] { open("/dev/null", O_RDONLY); });
  expect_killed("creat", [] { open("/dev/null", O_WRONLY | O_TRUNC); });
  expect_killed("stat", [] {
    struct stat found {};
    stat("/dev/null", &found);
  });
  expect_killed("access", [] { (void)access("/dev/null", R_OK); });
  expect_killed("readlink", [] {
    char name[64];
    (void)!readlink("/proc/self/exe", name, sizeof name);
  });
  expect_killed("unlink", [] { unlink("/dev/null/nothing"); });
  expect_killed("memfd_create", [] { memfd_create("m", 0); });
  expect_killed("fcntl", [] { fcntl(STDOUT_FILENO, F_DUPFD, 0); });
}

TEST_F(SyscallFilter, NoConnectionIsMade) {
  expect_killed("socket inet", [] { socket(AF_INET, SOCK_STREAM, 0); });
  expect_killed("socket unix", [] { socket(AF_UNIX, SOCK_STREAM, 0); });
  expect_killed("sendmsg", [] {
    const msghdr nothing{};
    sendmsg(STDOUT_FILENO, &nothing, MSG_NOSIGNAL);
  });
}

TEST_F(SyscallFilter, NoProcessIsStartedOrTouched) {
  expect_killed("execve", [] {
    char name[] = "nothing";
    char* const words[] = {name, nullptr};
    execve("/dev/null/nothing", words, words);
  });
  expect_killed("fork", [] {
    if (fork() == 0) _exit(0);
  });
  expect_killed("kill 0", [] { kill(getppid(), 0); });
  expect_killed("kill", [] { kill(1 << 30, SIGTERM); });
  expect_killed("tgkill of another", [] { syscall(SYS_tgkill, 1 << 30, 1 << 30, SIGTERM); });
  expect_killed("ptrace", [] { ptrace(PTRACE_PEEKDATA, 1 << 30, nullptr, nullptr); });
  expect_killed("process_vm_readv",
                [] { syscall(SYS_process_vm_readv, 1 << 30, nullptr, 0UL, nullptr, 0UL, 0UL); });
}

TEST_F(SyscallFilter, NoCodeIsMadeAndNoLimitRaised) {
  expect_killed("mmap", [] {
    std::ignore = mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  });
  expect_killed("mprotect", [] { mprotect(nullptr, 0, PROT_READ | PROT_EXEC); });
  expect_killed("setrlimit", [] {
    rlimit limit{};
    getrlimit(RLIMIT_CPU, &limit);
    setrlimit(RLIMIT_CPU, &limit);
  });
  expect_killed("prctl", [] { prctl(PR_GET_DUMPABLE); });
}

TEST_F(SyscallFilter, ComputingGoesOn) {
  EXPECT_EXIT(restricted([] {
                std::vector<std::vector<double>> blocks;
                for (std::size_t size = 1; size < (8U << 20); size *= 2) blocks.emplace_back(size);
                blocks.back().resize(3 * blocks.back().size());
                blocks.clear();
                std::ostringstream text;
                text << 1.5 << std::chrono::steady_clock::now().time_since_epoch().count();
                try {
                  throw std::runtime_error(text.str());
                } catch (const std::exception& error) {
                  const std::string words = std::string("said: ") + error.what();
                  if (write(STDERR_FILENO, words.data(), words.size()) < 0) abort();
                }
              }),
              ExitedWithCode(done), "said: 1.5");
  EXPECT_EXIT(restricted([] { exit(done); }), ExitedWithCode(done), "");
}

TEST_F(SyscallFilter, AbortIsStillAnAbort) {
  EXPECT_EXIT(restricted([] { abort(); }), KilledBySignal(SIGABRT), "");
}

}  // namespace
}  // namespace anticrack
