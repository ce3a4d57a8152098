// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace anticrack::mesher {

/// Limits the process to computing, allocating memory, reading and writing its open descriptors,
/// reading clocks, aborting and exiting. Any other system call kills it with SIGSYS. Cannot be
/// undone. Does nothing under a sanitizer (sanitized.hpp). Throws std::system_error.
void forbid_system_calls();

}  // namespace anticrack::mesher
