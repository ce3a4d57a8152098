// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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

}  // namespace anticrack::mesher
