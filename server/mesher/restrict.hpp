// SPDX-License-Identifier: GPL-3.0-or-later
//
// Restrictions that the helper process sets on itself before it reads its input.
#pragma once

#include <cstdint>

namespace anticrack::mesher {

/// Whether this is a build for AddressSanitizer or ThreadSanitizer. It has no limits and no filter:
/// the shadow is larger than any memory limit, and sanitizers read /proc, write reports and start a
/// process to find leaks.
#ifdef __has_feature  // clang
inline constexpr bool sanitized =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

struct Limits {
  std::uint64_t memory_bytes = 0;  ///< RLIMIT_AS; not under a sanitizer
  std::uint64_t cpu_seconds = 0;   ///< RLIMIT_CPU: SIGXCPU
};

/// Sets the limits and also forbids new descriptors and bytes written to files (not under a
/// sanitizer), core dumps and new privileges; the process ends with its parent. Call it while the
/// process has one thread. Throws std::system_error.
void restrict_process(const Limits& limits);

/// Limits the process to computing, allocating memory, reading and writing its open descriptors,
/// reading clocks, aborting and exiting. Any other system call kills it with SIGSYS. Cannot be
/// undone. Does nothing under a sanitizer. Throws std::system_error.
void forbid_system_calls();

}  // namespace anticrack::mesher
