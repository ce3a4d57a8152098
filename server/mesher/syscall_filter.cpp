// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/syscall_filter.hpp"

#include <seccomp.h>
#include <sys/mman.h>
#include <unistd.h>

#include <memory>
#include <system_error>
#include <vector>

#include "mesher/sanitized.hpp"

namespace anticrack::mesher {
namespace {

/// Calls needed to compute: those seen with strace while gmsh meshed and .msh files were read, and
/// others that the C library's allocator, qsort (sysinfo), abort and clocks may make.
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
  // memory, never code
  for (const int call : {SCMP_SYS(mmap), SCMP_SYS(mprotect)})
    allow(filter.get(), call, {{2, SCMP_CMP_MASKED_EQ, PROT_EXEC, 0}});
  // abort() signals its own thread; the server then names SIGABRT
  allow(filter.get(), SCMP_SYS(tgkill), {{0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(getpid()), 0}});
  check(seccomp_load(filter.get()), "seccomp_load");
}

}  // namespace

void forbid_system_calls() {
  if (!sanitized) load_filter();
}

}  // namespace anticrack::mesher
