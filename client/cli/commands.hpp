// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands, one file per group. Each adds its subcommands to the parser and, when one of them
// is meant, leaves in `chosen` what to do.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/session.hpp"

namespace CLI {
class App;
}

namespace anticrack::cli {

using Command = std::function<int()>;

/// Each adds a command with its options to `app`; parsed, it puts what is to be done into `chosen`,
/// which returns the exit code.
void add_run(CLI::App& app, const Globals& globals, Command& chosen);
void add_sweep(CLI::App& app, const Globals& globals, Command& chosen);
void add_mesh(CLI::App& app, const Globals& globals, Command& chosen);
void add_job(CLI::App& app, const Globals& globals, Command& chosen);
void add_files(CLI::App& app, const Globals& globals, Command& chosen);  ///< show, plot, export
void add_server(CLI::App& app, const Globals& globals, Command& chosen);
/// completion, manual: of `app` as it is when they are run.
void add_guide(CLI::App& app, const Globals& globals, Command& chosen);

/// The whole command line: parses, runs, returns the exit code.
int run_command_line(int argc, char** argv);

}  // namespace anticrack::cli
