// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/restrict.hpp"

#include <seccomp.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <system_error>
#include <vector>

namespace anticrack::mesher {
namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::system_category(), what);
}

/// Sets a limit. `slack`: how far the hard limit is above the soft one, which only sends a signal.
void limit(decltype(RLIMIT_AS) resource, rlim_t value, const char* name, rlim_t slack = 0) {
  rlimit current{};
  if (getrlimit(resource, &current) != 0) fail(name);
  // limits below these cannot be raised
  const rlimit wanted{std::min(value, current.rlim_max), std::min(value + slack, current.rlim_max)};
  if (setrlimit(resource, &wanted) != 0) fail(name);
}

/// Calls that computing needs: those that strace showed while gmsh meshed and .msh files were read,
/// and others that the C library's allocator, qsort (sysinfo), abort and clocks may make.
constexpr int allowed[] = {SCMP_SYS(read),
                           SCMP_SYS(write),
                           SCMP_SYS(brk),
                           SCMP_SYS(munmap),
                           SCMP_SYS(mremap),
                           SCMP_SYS(madvise),
                           SCMP_SYS(futex),
                           SCMP_SYS(getrandom),
                           SCMP_SYS(clock_gettime),
                           SCMP_SYS(gettimeofday),
                           SCMP_SYS(time),
                           SCMP_SYS(getrusage),
                           SCMP_SYS(times),
                           SCMP_SYS(sched_yield),
                           SCMP_SYS(getpid),
                           SCMP_SYS(gettid),
                           SCMP_SYS(restart_syscall),
                           SCMP_SYS(rt_sigprocmask),
                           SCMP_SYS(rt_sigaction),
                           SCMP_SYS(rt_sigreturn),
                           SCMP_SYS(exit),
                           SCMP_SYS(exit_group),
                           SCMP_SYS(sysinfo)};

void check(int result, const char* what) {
  if (result != 0) throw std::system_error(-result, std::system_category(), what);
}

struct Release {
  void operator()(void* filter) const noexcept { seccomp_release(filter); }
};

/// Allows a call if all conditions on its arguments hold.
void allow(void* filter, int call, const std::vector<scmp_arg_cmp>& conditions = {}) {
  check(seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, call,
                               static_cast<unsigned>(conditions.size()), conditions.data()),
        "seccomp_rule_add");
}

void load_filter() {
  const std::unique_ptr<void, Release> filter(seccomp_init(SCMP_ACT_KILL_PROCESS));
  check(filter ? 0 : -ENOMEM, "seccomp_init");
  // calls of another architecture have other numbers
  check(seccomp_attr_set(filter.get(), SCMP_FLTATR_ACT_BADARCH, SCMP_ACT_KILL_PROCESS), "seccomp");
  // a library may have started a thread
  check(seccomp_attr_set(filter.get(), SCMP_FLTATR_CTL_TSYNC, 1), "seccomp");
  for (const int call : allowed) allow(filter.get(), call);
  // memory may be mapped, but never as code
  for (const int call : {SCMP_SYS(mmap), SCMP_SYS(mprotect)})
    allow(filter.get(), call, {{2, SCMP_CMP_MASKED_EQ, PROT_EXEC, 0}});
  // abort() signals its own thread; the server then names SIGABRT
  allow(filter.get(), SCMP_SYS(tgkill), {{0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(getpid()), 0}});
  check(seccomp_load(filter.get()), "seccomp_load");
}

}  // namespace

void restrict_process(const Limits& limits) {
  // the hard limit would send SIGKILL, which does not show the reason
  limit(RLIMIT_CPU, limits.cpu_seconds, "RLIMIT_CPU", 2);
  limit(RLIMIT_CORE, 0, "RLIMIT_CORE");
  if (!sanitized) {
    limit(RLIMIT_AS, limits.memory_bytes, "RLIMIT_AS");
    limit(RLIMIT_NOFILE, 0, "RLIMIT_NOFILE");
    // writes beyond the next limit must fail instead of killing
    if (signal(SIGXFSZ, SIG_IGN) == SIG_ERR) fail("SIGXFSZ");
    limit(RLIMIT_FSIZE, 0, "RLIMIT_FSIZE");
  }
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) fail("PR_SET_NO_NEW_PRIVS");
  if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) fail("PR_SET_PDEATHSIG");
}

void forbid_system_calls() {
  if (!sanitized) load_filter();
}

}  // namespace anticrack::mesher
