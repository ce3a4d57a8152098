// SPDX-License-Identifier: GPL-3.0-or-later
//
// Standard output. What cannot be written is remembered and told once, at the end: a command whose
// output is closed or full still has results to save.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace anticrack::output {

/// To be called before anything else is opened. A standard stream that is closed is put in place as
/// one that cannot be used, lest the next file that is opened be taken for it. A file too large for
/// the limit of this process (ulimit -f) is an error of the write and not a signal; the ends of
/// child processes can be waited for, whatever the parent of this one chose.
void prepare_process() noexcept;

/// Writes all of it and flushes; nothing once a write has failed. Thread-safe.
void print(std::string_view text) noexcept;
/// The same of bytes that are not text.
void print(std::span<const std::byte> bytes) noexcept;

/// The error number of the first write to standard output that failed, also one that the system has
/// put off until now; 0: none. EPIPE: whoever read it, as `head`, has enough.
int print_failure() noexcept;

}  // namespace anticrack::output
