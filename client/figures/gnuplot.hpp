// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

namespace anticrack::figures {

/// Runs gnuplot in `folder` with `script` on its standard input and waits for it. Reads no start-up
/// files of the user. Throws Error when gnuplot is not installed, fails (with what it printed) or
/// takes longer than `limit` (it is killed). Raises no SIGPIPE; starts with default signals.
void run_gnuplot(const std::string& script, const std::filesystem::path& folder,
                 std::chrono::milliseconds limit);

}  // namespace anticrack::figures
