// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands, one file per group, and the whole command line.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/session.hpp"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace anticrack::cli {

using Command = std::function<int()>;

/// Each function adds commands with their options to `app`. When a command is parsed, its action,
/// which returns the exit code, is put into `chosen`.
void add_run(CLI::App& app, const Globals& globals, Command& chosen);
void add_sweep(CLI::App& app, const Globals& globals, Command& chosen);
void add_mesh(CLI::App& app, const Globals& globals, Command& chosen);
void add_job(CLI::App& app, const Globals& globals, Command& chosen);
void add_files(CLI::App& app, const Globals& globals, Command& chosen);  ///< show, plot, export
void add_server(CLI::App& app, const Globals& globals, Command& chosen);
/// Adds study and view, which pass on `words`, the command line without the command.
void add_programs(CLI::App& app, const std::vector<std::string>& words, Command& chosen);
void add_explain(CLI::App& app, const Globals& globals, Command& chosen);
/// The keys of cases that the server knows, for completion; empty if it does not answer within a
/// second.
std::vector<std::string> case_keys(const ConnectionFlags& flags);
/// Adds completion and manual, which use `app` as it is when they are run.
void add_guide(CLI::App& app, const Globals& globals, Command& chosen);

/// The whole command line: parses, runs, returns the exit code.
int run_command_line(int argc, char** argv);

/// One sentence about a command line (without the program's name) that `app` rejected with `error`:
/// the command, the bad word and the cure.
std::string usage_text(const CLI::App& app, const CLI::ParseError& error,
                       const std::vector<std::string>& words);

}  // namespace anticrack::cli
