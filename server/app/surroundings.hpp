// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a process inherits: descriptors, signals, limits, the environment. What can be put right
// is, the rest is named at the start, before it shows as something else.
#pragma once

#include <string>
#include <vector>

#include "app/config.hpp"

namespace anticrack::app {

/// To be called first. Whatever the parent did: standard input, output and error are open (on
/// /dev/null), so that no file or socket gets their numbers; no signal is blocked or, as SIGCHLD,
/// without effect, but writes to a closed pipe and beyond the limit of a file's size fail and do
/// not kill; new files are the user's alone; stacks have their usual size.
void settle();

/// Throws ConfigError where the server could not work: another program instead of the mesher, too
/// small files or stacks, too few threads.
void require_usable_surroundings(const Config& config);

/// What works but is not as it should be: a sentence each, for the log. The data folder is there.
std::vector<std::string> odd_surroundings(const Config& config);

}  // namespace anticrack::app
