// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

namespace anticrack::app {

/// Reaps orphans: the first process of a container inherits the children of processes that end
/// there, and must wait for them, or they stay in the table of processes.
class Orphans {
 public:
  /// Whether this process is the first of a container.
  static bool may_come() noexcept;
  /// To be called now and then: forgets a child that has ended and that nobody has waited for since
  /// the call before. The server's own helpers are waited for within milliseconds.
  void reap() noexcept;

 private:
  pid_t _seen = 0;
};

}  // namespace anticrack::app
