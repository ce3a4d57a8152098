// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace anticrack::mesher {

/// From now on the process may compute, take and give back memory, read and write the descriptors
/// it has, look at the clock, abort and exit. Any other system call (to open, connect, start,
/// trace, signal another, map code) kills it with SIGSYS. Cannot be undone. Nothing under a
/// sanitizer (sanitized.hpp). Throws std::system_error.
void forbid_system_calls();

}  // namespace anticrack::mesher
