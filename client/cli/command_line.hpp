// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace anticrack::cli {

/// The whole command line: parses, runs, returns the exit code.
int run_command_line(int argc, char** argv);

}  // namespace anticrack::cli
