// SPDX-License-Identifier: GPL-3.0-or-later
//
// Standard output. A failed write is remembered and reported once, at the end, because a command
// whose output is closed or full still has results to save.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace anticrack::output {

/// To be called before anything else is opened. A closed standard stream is replaced by one that
/// cannot be used, so that the next file to be opened is not taken for it. Writing beyond the limit
/// of a file's size (ulimit -f) becomes an error of the write instead of a signal. The ends of
/// child processes can be waited for, whatever the parent of this process chose.
void prepare_process() noexcept;

/// Writes all bytes, and waits while the descriptor takes none. Returns the error number of a write
/// that failed, 0 if none did.
int write_all(int descriptor, std::span<const std::byte> bytes) noexcept;

/// Writes the text and flushes; does nothing once a write has failed. Thread-safe.
void print(std::string_view text) noexcept;
/// The same for bytes that are not text.
void print(std::span<const std::byte> bytes) noexcept;

/// The error number of the first write to standard output that failed, even if the system reports
/// it only now; 0 if none failed. EPIPE means that the reader, such as `head`, has enough.
int print_failure() noexcept;

}  // namespace anticrack::output
