// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

namespace anticrack::figures {

/// Runs gnuplot in `folder` with `script` as its standard input and waits for it. It reads no
/// start-up files of the user and starts with default signals. Throws Error when gnuplot is not
/// installed, fails (with what it printed) or takes longer than `limit` (it is killed).
void run_gnuplot(const std::string& script, const std::filesystem::path& folder,
                 std::chrono::milliseconds limit);

}  // namespace anticrack::figures
