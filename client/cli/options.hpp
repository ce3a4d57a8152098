// SPDX-License-Identifier: GPL-3.0-or-later
//
// Options that several commands add to the parser.
#pragma once

#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "cli/commands.hpp"

namespace anticrack::cli {

/// When `command` is parsed, puts action(options, globals) into `chosen`.
template <class Options>
void on(CLI::App& command, const std::shared_ptr<Options>& options, const Globals& globals,
        Command& chosen, std::type_identity_t<int (*)(const Options&, const Globals&)> action) {
  command.callback(
      [=, &globals, &chosen] { chosen = [=, &globals] { return action(*options, globals); }; });
}

/// Adds the argument CASE.
inline void add_case(CLI::App& command, std::string& file) {
  command.add_option("CASE", file, "The case, a TOML file")->required()->type_name("FILE");
}

/// Adds --limit and --owner to a command that lists `what`.
inline void add_list_flags(CLI::App& command, const std::string& what, int& limit,
                           std::string& owner) {
  command.add_option("--limit", limit, "Show at most this many, from 1 to 1000")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("COUNT")
      ->capture_default_str();
  command
      .add_option("--owner", owner,
                  "Only the " + what + " of this user; others' are for administrators")
      ->type_name("NAME");
}

/// Adds an option that is passed on, as a word of `words`, to the program that draws or exports,
/// which checks it; without a `type` a flag. `words` must outlive the app.
CLI::Option* pass_on(CLI::App& command, std::vector<std::string>& words, const std::string& flag,
                     const std::string& type, const std::string& help,
                     const std::string& if_absent = "");

/// Adds the options of figures.
void add_figure_options(CLI::App& command, std::vector<std::string>& words,
                        const std::string& folder_help);

}  // namespace anticrack::cli
