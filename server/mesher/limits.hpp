// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the helper process denies itself before it looks at its input.
#pragma once

#include <cstdint>

namespace anticrack::mesher {

struct Limits {
  std::uint64_t memory_bytes = 0;  ///< RLIMIT_AS; not under a sanitizer
  std::uint64_t cpu_seconds = 0;   ///< RLIMIT_CPU: SIGXCPU
};

/// Sets the limits, and beyond them: no descriptor but those it has (not under a sanitizer), no
/// core dump, no bytes written to files, no new privileges, death with the parent. Throws
/// std::system_error. Call it while the process has one thread.
void restrict_process(const Limits& limits);

}  // namespace anticrack::mesher
