// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/orphans.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <utility>

namespace anticrack::app {

bool Orphans::may_come() noexcept { return ::getpid() == 1; }

void Orphans::reap() noexcept {
  siginfo_t ended{};
  if (::waitid(P_ALL, 0, &ended, WEXITED | WNOHANG | WNOWAIT) != 0) return;
  const pid_t before = std::exchange(_seen, ended.si_pid);  // 0 if there is none
  if (_seen == 0 || _seen != before) return;
  ::waitpid(_seen, nullptr, WNOHANG);
  _seen = 0;
}

}  // namespace anticrack::app
