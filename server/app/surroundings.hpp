// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a process inherits: descriptors, signals, limits, the environment. Faults are corrected if
// possible; others are named at the start, before they show as something else.
#pragma once

#include <string>
#include <vector>

#include "app/config.hpp"

namespace anticrack::app {

/// To be called first. After it, whatever the parent did: standard input, output and error are open
/// (at least on /dev/null), so that no file or socket gets their numbers; no signal is blocked or,
/// like SIGCHLD, ignored, except that writes to a closed pipe and beyond the limit of a file's size
/// fail instead of killing; new files are accessible to the user only; stacks have their usual
/// size.
void settle();

/// Throws ConfigError if the server could not work: another program instead of the mesher, limits
/// of files or stacks that are too small, too few threads.
void require_usable_surroundings(const Config& config);

/// Things that work but are not as they should be, a sentence each, for the log. The data folder
/// must exist.
std::vector<std::string> odd_surroundings(const Config& config);

}  // namespace anticrack::app
