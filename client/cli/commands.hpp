// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands, one file per group, and the options that they share.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "cli/session.hpp"

namespace anticrack::cli {

using Command = std::function<int()>;

/// Each function adds commands with their options to `app`. When a command is parsed, its action,
/// which returns the exit code, is put into `chosen`.
void add_run(CLI::App& app, const Globals& globals, Command& chosen);
void add_sweep(CLI::App& app, const Globals& globals, Command& chosen);
void add_mesh(CLI::App& app, const Globals& globals, Command& chosen);
void add_job(CLI::App& app, const Globals& globals, Command& chosen);
void add_show(CLI::App& app, const Globals& globals, Command& chosen);
void add_server(CLI::App& app, const Globals& globals, Command& chosen);
/// Adds plot, export, study and view; the last two pass on `words`, the command line without the
/// command.
void add_programs(CLI::App& app, const Globals& globals, const std::vector<std::string>& words,
                  Command& chosen);
void add_explain(CLI::App& app, const Globals& globals, Command& chosen);
/// The keys of cases that the server knows, for completion; empty if it does not answer within a
/// second.
std::vector<std::string> case_keys(const ConnectionFlags& flags);
/// Adds completion and manual, which use `app` as it is when they are run.
void add_guide(CLI::App& app, const Globals& globals, Command& chosen);

/// One sentence about a command line (without the program's name) that `app` rejected with `error`:
/// the command, the bad word and the cure.
std::string usage_text(const CLI::App& app, const CLI::ParseError& error,
                       const std::vector<std::string>& words);

/// When `command` is parsed, puts action(options, globals) into `chosen`.
template <class Options>
void on(CLI::App& command, const std::shared_ptr<Options>& options, const Globals& globals,
        Command& chosen, std::type_identity_t<int (*)(const Options&, const Globals&)> action) {
  command.callback(
      [=, &globals, &chosen] { chosen = [=, &globals] { return action(*options, globals); }; });
}

/// Adds an option or argument whose value is of a type as --help says it; a list takes one at a
/// time.
template <class T>
CLI::Option* add_value(CLI::App& command, const std::string& name, T& value,
                       const std::string& type, const std::string& help) {
  return command.add_option(name, value, help)->allow_extra_args(false)->type_name(type);
}

/// Adds the argument CASE.
inline void add_case(CLI::App& command, std::string& file) {
  add_value(command, "CASE", file, "FILE", "The case, a TOML file")->required();
}

/// Adds --limit and --owner to a command that lists `what`.
inline void add_list_flags(CLI::App& command, const std::string& what, int& limit,
                           std::string& owner) {
  add_value(command, "--limit", limit, "COUNT", "Show at most this many, from 1 to 1000")
      ->check(CLI::Range(1, 1000).description(""))
      ->capture_default_str();
  add_value(command, "--owner", owner, "NAME",
            "Only the " + what + " of this user; others' are for administrators");
}

/// Adds the options of a figure. Those that are given become words for the program that draws,
/// which checks them; `words` must outlive the app.
void add_figure_options(CLI::App& command, std::vector<std::string>& words);

}  // namespace anticrack::cli
