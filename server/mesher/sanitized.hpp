// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace anticrack::mesher {

/// Whether this is a build for AddressSanitizer or ThreadSanitizer. Their shadow is larger than any
/// memory limit; they read /proc, write reports and start a process to find leaks: limits and
/// filter are then left out, and a test of such a build says nothing about them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitized = true;
#elif defined(__has_feature)  // clang
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif
#else
inline constexpr bool sanitized = false;
#endif

}  // namespace anticrack::mesher
