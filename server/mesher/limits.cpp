// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/limits.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "mesher/sanitized.hpp"

namespace anticrack::mesher {
namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::system_category(), what);
}

/// `slack`: how far the hard limit is above the soft one, which only sends a signal.
void limit(decltype(RLIMIT_AS) resource, rlim_t value, const char* name, rlim_t slack = 0) {
  rlimit current{};
  if (getrlimit(resource, &current) != 0) fail(name);
  // limits below these cannot be raised
  const rlimit wanted{std::min(value, current.rlim_max), std::min(value + slack, current.rlim_max)};
  if (setrlimit(resource, &wanted) != 0) fail(name);
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

}  // namespace anticrack::mesher
