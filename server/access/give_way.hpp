// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace anticrack::access {

/// The calling thread, and what it starts, gives way to threads that answer calls: the system gives
/// it a tenth of their share where both want a processor, and all that they leave. For good: no
/// privilege is needed to give way, but one to take it back.
inline void give_way() noexcept {
  constexpr int niceness = 10;
  const auto self = static_cast<id_t>(::gettid());
  if (::getpriority(PRIO_PROCESS, self) < niceness) ::setpriority(PRIO_PROCESS, self, niceness);
}

}  // namespace anticrack::access
