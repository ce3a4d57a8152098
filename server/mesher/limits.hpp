// SPDX-License-Identifier: GPL-3.0-or-later
//
// Resource limits that the helper process sets for itself before it reads its input.
#pragma once

#include <cstdint>

namespace anticrack::mesher {

struct Limits {
  std::uint64_t memory_bytes = 0;  ///< RLIMIT_AS; not under a sanitizer
  std::uint64_t cpu_seconds = 0;   ///< RLIMIT_CPU: SIGXCPU
};

/// Sets the limits and also forbids new descriptors and bytes written to files (not under a
/// sanitizer), core dumps and new privileges; the process ends with its parent. Call it while the
/// process has one thread. Throws std::system_error.
void restrict_process(const Limits& limits);

}  // namespace anticrack::mesher
