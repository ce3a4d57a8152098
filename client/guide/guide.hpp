// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands and options of the parser, for shells and manual pages; the completion of shells and
// the manual, made from the texts of --help. The scripts of the shells know nothing of the
// commands: they ask `anticrack --complete WORD...` what may replace the last word.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace anticrack::guide {

/// The commands directly below a command.
std::vector<const CLI::App*> commands_of(const CLI::App& command);

/// The one of them with this name, or null.
const CLI::App* command_of(const CLI::App& command, const std::string& name);

/// The command and all below it, parents first.
std::vector<const CLI::App*> with_all_below(const CLI::App& command);

/// The words that lead to a command, with the program: "anticrack job watch".
std::string path_of(const CLI::App& command);

/// The options and arguments of a command, also those in groups.
std::vector<const CLI::Option*> options_of(const CLI::App& command);

/// The option with this name that may follow the command: one of its own, or one of the program,
/// which every command takes. Null if there is none.
const CLI::Option* option_of(const CLI::App& command, const std::string& name);

/// The names of an option with their dashes, long ones last; the name of an argument.
std::vector<std::string> names_of(const CLI::Option& option);

/// What --help calls the value of an option, as "FILE"; empty for a flag.
std::string type_of(const CLI::Option& option);

enum class Shell { bash, zsh, fish };

/// The script, to be sourced or installed among the shell's completions.
std::string_view completion_script(Shell shell);

/// Completions for the words after the program's name: lines "WORD<tab>DESCRIPTION" of commands,
/// options or values that begin like the last word; ":files" or ":folders" if a path is wanted. A
/// word that names a subcommand of the current command leads to it; other words are skipped.
/// `keys`: returns the keys of cases, called if one is wanted.
std::string completions(const CLI::App& app, const std::vector<std::string>& words,
                        const std::function<std::vector<std::string>()>& keys);

struct Page {
  std::string file;  ///< "anticrack-mesh-create.1"
  std::string text;  ///< in the man macros of roff
};

/// The pages of the program and of each command. `section`: 1 for commands, 8 for daemons;
/// `version`: for the footer, "anticrack 1.0".
std::vector<Page> manual(const CLI::App& app, int section, const std::string& version);

}  // namespace anticrack::guide
